// SPDX-License-Identifier: Apache-2.0
// The paper's equations in a program that has its own descriptors, ids and map.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <modelhouse/semantics/augmented_vector.hpp>
#include <modelhouse/semantics/candidate_selection.hpp>
#include <modelhouse/semantics/descriptor_distance.hpp>

namespace {

void require(bool truth, const char* what) {
  if (truth) return;
  std::fprintf(stderr, "consumer: %s\n", what);
  std::exit(1);
}

struct Place {
  std::string name;
  mh::AugmentedVector seen;
};

mh::AugmentedVector describe(const std::vector<mh::Label>& labels,
                             const std::vector<std::uint32_t>& words) {
  return mh::augmented_vector(labels, words, 1.0, [](std::uint32_t) { return 0.5; });
}

}  // namespace

int main() {
  // Equation 1: two keypoints on label 3 (weight 1 each) and words 7, 7, 9 (weight 0.5 each).
  const mh::AugmentedVector f = describe({3, 3, mh::kNoLabel}, {7, 7, 9});
  require(std::abs(f.label_mass() - 2.0 / 3.5) < 1e-12, "equation 1: labels hold 2 of 3.5");

  // Equation 2, here with float distances.
  require(mh::semantic_distance(4.0F, mh::labels_disagree(3, 5), 1.5F) == 6.0F, "equation 2");

  // Equations 3 to 6 find the one of three places that equals the query.
  const std::array<Place, 3> places{Place{"kitchen", f}, Place{"hall", describe({5, 5}, {1, 2, 3})},
                                    Place{"bath", describe({3, 5}, {7, 1, 2})}};
  const std::vector<int> keys{0, 1, 2};
  const auto selection = mh::select_candidates<int>(
      keys, [&](int k) { return mh::shared_labels(f, places[static_cast<std::size_t>(k)].seen); },
      [](int k) { return std::array<int, 1>{k}; },
      [&](int k) { return mh::l1_similarity(f, places[static_cast<std::size_t>(k)].seen); }, 0.8,
      0.75);
  require(selection.c1 == 2, "equation 3: two places share a label");
  require(selection.candidates.size() == 1, "equation 6: one candidate is left");
  require(places[static_cast<std::size_t>(selection.candidates.front().keyframe)].name == "kitchen",
          "equation 6: and it is the right one");
  std::puts("consumer: equations 1 to 6 work outside the house");
}
