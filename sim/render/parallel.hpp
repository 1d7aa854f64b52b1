// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace mh {

/// Calls work(i, state) once for every i in [0, count), from up to `threads` threads, each with its
/// own state from make_state(). The caller ensures that each i writes only its own output and
/// depends on nothing that another i left in the state, so that the thread count changes no bit.
template <class MakeState, class Work>
void parallel_for(int count, int threads, const MakeState& make_state, const Work& work) {
  std::atomic<int> next = 0;
  const auto run = [&] {
    auto state = make_state();
    for (int i = next++; i < count; i = next++) work(i, state);
  };
  std::vector<std::jthread> helpers;
  for (int t = 1; t < threads && t < count; ++t) helpers.emplace_back(run);
  run();
}

/// The same without a state: work(i).
template <class Work>
void parallel_for(int count, int threads, const Work& work) {
  parallel_for(
      count, threads, [] { return 0; }, [&](int i, int) { work(i); });
}

}  // namespace mh
