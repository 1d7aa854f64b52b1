// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "bench/suite/outside_program.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Tolerance for the stamps of a program's poses (programs print them with few digits).
inline constexpr Stamp kStampTolerance_ns = 1'000'000;

/// Writes a folder in TUM's layout for an outside program: images, lists, labels of the frames that
/// have them, calibration. It does not contain the ground truth. @returns the stamps, in order.
/// @param frame  returns frame i; nullopt omits it
std::vector<Stamp> write_dataset(const std::filesystem::path& folder, const Camera& camera,
                                 std::size_t count,
                                 const std::function<std::optional<RgbdFrame>(std::size_t)>& frame);

/// Runs an outside program in trajectory mode, under its limits.
/// @param folder  contains write_dataset()'s folder as `dataset` and nothing else; the program
///                writes its trajectory.txt there
/// @param stamps  of the dataset's frames, increasing
/// @param log     file for what the program prints; outside the folder
/// @param read    called repeatedly with the number of color images opened so far
/// @returns the program's trajectory with the frames' own stamps
/// @throws InputError if validate(program) does; OutsideError if the program fails, or its
///         trajectory is missing, malformed, or contains a non-finite number, a pose beyond
///         kFarthestPose_m, a stamp that matches no frame or two poses for one frame.
Trajectory run_on_dataset(
    const OutsideProgram& program, const std::filesystem::path& folder,
    std::span<const Stamp> stamps, std::uint64_t seed, const std::filesystem::path& log,
    const std::function<void(std::size_t)>& read = [](std::size_t) {});

}  // namespace mh
