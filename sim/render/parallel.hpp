// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace mh {

/// Calls work(i) once for every i in [0, count), from up to `threads` threads. The caller makes
/// sure that each i writes its own output only, so that the thread count changes no bit.
template <class Work>
void parallel_for(int count, int threads, const Work& work) {
  std::atomic<int> next = 0;
  const auto run = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> helpers;
  for (int t = 1; t < threads && t < count; ++t) helpers.emplace_back(run);
  run();
}

}  // namespace mh
