// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/euroc.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "scenes/recordings/images/write_image.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::string body_from_sensor(double right_m) {
  return fmt::format(
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [1.0, 0.0, 0.0, {:#g},\n         0.0, 1.0, 0.0, 0.0,\n"
      "         0.0, 0.0, 1.0, 0.0,\n         0.0, 0.0, 0.0, 1.0]\n",
      right_m);
}

std::string comma(const Eigen::Vector3d& v) {
  return fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z());
}

}  // namespace

std::string euroc_line(const ImuReading& reading) {
  return fmt::format("{}{}{}\n", reading.stamp_ns, comma(reading.turn_rad_per_s),
                     comma(reading.specific_force_m_per_s2));
}

void write_euroc_imu(const fs::path& file, std::span<const ImuReading> readings) {
  std::string text = fmt::format("{}\n", kEurocImuColumns);
  for (const ImuReading& reading : readings) text += euroc_line(reading);
  write_atomically(file, text);
}

namespace {

/// Parses the stamp and the six values of a line; nullopt if a value is not finite.
std::optional<ImuReading> parse_reading(std::string_view line, const std::string& place) {
  std::array<double, 6> values{};
  const std::size_t comma = line.find(',');
  Stamp stamp_ns = 0;
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto stamp = std::from_chars(at, end, stamp_ns);
  if (stamp.ec != std::errc() || comma == std::string_view::npos ||
      stamp.ptr != line.data() + comma)
    throw InputError(
        fmt::format("{}: '{}' does not begin with a stamp in ns", place, line.substr(0, comma)));
  at = stamp.ptr;
  for (double& value : values) {
    while (at < end && (*at == ',' || *at == ' ')) ++at;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc())
      throw InputError(
          fmt::format("{}: '{}' does not have seven numbers: stamp, 3 from the gyroscope, 3 from "
                      "the accelerometer",
                      place, line));
    at = read.ptr;
  }
  const ImuReading reading{
      stamp_ns, {values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
  if (!reading.turn_rad_per_s.allFinite() || !reading.specific_force_m_per_s2.allFinite())
    return std::nullopt;
  return reading;
}

}  // namespace

std::vector<ImuReading> read_euroc_imu(const fs::path& file, std::vector<std::string>& notes) {
  const std::string text = read_text(file);
  std::vector<ImuReading> readings;
  std::size_t unknown = 0, backward = 0, number = 0;
  double sum = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    const auto reading = parse_reading(line, fmt::format("{}:{}", file.string(), number));
    if (!reading)
      ++unknown;
    else if (!readings.empty() && reading->stamp_ns <= readings.back().stamp_ns)
      ++backward;
    else
      readings.push_back(*reading), sum += reading->specific_force_m_per_s2.norm();
  }
  if (readings.empty()) throw InputError(fmt::format("{}: holds no reading", file.string()));
  const double mean = sum / static_cast<double>(readings.size());
  if (mean < 5 || mean > 15)
    throw InputError(fmt::format("{}: accelerations are {:.3g} on average, not near 9.81 m/s^2{}",
                                 file.string(), mean,
                                 mean > 0.8 && mean < 1.2 ? ": they are in units of g" : ""));
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0)
      notes.push_back(
          fmt::format("{}: {} left out: {}", file.string(), counted(count, "reading"), what));
  };
  note(unknown, "not a number");
  note(backward, "the stamp does not increase");
  return readings;
}

EurocCameraWriter::EurocCameraWriter(const fs::path& folder, int number, double right_m,
                                     const Camera& camera, PngCompression png_compression)
    : folder_(folder / "mav0" / fmt::format("cam{}", number)),
      right_m_(right_m),
      camera_(camera),
      png_(png_settings(png_compression)),
      checksums_(folder_) {
  const Distortion& lens = camera.distortion;
  if (lens.k3 != 0 || lens.is_rational())
    throw InputError(
        fmt::format("format 'euroc' holds only k1, k2, p1 and p2 of a lens, but the camera has {}",
                    text_of(lens)));
  make_output_folder(folder_ / "data");
}

fs::path EurocCameraWriter::file_of(Stamp stamp_ns) const {
  return folder_ / "data" / fmt::format("{}.png", stamp_ns);
}

