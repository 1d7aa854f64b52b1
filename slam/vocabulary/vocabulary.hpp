// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "slam/features/features.hpp"

namespace mh {

using WordId = std::uint32_t;

/// A tree of visual words: hierarchical k-medians over binary descriptors (Galvez-Lopez and
/// Tardos, T-RO 2012, after Nister and Stewenius, CVPR 2006). Default-constructed it is empty and
/// can only be assigned to.
class Vocabulary {
 public:
  struct TrainConfig {
    int branching = 10;       ///< children per node, 2 to 255
    int depth = 4;            ///< levels below the root, 1 to 10; at most branching^depth words
    int max_iterations = 12;  ///< of k-medians at each node, >= 1
    std::uint64_t seed = 0;
  };
  struct Quantized {
    WordId word = 0;
    /// Ancestor at the direct index's level, kDirectIndexLevel below the root (the leaf itself
    /// where the tree ends sooner): only features under the same node are compared.
    std::uint32_t node = 0;
  };

  /// branching^2 nodes, 100 as a rule: with 1,000 features in a picture some 10 share a node.
  static constexpr int kDirectIndexLevel = 2;
  static constexpr std::uint32_t kFileVersion = 1;

  /// Trains on the descriptors of many images. Deterministic: same images, config, same tree.
  /// Weights are idf = ln(images / images with the word); every word occurs in some image.
  /// @throws std::invalid_argument naming a setting out of range; InputError if there is no
  /// descriptor at all.
  static Vocabulary train(std::span<const std::vector<Descriptor>> images,
                          const TrainConfig& config);

  /// @throws InputError naming file and fault: missing, not a vocabulary, another version, cut
  /// short, checksum wrong.
  static Vocabulary load(const std::filesystem::path& file);
  /// Written to a temporary, then renamed. @throws InputError if it cannot be written.
  void save(const std::filesystem::path& file) const;

  /// The word a descriptor belongs to: from the root down, always to the nearest child in Hamming
  /// distance, the first among equals. @pre not empty.
  Quantized quantize(const Descriptor& descriptor) const;

  std::size_t size() const { return idf_.size(); }  ///< number of words
  float idf(WordId word) const { return idf_[word]; }
  int branching() const { return branching_; }
  int depth() const { return depth_; }
  /// Of the file's content: equal digests, equal vocabularies.
  std::uint64_t digest() const;

 private:
  friend class VocabularyTrainer;

  std::string encode() const;
  static Vocabulary decode(const std::string& bytes, const std::string& name);

  int branching_ = 0;
  int depth_ = 0;
  // Nodes in breadth-first order; node 0 is the root. Children of a node are contiguous.
  struct Node {
    Descriptor centre{};
    std::uint32_t first_child = 0;
    std::uint32_t child_count = 0;  ///< 0 = leaf
    WordId word = 0;                ///< leaves only: their number in node order
  };
  std::vector<Node> nodes_;
  std::vector<float> idf_;
};

}  // namespace mh
