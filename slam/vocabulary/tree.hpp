// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/features/features.hpp"

namespace mh {

/// A vocabulary as plain data: the result of training and reading, and the content of the file.
/// Nodes are in breadth-first order; siblings are contiguous, in the order of their parents.
struct VocabularyTree {
  std::uint32_t branching = 0;             ///< maximum children of a node, 2 to 255
  std::uint32_t depth = 0;                 ///< levels below the root
  std::uint32_t images = 0;                ///< number of training images; 0 = unknown
  std::uint64_t descriptors = 0;           ///< number of descriptors in these images; 0 = unknown
  std::vector<Descriptor> centers;         ///< of each node; the root's is zero
  std::vector<std::uint8_t> child_counts;  ///< of each node; 0 = a word
  std::vector<float> idf;                  ///< of each word, in the order of their nodes
};

/// The bytes of a vocabulary file.
std::string encode(const VocabularyTree& tree);

/// Reads DBoW2's text format (ORB-SLAM's ORBvoc.txt): a line "k L scoring weighting", then a line
/// "parent is_leaf byte*32 weight" for each node except the root; ids count from 1 in the order of
/// these lines. Words are renumbered breadth first. Scoring and weighting are checked but not used,
/// since word weights come from the lines and vectors are always compared by their L1 distance.
/// @param name  of the file, for messages.
/// @throws InputError "name:line: ..." if the text is not such a tree.
VocabularyTree read_dbow2_text(std::string_view text, const std::string& name);

/// Writes the same format, for programs that read it: nodes breadth first, weights with all digits,
/// scoring L1 (0), weighting TF-IDF (0). The last line has no line end: ORB-SLAM's reader would
/// take an empty line for a node. Training counts are not written. @throws InputError if the tree
/// has more than the 20 children per node that ORB-SLAM's reader takes.
std::string dbow2_text(const VocabularyTree& tree);

}  // namespace mh
