// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/vocabulary/tree.hpp"

namespace mh {
namespace {

// ORB-SLAM's own reader has the same limits.
constexpr std::uint32_t kMaxBranching = 20, kMaxDepth = 10;
constexpr std::uint32_t kMaxScoring = 5, kMaxWeighting = 3;  // the largest that DBoW2 defines

/// Parses numbers from the lines of a text, one line at a time.
class LineReader {
 public:
  LineReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  /// Advances to the next line. @returns false at the end; blank lines at the end are skipped.
  bool next_line() {
    if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }

  template <class Number>
  Number take(std::string_view what) {
    skip_blanks();
    if (line_.empty()) throw fault(fmt::format("line ends where {} is expected", what));
    Number value{};
    const char* const end = line_.data() + line_.size();
    const auto result = std::from_chars(line_.data(), end, value);
    const bool ends_here = result.ptr == end || *result.ptr == ' ' || *result.ptr == '\t';
    if (result.ec != std::errc() || !ends_here)
      throw fault(fmt::format("{}: '{}' is not a valid number here", what, word()));
    line_.remove_prefix(static_cast<std::size_t>(result.ptr - line_.data()));
    return value;
  }

  std::uint32_t take(std::string_view what, std::uint32_t low, std::uint32_t high) {
    const auto value = take<std::int64_t>(what);
    if (value < low || value > high)
      throw fault(fmt::format("{}: {} is not from {} to {}", what, value, low, high));
    return static_cast<std::uint32_t>(value);
  }

  void end_line() {
    skip_blanks();
    if (!line_.empty())
      throw fault(fmt::format("line continues where it should end: '{}'", word()));
  }

  InputError fault(std::string_view what) const { return fault(number_, what); }
  InputError fault(std::size_t line, std::string_view what) const {
    return InputError(fmt::format("{}:{}: {}", name_, line, what));
  }

 private:
  void skip_blanks() {
    while (!line_.empty() && (line_.front() == ' ' || line_.front() == '\t'))
      line_.remove_prefix(1);
  }
  /// The next word, truncated to what a message should show.
  std::string_view word() const {
    return line_.substr(0, std::min<std::size_t>(line_.find_first_of(" \t"), 20));
  }

  std::string_view rest_, line_;
  const std::string& name_;
  std::size_t number_ = 0;
};

/// Nodes in the order of the file; 0 is the root.
struct Nodes {
  std::vector<std::uint32_t> parent = {0};
  std::vector<Descriptor> center = {Descriptor{}};
  std::vector<float> weight = {0};
  std::vector<std::uint8_t> is_leaf = {0}, level = {0}, children = {0};

