// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/recordings/file_checksums.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "slam/core/imu.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

// EuRoC's layout (Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016): mav0/cam0,
// cam1 (for stereo), imu0 and state_groundtruth_estimate0. The body frame is the frame of the first
// camera, which is also that of the inertial sensor in the same housing.

inline constexpr std::string_view kEurocImuColumns =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
std::string euroc_line(const ImuReading& reading);
void write_euroc_imu(const std::filesystem::path& file, std::span<const ImuReading> readings);

/// Reads the measurements of an inertial sensor, a file with the columns kEurocImuColumns. Readings
/// that are not finite and those whose stamp does not increase are left out and counted.
/// @param notes  receives how many were left out
/// @throws InputError naming file, line and value: not seven numbers, no reading, accelerations
/// that are not in m/s^2 (the mean of a sensor that is not falling is near 9.81)
std::vector<ImuReading> read_euroc_imu(const std::filesystem::path& file,
                                       std::vector<std::string>& notes);

/// One camera's images, gray, without depth or labels.
class EurocCameraWriter : public SequenceWriter {
 public:
  /// @param number  0, or 1 for the right camera of a pair
  /// @param right_m  how far it is to the right of the first camera, m
  /// @throws InputError if the lens has coefficients other than k1, k2, p1, p2, which the layout
  /// cannot store
  EurocCameraWriter(const std::filesystem::path& folder, int number, double right_m,
                    const Camera& camera, PngCompression png_compression = {});
  void add(std::size_t index, const ExactFrame& frame) override;
  bool resume(std::size_t index, Stamp stamp_ns, const SE3& world_from_camera) override;
  void finish() override;
  /// The poses of the frames that were added.
  Trajectory truth() const;

 private:
  std::filesystem::path file_of(Stamp stamp_ns) const;

  std::filesystem::path folder_;
  double right_m_;
  Camera camera_;
  std::vector<int> png_;
  FileChecksums checksums_;
  std::mutex mutex_;
  std::map<Stamp, SE3> truth_;
};

/// Noise densities for imu0/sensor.yaml: rad/s/sqrt(Hz), rad/s^2/sqrt(Hz), m/s^2/sqrt(Hz),
/// m/s^3/sqrt(Hz).
struct EurocImuNoise {
  double rate_hz, gyro_noise, gyro_walk, accel_noise, accel_walk;
};
/// Writes imu0 and state_groundtruth_estimate0.
/// @param frames  the poses of the camera's frames
/// @param path    the path along which `imu` was simulated
void write_euroc_states(const std::filesystem::path& folder, const Trajectory& frames,
                        const Trajectory& path, const ImuPath& imu, const EurocImuNoise& noise);

}  // namespace mh
