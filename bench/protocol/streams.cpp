// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/streams.hpp"

namespace mh {
namespace {

enum StreamName : std::uint64_t {
  kMapping = 1,
  kHeldOut = 2,
  kSecondTour = 3,
  kGraded = 4,
  kTourOfEpisodes = 0x746f7572
};

}  // namespace

RandomStream mapping_stream(const RunSpec& spec) {
  return RandomStream(spec.seed).fork(spec.episodes ? kTourOfEpisodes : kMapping);
}

RandomStream mapping_noise(RandomStream stream, int restart) {
  return stream.fork(RunDraw::kNoise).fork(static_cast<std::uint64_t>(restart));
}

std::vector<RandomStream> shared_noises(const RunSpec& spec) {
  constexpr int kRestarts = 64;
  std::vector<RandomStream> noises;
  for (int restart = 0; restart <= kRestarts; ++restart)
    noises.push_back(mapping_noise(mapping_stream(spec), restart));
  return noises;
}

RandomStream query_stream(const RunSpec& spec, QuerySet set) {
  return RandomStream(spec.seed).fork(set == QuerySet::kHeldOut      ? kHeldOut
                                      : set == QuerySet::kSecondTour ? kSecondTour
                                                                     : kGraded);
}

}  // namespace mh