void EurocCameraWriter::add(std::size_t, const ExactFrame& frame) {
  cv::Mat gray;
  cv::cvtColor(color_image(frame.seen.color), gray, cv::COLOR_BGR2GRAY);
  const std::array file = {file_of(frame.seen.stamp_ns)};
  write_image(file[0], gray, png_);
  checksums_.add(file);
  const std::scoped_lock lock(mutex_);
  truth_[frame.seen.stamp_ns] = frame.world_from_camera;
}

bool EurocCameraWriter::resume(std::size_t, Stamp stamp_ns, const SE3& world_from_camera) {
  if (!checksums_.hold(std::array{file_of(stamp_ns)})) return false;
  const std::scoped_lock lock(mutex_);
  truth_[stamp_ns] = world_from_camera;
  return true;
}

void EurocCameraWriter::finish() {
  checksums_.finish();
  std::string list = "#timestamp [ns],filename\n";
  for (const auto& [stamp_ns, pose] : truth_) list += fmt::format("{0},{0}.png\n", stamp_ns);
  write_atomically(folder_ / "data.csv", list);
  const Distortion& lens = camera_.distortion;
  write_atomically(
      folder_ / "sensor.yaml",
      fmt::format(
          "sensor_type: camera\ncomment: Modelhouse\n{}rate_hz: {:#g}\nresolution: [{}, {}]\n"
          "camera_model: pinhole\nintrinsics: [{:#.12g}, {:#.12g}, {:#.12g}, {:#.12g}]\n"
          "distortion_model: radial-tangential\n"
          "distortion_coefficients: [{:#g}, {:#g}, {:#g}, {:#g}]\n",
          body_from_sensor(right_m_), camera_.rate_hz, camera_.width_px, camera_.height_px,
          camera_.fx_px, camera_.fy_px, camera_.cx_px, camera_.cy_px, lens.k1, lens.k2, lens.p1,
          lens.p2));
}

Trajectory EurocCameraWriter::truth() const {
  Trajectory path;
  for (const auto& [stamp_ns, pose] : truth_) path.push_back({stamp_ns, pose});
  return path;
}

void write_euroc_states(const fs::path& folder, const Trajectory& frames, const Trajectory& path,
                        const ImuPath& imu, const EurocImuNoise& noise) {
  const fs::path mav = folder / "mav0";
  for (const char* part : {"imu0", "state_groundtruth_estimate0"}) make_output_folder(mav / part);
  write_euroc_imu(mav / "imu0" / "data.csv", imu.readings);
  write_atomically(
      mav / "imu0" / "sensor.yaml",
      fmt::format("sensor_type: imu\ncomment: Modelhouse\n{}rate_hz: {:#g}\n"
                  "gyroscope_noise_density: {:#g}\ngyroscope_random_walk: {:#g}\n"
                  "accelerometer_noise_density: {:#g}\naccelerometer_random_walk: {:#g}\n",
                  body_from_sensor(0), noise.rate_hz, noise.gyro_noise, noise.gyro_walk,
                  noise.accel_noise, noise.accel_walk));
  std::string states =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], "
      "b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], "
      "b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n";
  for (const TimedPose& frame : frames) {
    const auto at = std::ranges::lower_bound(path, frame.stamp_ns, {}, &TimedPose::stamp_ns);
    const auto bias =
        std::ranges::lower_bound(imu.biases, frame.stamp_ns, {}, &ImuReading::stamp_ns);
    if (at == path.end() || imu.biases.empty()) continue;
    const ImuReading& errs = bias == imu.biases.end() ? imu.biases.back() : *bias;
    const Eigen::Vector3d& velocity =
        imu.velocities_m_per_s[static_cast<std::size_t>(at - path.begin())];
    const Eigen::Quaterniond q = frame.world_from_camera.quaternion();
    states += fmt::format("{}{},{:.9g},{:.9g},{:.9g},{:.9g}{}{}{}\n", frame.stamp_ns,
                          comma(frame.world_from_camera.translation()), q.w(), q.x(), q.y(), q.z(),
                          comma(velocity), comma(errs.turn_rad_per_s),
                          comma(errs.specific_force_m_per_s2));
  }
  write_atomically(mav / "state_groundtruth_estimate0" / "data.csv", states);
}

}  // namespace mh
