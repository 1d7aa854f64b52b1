// SPDX-License-Identifier: Apache-2.0
#include "slam/core/pose_collector.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/printable.hpp"

namespace mh {
namespace {

/// What a message says about one line and about several, in the order of PoseFault.
constexpr std::array<std::pair<const char*, const char*>, 4> kOneAndMore = {
    {{"is not finite", "are not finite"},
     {"has no rotation", "have no rotation"},
     {"repeats a stamp", "repeat a stamp"},
     {"is not a pose", "are not poses"}}};

}  // namespace

void LinePlace::fail(const std::string& what, PoseFault fault) const {
  throw BadPose(fmt::format("{}:{}: {}", file, line, printable(what)), fault);
}

void PoseCollector::add(const TimedPose& pose, std::string_view stamp, const LinePlace& place) {
  const bool later = poses_.empty() || pose.stamp_ns > latest_ns_;
  if (!later && (strict_ || stamps_.contains(pose.stamp_ns)))
    place.fail(fmt::format("stamp: {} does not come after {}", stamp, format_stamp(latest_ns_)),
               PoseFault::kRepeated);
  if (later)
    latest_ns_ = pose.stamp_ns;
  else
    ++early_;
  stamps_.insert(stamps_.end(), pose.stamp_ns);
  poses_.push_back(pose);
}

void PoseCollector::leave_out(const BadPose& line) {
  if (strict_) throw InputError(line);
  if (left_out() == 0) first_fault_ = std::string(line.what()).substr(file_.size() + 1);
  if (line.fault == PoseFault::kNoPose && count(PoseFault::kNoPose) == 0)
    first_no_pose_ = line.what();
  ++counts_[static_cast<std::size_t>(line.fault)];
}

Trajectory PoseCollector::finish(std::vector<std::string>* notes) {
  if (count(PoseFault::kNoPose) > poses_.size()) throw InputError(first_no_pose_);
  std::ranges::stable_sort(poses_, {}, &TimedPose::stamp_ns);
  if (left_out() > 0) notes->push_back(note());
  if (early_ > 0)
    notes->push_back(fmt::format("{}: {} after a later one and {} sorted by time", file_,
                                 counted(early_, "pose comes", "poses come"),
                                 early_ == 1 ? "is" : "are"));
  return std::exchange(poses_, {});
}

std::size_t PoseCollector::left_out() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

std::string PoseCollector::note() const {
  std::string kinds;
  for (std::size_t k = 0; k < counts_.size(); ++k)
    if (counts_[k] > 0)
      kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", counts_[k],
                           counts_[k] == 1 ? kOneAndMore[k].first : kOneAndMore[k].second);
  return fmt::format("{}: {} of {} {} left out: {}; the first in line {}", file_, left_out(),
                     counted(left_out() + poses_.size(), "pose"), left_out() == 1 ? "is" : "are",
                     kinds, first_fault_);
}

}  // namespace mh
