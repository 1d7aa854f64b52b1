// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/suite/episodes_spec.hpp"
#include "bench/suite/graded_spec.hpp"
#include "bench/suite/runs.hpp"

namespace mh {

nlohmann::ordered_json to_json(const SemanticConfig& settings);
/// All settings of SLAM, section by section.
nlohmann::ordered_json to_json(const SlamConfig& settings);
nlohmann::ordered_json to_json(const ProtocolConfig& protocol);
nlohmann::ordered_json to_json(const GradedSpec& graded);
/// All but its variants.
nlohmann::ordered_json to_json(const EpisodesSpec& episodes);
/// Only the fields that are set: none set gives {}.
nlohmann::ordered_json to_json(const SceneFrame& frame);
/// Everything about a run, with paths unchanged: the input of a separate process.
nlohmann::ordered_json to_json(const RunSpec& spec);

/// The inverse. @throws InputError if the JSON was not created by to_json.
SceneFrame scene_frame_from_json(const nlohmann::ordered_json& json);
RunSpec run_spec_from_json(const nlohmann::ordered_json& json);

}  // namespace mh
