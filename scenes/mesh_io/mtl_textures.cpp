// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/mtl_textures.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "slam/io/lower_case.hpp"

namespace mh {
namespace {

constexpr std::string_view kWhitespace = " \t\r";

struct Option {
  std::string_view name;
  std::size_t most;  ///< maximum number of arguments
  bool numbers;      ///< arguments are numbers; fewer than `most` are allowed
};

constexpr std::array<Option, 14> kOptions = {{{"-blendu", 1, false},
                                              {"-blendv", 1, false},
                                              {"-bm", 1, true},
                                              {"-boost", 1, true},
                                              {"-cc", 1, false},
                                              {"-clamp", 1, false},
                                              {"-colorspace", 1, false},
                                              {"-imfchan", 1, false},
                                              {"-mm", 2, true},
                                              {"-o", 3, true},
                                              {"-s", 3, true},
                                              {"-t", 3, true},
                                              {"-texres", 1, false},
                                              {"-type", 1, false}}};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(kWhitespace, at)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(kWhitespace, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<float> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// A texture and its options, as stated in a line.
struct Texture {
  std::string file;
  MtlUvs uvs{};
  bool clamped = false, has_options = false;
  std::vector<std::string_view> lost{};  ///< ignored options that would change what is seen
};

void honor(std::string_view option, const std::vector<std::string_view>& arguments,
           Texture& texture) {
  std::array<float, 3> numbers = {};
  for (std::size_t i = 0; i < std::min(arguments.size(), numbers.size()); ++i)
    numbers[i] = number(arguments[i]).value_or(0.0F);
  for (std::size_t i = 0; i < std::min<std::size_t>(arguments.size(), 2); ++i) {
    if (option == "-s") texture.uvs.scale[static_cast<int>(i)] = numbers[i];
    if (option == "-o") texture.uvs.offset[static_cast<int>(i)] = numbers[i];
  }
  if (option == "-clamp") texture.clamped = lower_case(std::string(arguments.at(0))) == "on";
  constexpr std::array<float, 3> kNone = {}, kSame = {0, 1, 0};
  if ((option == "-t" && numbers != kNone) || (option == "-mm" && numbers != kSame))
    texture.lost.push_back(option);
}

/// Parses the rest of a line after its keyword.
Texture parse(std::string_view rest) {
  Texture texture;
  const std::vector<std::string_view> words = words_of(rest);
  const char *begin = nullptr, *end = nullptr;  // of the file's name, which may contain spaces
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto option =
        std::ranges::find(kOptions, lower_case(std::string(words[i])), &Option::name);
    std::vector<std::string_view> arguments;
    if (option != kOptions.end())
      while (arguments.size() < option->most && i + 1 + arguments.size() < words.size() &&
             (!option->numbers || number(words[i + 1 + arguments.size()])))
        arguments.push_back(words[i + 1 + arguments.size()]);
    if (arguments.empty()) {  // no option, or a name that looks like one
      begin = begin == nullptr ? words[i].data() : begin;
      end = words[i].data() + words[i].size();
      continue;
    }
    honor(option->name, arguments, texture);
    texture.has_options = true;
    i += arguments.size();
  }
  texture.file.assign(begin, end);
  return texture;
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, MtlTextures& textures)
      : file_(file), textures_(textures) {}

  /// @returns the line without options; nullopt if it has none
  std::optional<std::string> read(std::string_view line) {
    ++line_;
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() < 2) return std::nullopt;
    const std::string key = lower_case(std::string(words[0]));
    const std::string_view rest =
        line.substr(static_cast<std::size_t>(words[1].data() - line.data()));
    if (key == "newmtl") {
      material_ = rest.substr(0, rest.find_last_not_of(kWhitespace) + 1);
      base_.reset();
    }
    const bool is_base = key == "map_kd";
    if (!is_base && key != "map_ke" && key != "map_emissive" && key != "map_d") return std::nullopt;
    const Texture texture = parse(rest);
    place(texture, is_base, key);
    if (!texture.has_options || texture.file.empty()) return std::nullopt;
    return fmt::format("{} {}{}", words[0], texture.clamped ? "-clamp on " : "", texture.file);
  }

 private:
  void place(const Texture& texture, bool is_base, const std::string& key) {
    for (const std::string_view option : texture.lost)
      warn(fmt::format("{}'s {} is left out", key, option));
    if (!is_base && base_ && texture.uvs != *base_)
      warn(fmt::format("{} is placed differently from map_kd: it is drawn where map_kd is", key));
    if (is_base) base_ = texture.uvs;
    if (!is_base && base_) return;
    if (texture.uvs == MtlUvs())
      textures_.uvs.erase(material_);
    else
      textures_.uvs[material_] = texture.uvs;
  }

  void warn(const std::string& what) {
    textures_.warnings.push_back(
        fmt::format("{}:{}: material {}: {}", file_.string(), line_, material_, what));
  }

  const std::filesystem::path& file_;
  MtlTextures& textures_;
  std::string material_;
  std::optional<MtlUvs> base_;
  std::size_t line_ = 0;
};

}  // namespace

std::optional<std::string> without_options(std::string_view mtl, const std::filesystem::path& file,
                                           MtlTextures& textures) {
  Reader reader(file, textures);
  std::string plain;
  bool any = false;
  while (!mtl.empty()) {
    const std::size_t size = std::min(mtl.find('\n'), mtl.size());
    const std::string_view line = mtl.substr(0, size);
    mtl.remove_prefix(std::min(size + 1, mtl.size()));
    const auto changed = reader.read(line);
    plain += changed.value_or(std::string(line));
    plain += '\n';
    any = any || changed;
  }
  return any ? std::optional(std::move(plain)) : std::nullopt;
}

}  // namespace mh
