// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "slam/features/features.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {

struct VocabularyTree;
using WordId = std::uint32_t;

/// A tree of visual words: hierarchical k-medians over binary descriptors (Galvez-Lopez and Tardos,
/// T-RO 2012, after Nister and Stewenius, CVPR 2006). Default-constructed, it is empty and can only
/// be assigned to. Immutable; copies share one tree, which may be in a mapped file.
class Vocabulary {
 public:
  struct TrainConfig {
    int branching = 10;       ///< children per node, 2 to 255
    int depth = 5;            ///< levels below the root, 1 to 10; at most branching^depth words
    int max_iterations = 12;  ///< of k-medians at each node, >= 1
    std::uint64_t seed = 0;
  };
  struct Quantized {
    WordId word = 0;
    /// Ancestor at the direct index's level, kDirectIndexLevel below the root (the leaf itself if
    /// the tree ends sooner): only features under the same node are compared.
    std::uint32_t node = 0;
  };

  /// branching^2 nodes, typically 100: with 1,000 features in an image, about 10 share a node.
  static constexpr int kDirectIndexLevel = 2;
  static constexpr std::uint32_t kFileVersion = 2;

  /// Trains on the descriptors of many images. Deterministic: same images and config, same tree.
  /// Weights are idf = ln(images / images with the word); every word occurs in some image.
  /// @throws std::invalid_argument naming a setting out of range; InputError if there are no
  /// descriptors.
  static Vocabulary train(std::span<const std::vector<Descriptor>> images,
                          const TrainConfig& config);

  /// Wraps an existing tree. @throws InputError if it is inconsistent.
  explicit Vocabulary(const VocabularyTree& tree);
  Vocabulary() = default;

  /// Maps a file of our own into memory (held_bytes.hpp states the requirements), or reads one in
  /// DBoW2's text format (read_dbow2_text()), which takes about a hundred times as long.
  /// @throws InputError naming file and fault: missing, not a vocabulary, another version,
  /// truncated, checksum wrong; for text, its line.
  static Vocabulary load(const std::filesystem::path& file);
  /// Saves in our own format, atomically. @throws InputError if it cannot be written.
  void save(const std::filesystem::path& file) const;

  /// Saves in DBoW2's text format (dbow2_text()). @throws InputError if it does not fit or cannot
  /// be written.
  void save_dbow2(const std::filesystem::path& file) const;

  /// Returns the word of a descriptor: from the root down, always the nearest child in Hamming
  /// distance, ties to the first. @pre not empty.
  Quantized quantize(const Descriptor& descriptor) const;

  std::size_t size() const { return idf_.size(); }  ///< number of words
  float idf(WordId word) const { return idf_[word]; }
  int branching() const { return branching_; }
  int depth() const { return depth_; }
  std::size_t node_count() const { return centers_.size(); }
  std::uint32_t training_images() const { return training_images_; }  ///< 0 = unknown
  std::uint64_t training_descriptors() const { return training_descriptors_; }
  /// Digest of the file's content: equal digests, equal vocabularies. 0 if empty.
  std::uint64_t digest() const { return digest_; }

 private:
  /// @throws InputError "name: ..." unless the bytes are those of a vocabulary file.
  Vocabulary(HeldBytes bytes, const std::string& name);

  HeldBytes bytes_;  ///< the whole file; the members below point into it
  std::span<const Descriptor> centers_;
  std::span<const float> idf_;
  const std::uint8_t* child_counts_ = nullptr;
  /// Per node: its first child, or its word if it has no children.
  std::shared_ptr<const std::vector<std::uint32_t>> links_;
  int branching_ = 0;
  int depth_ = 0;
  std::uint32_t training_images_ = 0;
  std::uint64_t training_descriptors_ = 0;
  std::uint64_t digest_ = 0;
};

}  // namespace mh