  std::uint32_t count() const { return static_cast<std::uint32_t>(parent.size()); }
  void reserve(std::size_t n) {
    parent.reserve(n), center.reserve(n), weight.reserve(n);
    is_leaf.reserve(n), level.reserve(n), children.reserve(n);
  }
};

Descriptor take_descriptor(LineReader& reader) {
  std::array<std::uint8_t, sizeof(Descriptor)> bytes;
  for (std::uint8_t& byte : bytes)
    byte = static_cast<std::uint8_t>(reader.take("a byte of the descriptor", 0, 255));
  Descriptor descriptor;
  std::memcpy(descriptor.data(), bytes.data(), sizeof descriptor);
  return descriptor;
}

void read_node(LineReader& reader, const VocabularyTree& tree, Nodes& nodes) {
  const auto parent = reader.take<std::int64_t>("the parent");
  if (parent < 0 || parent >= nodes.count())
    throw reader.fault(fmt::format("the parent: there is no node {} before this line", parent));
  const auto p = static_cast<std::uint32_t>(parent);
  if (nodes.is_leaf[p] != 0)
    throw reader.fault(fmt::format("the parent: node {} is a leaf", parent));
  if (nodes.level[p] >= tree.depth)
    throw reader.fault(fmt::format("deeper than the {} levels of line 1", tree.depth));
  if (nodes.children[p] >= tree.branching)
    throw reader.fault(
        fmt::format("node {} has more than the {} children of line 1", parent, tree.branching));
  nodes.is_leaf.push_back(static_cast<std::uint8_t>(reader.take("is-leaf", 0, 1)));
  nodes.center.push_back(take_descriptor(reader));
  const auto weight = reader.take<double>("the weight");
  if (!std::isfinite(weight) || weight < 0)
    throw reader.fault(fmt::format("the weight: {} is not a number from 0", weight));
  reader.end_line();
  nodes.weight.push_back(static_cast<float>(weight));
  nodes.level.push_back(static_cast<std::uint8_t>(nodes.level[p] + 1));
  nodes.children.push_back(0);
  nodes.parent.push_back(p);
  ++nodes.children[p];
}

/// All nodes, breadth first; siblings in the order of the file.
std::vector<std::uint32_t> breadth_first(const Nodes& nodes) {
  std::vector<std::uint32_t> first_child(nodes.count() + 1, 0), children(nodes.count() - 1);
  for (std::uint32_t i = 0; i < nodes.count(); ++i)
    first_child[i + 1] = first_child[i] + nodes.children[i];
  std::vector<std::uint32_t> next = first_child;
  for (std::uint32_t i = 1; i < nodes.count(); ++i) children[next[nodes.parent[i]]++] = i;

  std::vector<std::uint32_t> order = {0};
  order.reserve(nodes.count());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t node = order[i];
    order.insert(order.end(), children.begin() + first_child[node],
                 children.begin() + first_child[node + 1]);
  }
  return order;
}

}  // namespace

VocabularyTree read_dbow2_text(std::string_view text, const std::string& name) {
  LineReader reader(text, name);
  VocabularyTree tree;
  if (!reader.next_line()) throw InputError(fmt::format("{}: is empty", name));
  tree.branching = reader.take("k", 2, kMaxBranching);
  tree.depth = reader.take("L", 1, kMaxDepth);
  reader.take("scoring", 0, kMaxScoring);
  reader.take("weighting", 0, kMaxWeighting);
  reader.end_line();

  Nodes nodes;
  nodes.reserve(text.size() / 100);  // a line has about 130 bytes
  while (reader.next_line()) read_node(reader, tree, nodes);
  if (nodes.count() < 2) throw reader.fault("holds no node");

  for (const std::uint32_t node : breadth_first(nodes)) {
    if (nodes.is_leaf[node] == 0 && nodes.children[node] == 0)
      throw reader.fault(node + 1, "is not a leaf and has no child in the whole file");
    tree.centers.push_back(nodes.center[node]);
    tree.child_counts.push_back(nodes.children[node]);
    if (nodes.is_leaf[node] != 0) tree.idf.push_back(nodes.weight[node]);
  }
  return tree;
}

std::string dbow2_text(const VocabularyTree& tree) {
  if (tree.branching > kMaxBranching || tree.depth > kMaxDepth)
    throw InputError(fmt::format(
        "a tree of {} children per node and {} levels does not fit DBoW2's text format: at most {} "
        "and {}",
        tree.branching, tree.depth, kMaxBranching, kMaxDepth));
  std::string text = fmt::format("{} {} 0 0", tree.branching, tree.depth);
  std::size_t child = 1, word = 0;
  for (std::size_t parent = 0; parent < tree.child_counts.size(); ++parent)
    for (unsigned i = 0; i < tree.child_counts[parent]; ++i, ++child) {
      const bool is_leaf = tree.child_counts[child] == 0;
      text += fmt::format("\n{} {:d}", parent, is_leaf);
      std::array<std::uint8_t, sizeof(Descriptor)> bytes;
      std::memcpy(bytes.data(), tree.centers[child].data(), sizeof bytes);
      for (const std::uint8_t byte : bytes) text += fmt::format(" {}", byte);
      text += fmt::format(" {}", is_leaf ? tree.idf[word++] : 0.0F);
    }
  return text;
}

}  // namespace mh
