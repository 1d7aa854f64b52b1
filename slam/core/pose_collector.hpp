// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/trajectory.hpp"
#include "slam/io/error.hpp"

namespace mh {

/// Why a line of a file gives no pose.
enum class PoseFault { kNotFinite, kZero, kRepeated, kNoPose };

class BadPose : public InputError {
 public:
  BadPose(const std::string& what, PoseFault why) : InputError(what), fault(why) {}
  PoseFault fault;
};

/// Position of a line, for messages.
struct LinePlace {
  const std::string& file;
  int line;

  /// @throws BadPose "file:line: what"
  [[noreturn]] void fail(const std::string& what, PoseFault fault = PoseFault::kNoPose) const;
};

/// The poses of a file in the order of their stamps, and what was left out.
class PoseCollector {
 public:
  /// @param strict  if true, nothing may be left out, and stamps must be in order
  PoseCollector(const std::string& file, bool strict) : file_(file), strict_(strict) {}

  /// @param stamp  as written in the file @throws BadPose if an earlier line has the same stamp
  void add(const TimedPose& pose, std::string_view stamp, const LinePlace& place);
  /// @throws InputError if strict
  void leave_out(const BadPose& line);
  /// The poses; empties the collector. @param notes  receives notes on what was left out or sorted
  /// @throws InputError if most lines are not poses: the file is something else
  Trajectory finish(std::vector<std::string>* notes);
  /// "; line 5: ..." for a message; empty if nothing was left out
  std::string first_fault() const { return first_fault_.empty() ? "" : "; line " + first_fault_; }

 private:
  std::size_t count(PoseFault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  std::size_t left_out() const;
  std::string note() const;

  const std::string& file_;
  bool strict_;
  Trajectory poses_;
  std::set<Stamp> stamps_;
  Stamp latest_ns_ = 0;
  std::size_t early_ = 0;  ///< poses that follow one with a later stamp
  std::array<std::size_t, 4> counts_{};
  std::string first_fault_, first_no_pose_;
};

}  // namespace mh
