// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/ogre_script.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace mh::gazebo {
namespace {

/// The words, braces and line ends of a script, without comments.
std::vector<std::string_view> tokens_of(std::string_view script) {
  std::vector<std::string_view> tokens;
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t at = 0; at < script.size();) {
    const std::string_view rest = script.substr(at);
    if (rest.starts_with("//")) {
      at += std::min(rest.find('\n'), rest.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = rest.find("*/");
      at += end == rest.npos ? rest.size() : end + 2;
    } else if (is_space(rest[0])) {
      ++at;
    } else if (rest[0] == '\n' || rest[0] == '{' || rest[0] == '}') {
      tokens.push_back(rest.substr(0, 1));
      ++at;
    } else if (rest[0] == '"') {
      const std::size_t end = std::min(rest.find('"', 1), rest.size());
      tokens.push_back(rest.substr(1, end - 1));
      at += std::min(end + 1, rest.size());
    } else {
      std::size_t size = 1;
      while (size < rest.size() && !is_space(rest[size]) && rest[size] != '\n' &&
             rest[size] != '{' && rest[size] != '}')
        ++size;
      tokens.push_back(rest.substr(0, size));
      at += size;
    }
  }
  return tokens;
}

std::optional<float> number(std::string_view word) {
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

class Parser {
 public:
  explicit Parser(std::string_view script) : tokens_(tokens_of(script)) {}

  std::vector<OgreMaterial> run() {
    while (at_ < tokens_.size()) {
      const std::vector<std::string_view> line = next_line();
      if (line.empty()) continue;
      if (line[0] == "{")
        ++depth_;
      else if (line[0] == "}")
        depth_ = std::max(0, depth_ - 1);
      else if (depth_ == 0)
        begin(line);
      else if (!materials_.empty() && inside_)
        read(line);
    }
    return std::move(materials_);
  }

 private:
  /// The words up to the end of a line or a brace, or a brace alone.
  std::vector<std::string_view> next_line() {
    std::vector<std::string_view> words;
    for (; at_ < tokens_.size(); ++at_) {
      const std::string_view token = tokens_[at_];
      if (token == "{" || token == "}") {
        if (words.empty()) words.push_back(tokens_[at_++]);
        return words;
      }
      if (token == "\n") {
        ++at_;
        return words;
      }
      words.push_back(token);
    }
    return words;
  }

  /// material NAME [: PARENT]
  void begin(const std::vector<std::string_view>& line) {
    inside_ = line[0] == "material" && line.size() > 1;
    if (!inside_) return;
    OgreMaterial material;
    const auto colon = std::ranges::find(line, ":");
    if (colon != line.end() && colon + 1 != line.end())
      for (const OgreMaterial& other : materials_)
        if (other.name == *(colon + 1)) material = other;
    material.name = line[1];
    materials_.push_back(std::move(material));
    own_diffuse_ = own_texture_ = false;
  }

  void read(const std::vector<std::string_view>& line) {
    OgreMaterial& material = materials_.back();
    if (line[0] == "texture" && line.size() > 1 && !own_texture_) {
      material.texture = line[1];
      own_texture_ = true;
    }
    if (line[0] != "diffuse" || line.size() < 4 || own_diffuse_) return;
    std::array<float, 4> diffuse{1, 1, 1, 1};
    for (std::size_t i = 0; i < std::min<std::size_t>(4, line.size() - 1); ++i) {
      const auto value = number(line[i + 1]);
      if (!value) return;  // vertexcolour
      diffuse[i] = *value;
    }
    material.diffuse = diffuse;
    own_diffuse_ = true;
  }

  std::vector<std::string_view> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool inside_ = false, own_diffuse_ = false, own_texture_ = false;
  std::vector<OgreMaterial> materials_;
};

struct Stock {
  std::string_view name;
  std::array<float, 4> color;
};
constexpr std::array kStock = {
    Stock{"White", {1, 1, 1, 1}},
    Stock{"Grey", {0.7F, 0.7F, 0.7F, 1}},
    Stock{"LightGrey", {0.8F, 0.8F, 0.8F, 1}},
    Stock{"DarkGrey", {0.175F, 0.175F, 0.175F, 1}},
    Stock{"Black", {0.05F, 0.05F, 0.05F, 1}},
    Stock{"FlatBlack", {0.1F, 0.1F, 0.1F, 1}},
    Stock{"Red", {1, 0, 0, 1}},
    Stock{"Green", {0, 1, 0, 1}},
    Stock{"Blue", {0, 0, 1, 1}},
    Stock{"Yellow", {1, 1, 0, 1}},
    Stock{"DarkYellow", {0.7F, 0.7F, 0, 1}},
    Stock{"Orange", {1, 0.5F, 0.05F, 1}},
    Stock{"DarkOrange", {0.9F, 0.4F, 0, 1}},
    Stock{"Purple", {1, 0, 1, 1}},
    Stock{"Turquoise", {0, 1, 1, 1}},
    Stock{"SkyBlue", {0.15F, 0.45F, 0.7F, 1}},
    Stock{"Indigo", {0.35F, 0, 0.5F, 1}},
    Stock{"Gold", {0.8F, 0.65F, 0.2F, 1}},
    Stock{"ZincYellow", {0.95F, 0.95F, 0.2F, 1}},
    Stock{"Wood", {0.65F, 0.5F, 0.35F, 1}},
    Stock{"Bricks", {0.6F, 0.35F, 0.3F, 1}},
    Stock{"Road", {0.3F, 0.3F, 0.3F, 1}},
    Stock{"Residential", {0.6F, 0.55F, 0.5F, 1}},
    Stock{"Grass", {0.3F, 0.45F, 0.2F, 1}},
    Stock{"CeilingTiled", {0.85F, 0.85F, 0.85F, 1}},
    Stock{"PaintedWall", {0.85F, 0.82F, 0.75F, 1}},
    Stock{"WoodFloor", {0.6F, 0.45F, 0.3F, 1}},
    Stock{"WoodPallet", {0.65F, 0.5F, 0.35F, 1}},
};

}  // namespace

std::vector<OgreMaterial> parse_ogre_script(std::string_view script) {
  return Parser(script).run();
}

std::optional<OgreMaterial> stock_material(std::string_view name) {
  constexpr std::string_view kPrefix = "Gazebo/";
  if (!name.starts_with(kPrefix)) return std::nullopt;
  std::string_view color = name.substr(kPrefix.size());
  const auto drop = [&](std::string_view ending) {
    const bool has = color.ends_with(ending) && color.size() > ending.size();
    if (has) color.remove_suffix(ending.size());
    return has;
  };
  drop("Glow");
  drop("Bright");
  const bool transparent = drop("Transparent");
  const auto found = std::ranges::find(kStock, color, &Stock::name);
  if (found == kStock.end()) return std::nullopt;
  OgreMaterial material{.name = std::string(name), .diffuse = found->color, .texture = {}};
  if (transparent) (*material.diffuse)[3] = 0.5F;
  return material;
}

}  // namespace mh::gazebo
