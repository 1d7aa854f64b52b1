// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/vocabulary/kmedians.hpp"
#include "slam/vocabulary/tree.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {

void require(bool good, const char* field, int value) {
  if (!good)
    throw std::invalid_argument(fmt::format("vocabulary: {} = {} is out of range", field, value));
}

void validate(const Vocabulary::TrainConfig& config) {
  require(config.branching >= 2 && config.branching <= 255, "branching", config.branching);
  require(config.depth >= 1 && config.depth <= 10, "depth", config.depth);
  require(config.max_iterations >= 1, "max_iterations", config.max_iterations);
}

std::vector<Descriptor> all_of(std::span<const std::vector<Descriptor>> images) {
  std::vector<Descriptor> all;
  for (const std::vector<Descriptor>& image : images)
    all.insert(all.end(), image.begin(), image.end());
  if (all.empty()) throw InputError("vocabulary: there is nothing to learn from: no descriptors");
  return all;
}

/// Grows the tree breadth first, each node from the descriptors that reach it.
class VocabularyTrainer {
 public:
  VocabularyTrainer(std::span<const std::vector<Descriptor>> images,
                    const Vocabulary::TrainConfig& config)
      : images_(images), config_(config), descriptors_(all_of(images)) {
    tree_.branching = static_cast<std::uint32_t>(config.branching);
    tree_.depth = static_cast<std::uint32_t>(config.depth);
    tree_.images = static_cast<std::uint32_t>(images.size());
    tree_.descriptors = descriptors_.size();
  }

  Vocabulary train() {
    std::vector<std::uint32_t> everything(descriptors_.size());
    std::iota(everything.begin(), everything.end(), 0U);
    add_node(Descriptor{});
    std::vector<Pending> level = {{0, std::move(everything)}};
    for (int depth = 0; depth < config_.depth; ++depth) level = grow(level, depth);
    tree_.idf.assign(
        static_cast<std::size_t>(std::ranges::count(tree_.child_counts, std::uint8_t{0})), 0.0F);
    weigh_words(Vocabulary(tree_));
    return Vocabulary(tree_);
  }

 private:
  // A node and the descriptors that reach it.
  struct Pending {
    std::uint32_t node;
    std::vector<std::uint32_t> members;
  };

  // Gives each node of a level its children. @returns the next level.
  std::vector<Pending> grow(const std::vector<Pending>& level, int depth) {
    std::vector<Pending> next;
    for (const Pending& pending : level) {
      // Draws depend only on the node.
      const RandomStream random = RandomStream(config_.seed).fork(pending.node);
      const Clusters clusters =
          cluster(descriptors_, pending.members, config_.branching, config_.max_iterations, random);
      // All descriptors are equal: splitting further would only make a chain. The root must have a
      // child, though.
      if (clusters.centers.size() == 1 && depth > 0) continue;
      add_children(pending, clusters, next);
    }
    return next;
  }

  void add_node(const Descriptor& center) {
    tree_.centers.push_back(center);
    tree_.child_counts.push_back(0);
  }

  void add_children(const Pending& parent, const Clusters& clusters, std::vector<Pending>& next) {
    const std::size_t first_pending = next.size();
    tree_.child_counts[parent.node] = static_cast<std::uint8_t>(clusters.centers.size());
    for (const Descriptor& center : clusters.centers) {
      next.push_back({static_cast<std::uint32_t>(tree_.centers.size()), {}});
      add_node(center);
    }
    for (std::size_t i = 0; i < parent.members.size(); ++i)
      next[first_pending + clusters.cluster_of[i]].members.push_back(parent.members[i]);
  }

  // Computes the inverse document frequencies. At every node, descriptors were assigned to the
  // final centers, so quantizing a training descriptor gives the word that it helped to form, and
  // every word occurs in some image.
  void weigh_words(const Vocabulary& unweighted) {
    std::vector<std::uint32_t> images_with(tree_.idf.size(), 0);
    std::vector<std::uint32_t> last_image(tree_.idf.size(), UINT32_MAX);
    std::uint32_t count = 0;
    for (const std::vector<Descriptor>& image : images_) {
      for (const Descriptor& d : image) {
        const WordId word = unweighted.quantize(d).word;
        if (last_image[word] == count) continue;
        last_image[word] = count;
        ++images_with[word];
      }
      ++count;
    }
    for (std::size_t w = 0; w < images_with.size(); ++w) {
      assert(images_with[w] > 0);
      tree_.idf[w] = static_cast<float>(std::log(static_cast<double>(count) / images_with[w]));
    }
  }

  std::span<const std::vector<Descriptor>> images_;
  Vocabulary::TrainConfig config_;
  std::vector<Descriptor> descriptors_;
  VocabularyTree tree_;
};

}  // namespace

Vocabulary Vocabulary::train(std::span<const std::vector<Descriptor>> images,
                             const TrainConfig& config) {
  validate(config);
  return VocabularyTrainer(images, config).train();
}

}  // namespace mh
