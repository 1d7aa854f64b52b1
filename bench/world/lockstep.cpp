// SPDX-License-Identifier: Apache-2.0
#include "bench/world/lockstep.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace mh {
namespace {
constexpr std::size_t kFinished = std::numeric_limits<std::size_t>::max();
}

Lockstep::Lockstep(std::size_t runs, int jobs, std::size_t window)
    : position_(runs, 0), free_places_(jobs), window_(window) {
  assert(jobs >= 1);
}

bool Lockstep::may_go(std::size_t position) const {
  const std::size_t slowest = *std::min_element(position_.begin(), position_.end());
  return position <= slowest || position - slowest <= window_;
}

void Lockstep::take_place(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [&] { return free_places_ > 0; });
  --free_places_;
}

void Lockstep::start(std::size_t run) {
  std::unique_lock lock(mutex_);
  position_[run] = 0;
  take_place(lock);
}

void Lockstep::advance(std::size_t run, std::size_t position) {
  std::unique_lock lock(mutex_);
  const bool slowed_others = position != position_[run];
  position_[run] = position;
  if (slowed_others) changed_.notify_all();
  if (may_go(position)) return;
  ++free_places_;
  changed_.notify_all();
  changed_.wait(lock, [&] { return may_go(position); });
  take_place(lock);
}

void Lockstep::finish(std::size_t run) {
  const std::lock_guard lock(mutex_);
  position_[run] = kFinished;
  ++free_places_;
  changed_.notify_all();
}

}  // namespace mh
