// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "bench/protocol/episodes/starts.hpp"
#include "bench/suite/input_digest.hpp"
#include "bench/suite/run_spec.hpp"
#include "sim/sensors/config.hpp"
#include "sim/simulation/simulation.hpp"

namespace mh {

struct SimulatedPlace;

/// The place where the robot is kidnapped, which may differ from the mapped one, and the starts.
struct VariantPlace {
  std::string name;
  SimulatedScene scene;
  SensorConfig level;
  std::vector<EpisodeStart> starts;
};

/// The variants of a run's episodes.
/// @param mapped  the place that was mapped
/// @param inputs  receives what was read for the variants, named by input_name()
/// @param light   bakes a scene's light
/// @throws InputError as draw_starts() does, or if a scene's floor is not at z = 0 or the robot
/// cannot drive on its own.
std::vector<VariantPlace> make_variants(const RunSpec& spec, const SimulatedPlace& mapped,
                                        std::vector<InputDigest>& inputs,
                                        const std::function<void(Scene&)>& light);

/// Checks, before anything is mapped, that there is something to find in a run's environment.
/// @throws InputError as make_variants() does
void require_goals(const RunSpec& spec);

}  // namespace mh
