// SPDX-License-Identifier: Apache-2.0
#include "slam/files/settings_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "slam/files/calibration_files.hpp"
#include "slam/io/error.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

constexpr double kMost = 1e6;

/// Reads the distortion, whatever names a dialect gives its coefficients.
void read_distortion(YamlReader& yaml, const std::string& prefix, Camera& camera) {
  camera.distortion = {.k1 = yaml.number_or(prefix + "k1", 0, -kMost, kMost),
                       .k2 = yaml.number_or(prefix + "k2", 0, -kMost, kMost),
                       .p1 = yaml.number_or(prefix + "p1", 0, -kMost, kMost),
                       .p2 = yaml.number_or(prefix + "p2", 0, -kMost, kMost),
                       .k3 = yaml.number_or(prefix + "k3", 0, -kMost, kMost),
                       .k4 = yaml.number_or(prefix + "k4", 0, -kMost, kMost),
                       .k5 = yaml.number_or(prefix + "k5", 0, -kMost, kMost),
                       .k6 = yaml.number_or(prefix + "k6", 0, -kMost, kMost)};
}

/// Reads a number, or "learned".
void read_disparity_sigma(YamlReader& section, const std::string& key, Camera& c) {
  const auto sigma = section.find(key);
  if (!sigma || sigma->as_string() == "learned") return;
  c.disparity_sigma_px = sigma->as_double(1e-6, kMost);
  c.disparity_sigma_is_given = true;
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
  read_disparity_sigma(camera, "disparity_sigma_px", c);
  auto distortion = camera.find("distortion");
  if (distortion) {
    read_distortion(*distortion, "", c);
    distortion->finish();
  }
  camera.finish();
  require_usable(c, distortion ? *distortion : camera);
}

Settings read_own(YamlReader yaml, Settings settings) {
  read_camera(yaml, settings);
  if (auto images = yaml.find("images")) {
    settings.has_depth_per_meter = images->find("depth_per_meter").has_value();
    settings.depth_per_meter =
        images->number_or("depth_per_meter", settings.depth_per_meter, 1e-3, 1e9);
    settings.exchange_red_blue = images->boolean("exchange_red_blue", false);
    images->finish();
  }
  settings.slam = read_slam_config(yaml, settings.slam);
  yaml.finish();
  return settings;
}

/// The keys of ORB-SLAM2's files, or of ORB-SLAM3's since its version 1.0, that are read; the rest
/// are for its viewer, or for other sensors.
struct OrbSlamKeys {
  const char* program;
  std::string lens;  ///< prefix of the names of focal lengths, center and distortion
  std::string baseline, close_depth, depth_scale;

