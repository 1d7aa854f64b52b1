// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "bench/results/run_result.hpp"
#include "bench/world/frame_studio.hpp"
#include "robots/model/robot.hpp"

namespace mh {

/// Where one run's frames come from, and what else it needs to know of its place.
struct RunPlace {
  FrameStudio& mapping;
  FrameStudio* second_tour = nullptr;  ///< may be null
  const Robot& robot;
};

/// Seam for the test of `verify`: may change a frame before the system sees it, or an answer before
/// anybody else does. Empty in every real run.
struct RunTamper {
  std::function<void(const RunSpec&, std::size_t index, RgbdFrame&)> frame;
  std::function<void(const RunSpec&, std::size_t index, StepReport&)> report;
};

/// One run from the first frame to the last query: map the tour, freeze, score the trajectory, put
/// the queries, build the occupancy map.
/// @param advance  called before each frame with the number of the piece of work
RunResult run_one(const RunSpec& spec, const Suite& suite, std::unique_ptr<System> system,
                  const RunPlace& place, const std::function<void(std::size_t)>& advance,
                  const RunTamper& tamper = {});

}  // namespace mh
