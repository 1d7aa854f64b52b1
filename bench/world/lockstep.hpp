// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

namespace mh {

/// Lets at most `jobs` of several runs work at a time, and keeps those that share pictures close to
/// one another, so that each picture is made once. It decides when work is done, never what comes
/// out of it. The slowest run never waits for another, so there is no deadlock.
class Lockstep {
 public:
  /// @param runs    number of runs, ids 0 .. runs - 1
  /// @param window  how far a run may be ahead of the slowest
  Lockstep(std::size_t runs, int jobs, std::size_t window);

  /// Waits for a place to work. Every start is followed by finish, whatever happens.
  void start(std::size_t run);
  /// This run is about to do its piece of work number `position`; waits while it is too far ahead.
  void advance(std::size_t run, std::size_t position);
  void finish(std::size_t run);

 private:
  bool may_go(std::size_t position) const;
  void take_place(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::size_t> position_;
  int free_places_;
  std::size_t window_;
};

}  // namespace mh
