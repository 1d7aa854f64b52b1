// SPDX-License-Identifier: Apache-2.0
#include "slam/pipeline/settings.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/core/error.hpp"
#include "slam/core/lower_case.hpp"
#include "slam/core/settings_io.hpp"
#include "slam/core/text_file.hpp"
#include "slam/features/undistort.hpp"

namespace mh {
namespace {

constexpr double kMost = 1e6;

/// Reads the distortion, whatever names a dialect gives its coefficients.
void read_distortion(YamlReader& yaml, const std::string& prefix, Camera& camera) {
  camera.distortion = {.k1 = yaml.number_or(prefix + "k1", 0, -kMost, kMost),
                       .k2 = yaml.number_or(prefix + "k2", 0, -kMost, kMost),
                       .p1 = yaml.number_or(prefix + "p1", 0, -kMost, kMost),
                       .p2 = yaml.number_or(prefix + "p2", 0, -kMost, kMost),
                       .k3 = yaml.number_or(prefix + "k3", 0, -kMost, kMost)};
}

/// @param place  of the distortion
void check_camera(const Camera& camera, const YamlReader& place) {
  try {
    validate(camera);
    require_undistortable(camera);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

void read_camera(YamlReader& yaml, Settings& settings) {
  auto section = yaml.find("camera");
  if (!section) return;
  YamlReader& camera = *section;
  settings.has_camera = true;
  Camera& c = settings.camera;
  c.width_px = static_cast<int>(camera.integer_or("width_px", c.width_px, 1, 100000));
  c.height_px = static_cast<int>(camera.integer_or("height_px", c.height_px, 1, 100000));
  c.fx_px = camera.number("fx_px", 1, kMost);
  c.fy_px = camera.number("fy_px", 1, kMost);
  c.cx_px = camera.number("cx_px", 0, c.width_px - 1);
  c.cy_px = camera.number("cy_px", 0, c.height_px - 1);
  c.rate_hz = camera.number_or("rate_hz", c.rate_hz, 1e-3, kMost);
  c.baseline_m = camera.number_or("baseline_m", c.baseline_m, 1e-6, kMost);
  c.disparity_sigma_px = camera.number_or("disparity_sigma_px", c.disparity_sigma_px, 1e-6, kMost);
  auto distortion = camera.find("distortion");
  if (distortion) {
    read_distortion(*distortion, "", c);
    distortion->finish();
  }
  camera.finish();
  check_camera(c, distortion ? *distortion : camera);
}

Settings read_own(YamlReader yaml, Settings settings) {
  read_camera(yaml, settings);
  if (auto images = yaml.find("images")) {
    settings.depth_per_meter =
        images->number_or("depth_per_meter", settings.depth_per_meter, 1e-3, 1e9);
    settings.exchange_red_blue = images->boolean("exchange_red_blue", false);
    images->finish();
  }
  settings.slam = read_slam_config(yaml, settings.slam);
  yaml.finish();
  return settings;
}

/// Keys of ORB-SLAM2's files that are read; the rest are for its viewer, or for other sensors.
constexpr auto kOrbSlamKeys = std::to_array<std::string_view>({"Camera.fx",
                                                               "Camera.fy",
                                                               "Camera.cx",
                                                               "Camera.cy",
                                                               "Camera.k1",
                                                               "Camera.k2",
                                                               "Camera.p1",
                                                               "Camera.p2",
                                                               "Camera.k3",
                                                               "Camera.width",
                                                               "Camera.height",
                                                               "Camera.fps",
                                                               "Camera.bf",
                                                               "Camera.RGB",
                                                               "ThDepth",
                                                               "DepthMapFactor",
                                                               "ORBextractor.nFeatures",
                                                               "ORBextractor.scaleFactor",
                                                               "ORBextractor.nLevels",
                                                               "ORBextractor.iniThFAST",
                                                               "ORBextractor.minThFAST"});

/// Other keys of such files: the camera type, of which ours is the only one, and keys for other
/// sensors.
constexpr auto kOrbSlamOthers = std::to_array<std::string_view>(
    {"Camera.type", "Camera.bFishEye", "Tbc", "Tlr", "loopClosing", "thFarPoints"});

bool is_one_of(const auto& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// Keys outside of sections and in sections that are read must be known: a typo would silently drop
/// the camera's distortion. Other sections belong to other programs.
void refuse_unknown_keys(YamlReader& yaml) {
  for (const auto& [key, node] : yaml.entries()) {
    if (key == "Camera.type" && node.as_string() != "PinHole")
      node.fail(fmt::format("'{}' is not PinHole", node.as_string()));
    if (key == "Camera.bFishEye" && node.as_string() != "0")
      node.fail("fisheye cameras are not supported");
    if (is_one_of(kOrbSlamKeys, key) || is_one_of(kOrbSlamOthers, key)) continue;
    const std::string section = lower_case(key.substr(0, key.find('.')));
    if (section == "camera" || section == "orbextractor" || key.find('.') == std::string::npos)
      node.fail(fmt::format("is not a key of ORB-SLAM2's settings (known: {})",
                            fmt::join(kOrbSlamKeys, ", ")));
  }
}

/// "Somebody.Else, Viewer.*": keys that nothing reads, those of the viewer as one.
/// Nobody would miss the position of a window (Viewer.*).
std::string unread_keys(YamlReader& yaml) {
  std::vector<std::string> unread;
  for (const auto& [key, node] : yaml.entries())
    if (!is_one_of(kOrbSlamKeys, key) && !key.starts_with("Camera.") && !key.starts_with("Viewer."))
      unread.push_back(key);
  return fmt::format("{}", fmt::join(unread, ", "));
}

Settings read_orb_slam(YamlReader yaml, Settings settings) {
  settings.has_camera = true;
  refuse_unknown_keys(yaml);
  Camera& c = settings.camera;
  c.width_px = static_cast<int>(yaml.integer_or("Camera.width", c.width_px, 1, 100000));
  c.height_px = static_cast<int>(yaml.integer_or("Camera.height", c.height_px, 1, 100000));
  c.fx_px = yaml.number("Camera.fx", 1, kMost);
  c.fy_px = yaml.number("Camera.fy", 1, kMost);
  c.cx_px = yaml.number("Camera.cx", 0, c.width_px - 1);
  c.cy_px = yaml.number("Camera.cy", 0, c.height_px - 1);
  read_distortion(yaml, "Camera.", c);
  const auto k1 = yaml.find("Camera.k1");
  check_camera(c, k1 ? *k1 : yaml);
  // Zero means the original's own default.
  const double rate_hz = yaml.number_or("Camera.fps", 0, 0, kMost);
  if (rate_hz != 0) c.rate_hz = rate_hz;
  c.baseline_m = yaml.number_or("Camera.bf", c.baseline_m * c.fx_px, 1e-6, kMost) / c.fx_px;
  settings.depth_per_meter = yaml.number_or("DepthMapFactor", settings.depth_per_meter, 0, 1e9);
  if (settings.depth_per_meter == 0) settings.depth_per_meter = 1;
  settings.exchange_red_blue = yaml.integer_or("Camera.RGB", 0, 0, 1) == 1;
  if (settings.exchange_red_blue)
    settings.notes.push_back(fmt::format(
        "{}: Camera.RGB: 1: the first channel is taken for red where OpenCV reads blue, as "
        "ORB-SLAM2 does; write 0 if colors matter and the files are ordinary ones",
        yaml.file()));

  FeatureConfig& f = settings.slam.features;
  f.count = static_cast<int>(yaml.integer_or("ORBextractor.nFeatures", f.count, 10, 20000));
  f.scale = yaml.number_or("ORBextractor.scaleFactor", f.scale, 1.01, 2);
  f.levels = static_cast<int>(yaml.integer_or("ORBextractor.nLevels", f.levels, 1, 16));
  f.fast_threshold =
      static_cast<int>(yaml.integer_or("ORBextractor.iniThFAST", f.fast_threshold, 1, 255));
  f.fast_threshold_low =
      static_cast<int>(yaml.integer_or("ORBextractor.minThFAST", f.fast_threshold_low, 1, 255));
  // Close points are those within this many baselines.
  if (const auto close = yaml.find("ThDepth"))
    settings.slam.keyframe.close_depth_m =
        std::clamp(close->as_double(1e-3, kMost) * c.baseline_m, 0.1, 1000.0);

  const std::string passed_over = unread_keys(yaml);
  if (!passed_over.empty())
    settings.notes.push_back(fmt::format("{}: passed over: {}", yaml.file(), passed_over));
  return settings;
}

/// A calibration as written by ROS' camera_calibration; lens distortion as plumb_bob.
Settings read_camera_info(YamlReader yaml, Settings settings) {
  settings.has_camera = true;
  Camera& c = settings.camera;
  c.width_px = static_cast<int>(yaml.integer("image_width", 1, 100000));
  c.height_px = static_cast<int>(yaml.integer("image_height", 1, 100000));
  constexpr std::array kMatrixKeys{"rows", "cols", "data"};
  const auto numbers = [&](YamlReader matrix) {
    for (const char* key : kMatrixKeys) matrix.find(key);
    matrix.finish();
    return matrix.at("data");
  };
  const YamlReader data = numbers(yaml.at("camera_matrix"));
  const std::vector<double> k = data.as_numbers(9);
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    data.fail("is not a matrix [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  c.fx_px = k[0];
  c.fy_px = k[4];
  c.cx_px = k[2];
  c.cy_px = k[5];
  if (const auto model = yaml.find("distortion_model"); model && model->as_string() != "plumb_bob")
    model->fail(fmt::format("'{}' is not plumb_bob", model->as_string()));
  check_camera(c, data);
  if (auto distortion = yaml.find("distortion_coefficients")) {
    const YamlReader list = numbers(*distortion);
    std::vector<double> d = list.as_numbers();
    if (d.size() > 5) list.fail(fmt::format("{} coefficients; plumb_bob has 5", d.size()));
    d.resize(5, 0.0);
    c.distortion = {.k1 = d[0], .k2 = d[1], .p1 = d[2], .p2 = d[3], .k3 = d[4]};
    check_camera(c, list);
  }
  // Used by stereo rigs and people.
  for (const char* key : {"camera_name", "rectification_matrix", "projection_matrix"})
    yaml.find(key);
  yaml.finish();
  return settings;
}

/// Converts OpenCV's YAML dialect, line by line: "key:value" becomes "key: value", and a top-level
/// line that repeats an earlier one word for word is dropped.
std::string without_dialect(const std::string& text) {
  std::string result;
  std::set<std::string> seen;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); result += line + '\n') {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t end = std::min(line.find_first_of(": #\"'[{", begin), line.size());
    if (end > begin && end + 1 < line.size() && line[end] == ':' && line[end + 1] != ' ')
      line.insert(end + 1, 1, ' ');
    if (begin == 0 && end > 0 && end + 1 < line.size() && line[end] == ':' &&
        !seen.insert(line).second)
      line.clear();
  }
  return result;
}

}  // namespace

std::string format_settings(const Settings& settings) {
  const Camera& c = settings.camera;
  const Distortion& d = c.distortion;
  return fmt::format(
             "camera:\n  width_px: {}\n  height_px: {}\n  fx_px: {}\n  fy_px: {}\n  cx_px: {}\n"
             "  cy_px: {}\n  distortion: {{k1: {}, k2: {}, p1: {}, p2: {}, k3: {}}}\n"
             "  rate_hz: {}\n  baseline_m: {}\n  disparity_sigma_px: {}\n"
             "images:\n  depth_per_meter: {}\n  exchange_red_blue: {}\n",
             c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px, d.k1, d.k2, d.p1, d.p2,
             d.k3, c.rate_hz, c.baseline_m, c.disparity_sigma_px, settings.depth_per_meter,
             settings.exchange_red_blue) +
         format_slam_config(settings.slam);
}

std::string format_slam_config(const SlamConfig& config, bool notes) {
  SettingsWriter writer(notes);
  for_each_setting(config, writer);
  return writer.text();
}

SlamConfig read_slam_config(YamlReader& yaml, SlamConfig config) {
  if (const auto base = yaml.find("base"))
    config.relocalize.acceptance = one_of(*base, setting_words(Acceptance{}));
  SettingsReader reader(yaml);
  for_each_setting(config, reader);
  reader.finish();
  return config;
}

Settings parse_settings(std::string text, const std::string& name, const SlamConfig& base) {
  // OpenCV's dialect starts with "%YAML:1.0", which is not valid YAML; its line is kept, so that
  // line numbers stay correct. ORB-SLAM2's TUM1.yaml has "key:value" without the blank, TUM3.yaml a
  // key twice.
  if (text.starts_with("%YAML:")) {
    text[0] = '#';
    text = without_dialect(text);
  }
  YamlReader yaml = YamlReader::parse(text, name);
  bool orb_slam = false, camera_info = false;
  for (const auto& [key, node] : YamlReader(yaml).entries()) {
    orb_slam = orb_slam || key.starts_with("Camera.");
    camera_info = camera_info || key == "camera_matrix";
  }
  Settings settings;
  settings.slam = base;
  if (camera_info) return read_camera_info(std::move(yaml), std::move(settings));
  return orb_slam ? read_orb_slam(std::move(yaml), std::move(settings))
                  : read_own(std::move(yaml), std::move(settings));
}

Settings load_settings(const std::filesystem::path& file, const SlamConfig& base) {
  return parse_settings(read_text(file), file.string(), base);
}

}  // namespace mh
