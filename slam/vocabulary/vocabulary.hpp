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
/// Tardos, T-RO 2012, after Nister and Stewenius, CVPR 2006).
class Vocabulary {
 public:
  struct TrainConfig {
    int branching = 10;
    int depth = 4;             ///< at most branching^depth words
    int max_iterations = 12;   ///< of k-medians at each node
    std::uint64_t seed = 0;
  };
  struct Quantized {
    WordId word = 0;
    std::uint32_t node = 0;  ///< ancestor at the direct index's level: only features under the same node are compared
  };

  /// Trains on the descriptors of many images; weights are idf = ln(images / images with the word).
  static Vocabulary train(std::span<const std::vector<Descriptor>> images, const TrainConfig& config);

  /// @throws InputError naming file and fault: missing, not a vocabulary, another version, cut
  /// short, checksum wrong.
  static Vocabulary load(const std::filesystem::path& file);
  /// Written to a temporary, then renamed. @throws MachineError.
  void save(const std::filesystem::path& file) const;

  Quantized quantize(const Descriptor& descriptor) const;
  std::size_t size() const { return idf_.size(); }  ///< number of words
  float idf(WordId word) const { return idf_[word]; }
  std::uint64_t digest() const;

 private:
  int branching_ = 0;
  int depth_ = 0;
  // Nodes in breadth-first order; node 0 is the root. Children of a node are contiguous.
  struct Node {
    Descriptor centre{};
    std::uint32_t first_child = 0;
    std::uint32_t child_count = 0;  ///< 0 = leaf
    WordId word = 0;                ///< leaves only
  };
  std::vector<Node> nodes_;
  std::vector<float> idf_;
};

}  // namespace mh