  std::vector<std::string> all() const {
    std::vector<std::string> keys;
    for (const char* key : {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"})
      keys.push_back(lens + key);
    for (const std::string& key :
         {std::string("Camera.width"), std::string("Camera.height"), std::string("Camera.fps"),
          baseline, std::string("Camera.RGB"), close_depth, depth_scale})
      keys.push_back(key);
    for (const char* key : {"nFeatures", "scaleFactor", "nLevels", "iniThFAST", "minThFAST"})
      keys.push_back(std::string("ORBextractor.") + key);
    return keys;
  }
};
const OrbSlamKeys kOrbSlam2{"ORB-SLAM2", "Camera.", "Camera.bf", "ThDepth", "DepthMapFactor"};
const OrbSlamKeys kOrbSlam3{"ORB-SLAM3", "Camera1.", "Stereo.b", "Stereo.ThDepth",
                            "RGBD.DepthMapFactor"};

/// The key that we add to the ORB-SLAM files that we write.
constexpr const char* kOurSigma = "Modelhouse.disparity_sigma_px";

/// Other keys of such files: the camera type, sizes that its images are shrunk to (ours are not),
/// and keys for other sensors.
constexpr auto kOrbSlamOthers = std::to_array<std::string_view>(
    {"Camera.type", "Camera.bFishEye", "Camera.newWidth", "Camera.newHeight", "Camera.imageScale",
     "InsertKFsWhenLost", "Stereo.T_c1_c2", "Tbc", "Tlr", "loopClosing", "thFarPoints"});

bool is_one_of(const auto& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string section_of(const std::string& key) {
  return lower_case(key.substr(0, key.find('.')));
}

/// Unknown keys are errors, at the top level and in every section that is read: otherwise, a typo
/// could silently drop the camera's distortion. Other sections belong to other programs.
void refuse_unknown_keys(YamlReader& yaml, const OrbSlamKeys& keys) {
  const std::vector<std::string> known = keys.all();
  std::set<std::string> read_sections{"camera"};
  for (const std::string& key : known) read_sections.insert(section_of(key));
  for (const auto& [key, node] : yaml.entries()) {
    if (key == "Camera.type" && node.as_string() != "PinHole" && node.as_string() != "Rectified")
      node.fail(fmt::format("'{}' is neither PinHole nor Rectified", node.as_string()));
    if (key == "Camera.bFishEye" && node.as_string() != "0")
      node.fail("fisheye cameras are not supported");
    if (is_one_of(known, key) || is_one_of(kOrbSlamOthers, key)) continue;
    if (read_sections.contains(section_of(key)) || key.find('.') == std::string::npos)
      node.fail(fmt::format("is not a key of {}'s settings (known: {})", keys.program,
                            fmt::join(known, ", ")));
  }
}

/// A list such as "Other.Key, ...": keys that are not read, except those that do not matter here,
/// such as the position of a window (Viewer.*) or the version of the format (File.version).
std::string unread_keys(YamlReader& yaml, const OrbSlamKeys& keys) {
  const std::vector<std::string> known = keys.all();
  std::vector<std::string> unread;
  for (const auto& [key, node] : yaml.entries())
    if (!is_one_of(known, key) && key != "Camera.type" && key != "Camera.bFishEye" &&
        !key.starts_with("Viewer.") && !key.starts_with("File.") && key != kOurSigma)
      unread.push_back(key);
  return fmt::format("{}", fmt::join(unread, ", "));
}

/// The lens of an ORB-SLAM file; that of rectified images has no distortion.
void read_orb_slam_lens(YamlReader& yaml, const OrbSlamKeys& keys, Camera& c) {
  c.width_px = static_cast<int>(yaml.integer_or("Camera.width", c.width_px, 1, 100000));
  c.height_px = static_cast<int>(yaml.integer_or("Camera.height", c.height_px, 1, 100000));
  c.fx_px = yaml.number(keys.lens + "fx", 1, kMost);
  c.fy_px = yaml.number(keys.lens + "fy", 1, kMost);
  c.cx_px = yaml.number(keys.lens + "cx", 0, c.width_px - 1);
  c.cy_px = yaml.number(keys.lens + "cy", 0, c.height_px - 1);
  const auto type = yaml.find("Camera.type");
  if (!type || type->as_string() != "Rectified") read_distortion(yaml, keys.lens, c);
  const auto k1 = yaml.find(keys.lens + "k1");
  require_usable(c, k1 ? *k1 : yaml);
}

Settings read_orb_slam(YamlReader yaml, const OrbSlamKeys& keys, Settings settings) {
  settings.has_camera = true;
  refuse_unknown_keys(yaml, keys);
  Camera& c = settings.camera;
  read_orb_slam_lens(yaml, keys, c);
  // Zero means ORB-SLAM's own default.
  const double rate_hz = yaml.number_or("Camera.fps", 0, 0, kMost);
  if (rate_hz != 0) c.rate_hz = rate_hz;
  // ORB-SLAM2 gives the baseline in m, times fx.
  const double unit = &keys == &kOrbSlam2 ? c.fx_px : 1;
  c.baseline_m = yaml.number_or(keys.baseline, c.baseline_m * unit, 1e-6, kMost) / unit;
  read_disparity_sigma(yaml, kOurSigma, c);
  settings.has_depth_per_meter = yaml.find(keys.depth_scale).has_value();
  settings.depth_per_meter = yaml.number_or(keys.depth_scale, settings.depth_per_meter, 0, 1e9);
  if (settings.depth_per_meter == 0) settings.depth_per_meter = 1;
  settings.exchange_red_blue = yaml.integer_or("Camera.RGB", 0, 0, 1) == 1;
  if (settings.exchange_red_blue)
    settings.notes.push_back(
        fmt::format("{}: Camera.RGB: 1: OpenCV's first channel, blue, is taken as red, as {} does; "
                    "write 0 if colors matter and the files are ordinary ones",
                    yaml.file(), keys.program));

  FeatureConfig& f = settings.slam.features;
  f.count = static_cast<int>(yaml.integer_or("ORBextractor.nFeatures", f.count, 10, 20000));
  f.scale = yaml.number_or("ORBextractor.scaleFactor", f.scale, 1.01, 2);
  f.levels = static_cast<int>(yaml.integer_or("ORBextractor.nLevels", f.levels, 1, 16));
  f.fast_threshold =
      static_cast<int>(yaml.integer_or("ORBextractor.iniThFAST", f.fast_threshold, 1, 255));
  f.fast_threshold_low =
      static_cast<int>(yaml.integer_or("ORBextractor.minThFAST", f.fast_threshold_low, 1, 255));
  // Close points are those within this many baselines.
  if (const auto close = yaml.find(keys.close_depth))
    settings.slam.keyframe.close_depth_m =
        std::clamp(close->as_double(1e-3, kMost) * c.baseline_m, 0.1, 1000.0);

  const std::string passed_over = unread_keys(yaml, keys);
  if (!passed_over.empty())
    settings.notes.push_back(fmt::format("{}: ignored: {}", yaml.file(), passed_over));
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
  return fmt::format(
             "camera:\n  width_px: {}\n  height_px: {}\n  fx_px: {}\n  fy_px: {}\n  cx_px: {}\n"
             "  cy_px: {}\n  distortion: {{{}}}\n"
             "  rate_hz: {}\n  baseline_m: {}\n  disparity_sigma_px: {}\n"
             "images:\n  depth_per_meter: {}\n  exchange_red_blue: {}\n",
             c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px,
             text_of(c.distortion, ": "), c.rate_hz, c.baseline_m,
             c.disparity_sigma_is_given ? fmt::format("{}", c.disparity_sigma_px) : "learned",
             settings.depth_per_meter, settings.exchange_red_blue) +
         format_slam_config(settings.slam);
}

std::string format_slam_config(const SlamConfig& config, bool notes) {
  SettingsWriter writer(notes);
  for_each_setting(config, writer);
  return writer.text();
}

SlamConfig read_slam_config(YamlReader& yaml, SlamConfig config) {
  if (const auto base = yaml.find("base"))
    config.relocalize.acceptance = one_of(*base, words(Acceptance{}));
  SettingsReader reader(yaml);
  for_each_setting(config, reader);
  reader.finish();
  return config;
}

Settings parse_settings(std::string text, const std::string& name, const SlamConfig& base) {
  // OpenCV's dialect starts with "%YAML:1.0", which is not valid YAML. That line becomes a comment,
  // so that line numbers remain correct. ORB-SLAM2's TUM1.yaml has "key:value" without the space;
  // TUM3.yaml contains a key twice.
  if (text.starts_with("%YAML:")) {
    text[0] = '#';
    text = without_dialect(text);
  }
  YamlReader yaml = YamlReader::parse(text, name);
  bool orb_slam = false, orb_slam3 = false;
  for (const auto& [key, node] : YamlReader(yaml).entries()) {
    orb_slam = orb_slam || key.starts_with("Camera.");
    orb_slam3 = orb_slam3 || key.starts_with("Camera1.");
  }
  Settings settings;
  settings.slam = base;
  if (orb_slam || orb_slam3)
    return read_orb_slam(std::move(yaml), orb_slam3 ? kOrbSlam3 : kOrbSlam2, std::move(settings));
  settings.has_camera = read_calibration(yaml, settings.camera);
  if (settings.has_camera)
    if (const auto ours = yaml.find("camera"))
      ours->fail("describes a camera, but so does the calibration around it: keep only one");
  return read_own(std::move(yaml), std::move(settings));
}

Settings load_settings(const std::filesystem::path& file, const SlamConfig& base) {
  return parse_settings(read_text(file), file.string(), base);
}

}  // namespace mh
