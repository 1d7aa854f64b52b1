// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace mh::cli {

/// Thrown by a command that ran to its end but whose check failed: exit code 1.
struct CheckFailed {};

// Each of these functions adds one subcommand. The command's work is done in its callback, after
// the whole command line is parsed.
void add_audit(CLI::App& app);
void add_bench(CLI::App& app);
void add_check(CLI::App& app);
void add_degrade(CLI::App& app);
void add_detector(CLI::App& app);
void add_detector_score(CLI::App& detector);
void add_diagnose(CLI::App& app);
void add_drive(CLI::App& app);
void add_live(CLI::App& app);
void add_episode(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_export(CLI::App& app);
void add_map(CLI::App& app);
void add_map_build(CLI::App& map);
void add_merge(CLI::App& app);
void add_run_child(CLI::App& app);
void add_reference(CLI::App& app);
void add_render(CLI::App& app);
void add_report(CLI::App& app);
void add_scene(CLI::App& app);
void add_scene_statistics(CLI::App& scene);
void add_sensors(CLI::App& app);
void add_slam(CLI::App& app);
void add_stress(CLI::App& app);
void add_twin(CLI::App& app);
void add_verify(CLI::App& app);
void add_vocabulary(CLI::App& app);
/// Adds `completion` and `manual`, whose texts are generated from all commands of `app`.
void add_declarations(CLI::App& app);

}  // namespace mh::cli
