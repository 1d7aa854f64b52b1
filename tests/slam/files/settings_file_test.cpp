// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <regex>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/config/by_name.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

constexpr const char* kSettingsCamera =
    "camera: {width_px: 320, height_px: 240, fx_px: 288, fy_px: 289, cx_px: 159.5, cy_px: 119.5,\n"
    "         baseline_m: 0.06, distortion: {k1: 0.1, p2: -0.02}}\n";

SlamConfig unusual() {
  SlamConfig c;
  c.features.count = 777;
  c.features.scale = 1.0 + 1.0 / 3.0;
  c.semantics.overlap = Overlap::kWords;
  c.semantics.void_is_a_label = true;
  c.relocalize.ransac.confidence = 0.123456789012345;
  c.loop.enabled = false;
  c.loop.same_drift_rad = 1e-3;
  c.track.near_angle_rad = 0.7;
  c.track.sure_position_m = 0.03;
  c.track.sure_angle_rad = 0.02;
  return c;
}

std::string complaint(const std::string& text) {
  try {
    parse_settings(text, "s.yaml");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Settings, WhatIsWrittenReadsBackBitForBit) {
  for (const bool notes : {false, true}) {
    const std::string text = format_slam_config(unusual(), notes);
    const SlamConfig read = parse_settings(kSettingsCamera + text, "s.yaml").slam;
    EXPECT_EQ(format_slam_config(read), format_slam_config(unusual()));
    EXPECT_EQ(read.relocalize.ransac.confidence, unusual().relocalize.ransac.confidence);
    EXPECT_EQ(read.features.scale, unusual().features.scale);
  }
  EXPECT_NE(format_slam_config(unusual()), format_slam_config({}));
}

TEST(Settings, TheBaseStandsForItsAcceptance) {
  EXPECT_EQ(parse_settings("{}", "s.yaml").slam.relocalize.acceptance, Acceptance::kOurs);
  EXPECT_EQ(parse_settings("base: orb_slam2\n", "s.yaml").slam.relocalize.acceptance,
            Acceptance::kOrbSlam2);
  EXPECT_EQ(parse_settings("base: orb_slam2\nrelocalize: {acceptance: ours}\n", "s.yaml")
                .slam.relocalize.acceptance,
            Acceptance::kOurs)
      << "what is said in full counts";
  const std::string said = complaint("base: orbslam\n");
  EXPECT_NE(said.find("s.yaml:1"), std::string::npos) << said;
  EXPECT_NE(said.find("orb_slam2"), std::string::npos) << said;
}

TEST(Settings, TellsTheCameraAndLeavesTheRestAsItIs) {
  const Settings s = parse_settings(std::string(kSettingsCamera) +
                                        "images: {depth_per_meter: 1000, exchange_red_blue: "
                                        "true}\nsemantics: {gamma: 2.5}\n",
                                    "s.yaml");
  EXPECT_EQ(s.camera.width_px, 320);
  EXPECT_EQ(s.camera.fy_px, 289);
  EXPECT_EQ(s.camera.baseline_m, 0.06);
  EXPECT_EQ(s.camera.distortion, (Distortion{.k1 = 0.1, .p2 = -0.02}));
  EXPECT_EQ(s.depth_per_meter, 1000);
  EXPECT_TRUE(s.exchange_red_blue);
  SlamConfig expected;
  expected.semantics.gamma = 2.5;
  EXPECT_EQ(format_slam_config(s.slam), format_slam_config(expected));
}

TEST(Settings, ASigmaOfDisparityIsGivenOrLearned) {
  const auto camera = [](const std::string& line) {
    return parse_settings(
               "camera:\n  fx_px: 290\n  fy_px: 289\n  cx_px: 320\n  cy_px: 240\n" + line, "s.yaml")
        .camera;
  };
  EXPECT_FALSE(camera("").disparity_sigma_is_given);
  EXPECT_EQ(camera("  disparity_sigma_px: learned\n"), camera(""));
  const Camera given = camera("  disparity_sigma_px: 0.1\n");
  EXPECT_TRUE(given.disparity_sigma_is_given);
  EXPECT_EQ(given.disparity_sigma_px, 0.1);
  for (const Camera& c : {given, camera("")}) {
    Settings written;
    written.camera = c;
    EXPECT_EQ(parse_settings(format_settings(written), "written.yaml").camera, c);
  }
}

TEST(Settings, AWholeFileReadsBackBitForBit) {
  Settings s = parse_settings(kSettingsCamera + format_slam_config(unusual()), "s.yaml");
  s.depth_per_meter = 1000.0 / 3.0;
  s.exchange_red_blue = true;
  const Settings read = parse_settings(format_settings(s), "written.yaml");
  EXPECT_EQ(read.camera, s.camera);
  EXPECT_EQ(read.depth_per_meter, s.depth_per_meter);
  EXPECT_EQ(format_settings(read), format_settings(s));
  EXPECT_TRUE(read.has_camera);
  EXPECT_FALSE(parse_settings("track: {min_inliers: 30}", "s.yaml").has_camera);
}

TEST(Settings, NamesFileLinePlaceAndValue) {
  EXPECT_EQ(complaint(std::string(kSettingsCamera) + "track:\n  min_inliers: 3\n"),
            "s.yaml:4: track.min_inliers: 3 is outside [4, 1000000]");
  EXPECT_NE(complaint(std::string(kSettingsCamera) + "track:\n  min_inlier: 30\n")
                .find("s.yaml:4: unknown"),
            std::string::npos);
  EXPECT_NE(complaint(std::string(kSettingsCamera) + "tracks: {}\n").find("unknown key 'tracks'"),
            std::string::npos);
  EXPECT_NE(complaint(std::string(kSettingsCamera) + "semantics: {alpha: 1}").find("[0, 1)"),
            std::string::npos);
  EXPECT_NE(complaint(std::string(kSettingsCamera) + "semantics: {overlap: all}")
                .find("'all' is not one"),
            std::string::npos);
  EXPECT_NE(complaint("camera: {fx_px: 500}").find("'fy_px' is missing"), std::string::npos);
  EXPECT_NE(complaint("").find("the file is empty"), std::string::npos);
  EXPECT_EQ(complaint("camera: {fx_px: 500, fy_px: 500, cx_px: 700, cy_px: 200}"),
            "s.yaml:1: camera.cx_px: 700 is outside [0, 639]");
}

// The docs are the reference: each range that they print is accepted at both ends and refused
// beyond them.
TEST(Settings, EveryRangeOfTheDocsEndsWhereItSays) {
  std::istringstream docs(read_file(std::string(MH_SOURCE_DIR) + "/docs/reference/slam.md"));
  const std::regex section_line("## ([a-z]+)"),
      setting_line(
          "\\| `([a-z0-9_]+)` \\| ([0-9.e-]+) \\| \\[([0-9.e-]+), ([0-9.e-]+)([\\])])(, whole)? "
          "\\|.*");
  std::string section;
  int ranges = 0;
  std::smatch part;
  for (std::string line; std::getline(docs, line);) {
    if (std::regex_match(line, part, section_line)) section = part[1];
    if (!std::regex_match(line, part, setting_line)) continue;
    ++ranges;
    const std::string key = part[1];
    const double low = std::stod(part[3]), high = std::stod(part[4]);
    const bool open = part[5] == ")";
    const double present = setting_value(SlamConfig{}, section + "." + key);
    const bool whole = part[6].matched;
    EXPECT_EQ(whole,
              complaint(section + ": {" + key + ": 1.5}").find("integer") != std::string::npos)
        << line;
    EXPECT_TRUE(present >= low && present <= high) << line;
    const auto refused = [&](double value) {
      const std::string said = complaint(fmt::format("{}: {{{}: {}}}", section, key, value));
      return said.find(fmt::format("{}.{}: ", section, key)) != std::string::npos &&
             said.find(" is outside [") != std::string::npos;
    };
    EXPECT_FALSE(refused(low)) << line;
    EXPECT_EQ(refused(high), open) << line;
    EXPECT_TRUE(refused(whole ? low - 1 : std::nextafter(low, -HUGE_VAL))) << line;
    EXPECT_TRUE(refused(whole ? high + 1 : std::nextafter(high, HUGE_VAL))) << line;
    EXPECT_FALSE(refused(open ? std::nextafter(high, low) : high)) << line;
  }
  EXPECT_GT(ranges, 50) << "the docs' table is not found";
}

// As in the original's Examples/RGB-D folder, without its comments.
constexpr const char* kTum1 = R"(%YAML:1.0

Camera.fx: 517.306408
Camera.fy: 516.469215
Camera.cx: 318.643040
Camera.cy: 255.313989

Camera.k1: 0.262383
Camera.k2: -0.953104
Camera.p1: -0.005358
Camera.p2: 0.002628
Camera.k3: 1.163314

Camera.width: 640
Camera.height: 480
Camera.fps: 30.0
Camera.bf: 40.0
Camera.RGB: 1
ThDepth: 40.0
DepthMapFactor: 5000.0

ORBextractor.nFeatures: 1500
ORBextractor.scaleFactor: 1.3
ORBextractor.nLevels: 7
ORBextractor.iniThFAST: 21
ORBextractor.minThFAST: 8

Viewer.KeyFrameSize: 0.05
Viewer.PointSize:2
Viewer.ViewpointF: 500
Somebody.Else: 3
)";

TEST(Settings, TakesOrbSlamsFilesAsTheyAre) {
  const Settings s = parse_settings(kTum1, "TUM1.yaml");
  EXPECT_EQ(s.camera.fx_px, 517.306408);
  EXPECT_EQ(s.camera.distortion.k3, 1.163314);
  EXPECT_NEAR(s.camera.baseline_m, 40.0 / 517.306408, 1e-12);
  EXPECT_EQ(s.slam.features.count, 1500);
  EXPECT_EQ(s.slam.features.scale, 1.3);
  EXPECT_EQ(s.slam.features.levels, 7);
  EXPECT_EQ(s.slam.features.fast_threshold, 21);
  EXPECT_EQ(s.slam.features.fast_threshold_low, 8);
  EXPECT_NEAR(s.slam.keyframe.close_depth_m, 40 * 40.0 / 517.306408, 1e-12);
  EXPECT_EQ(s.depth_per_meter, 5000);
  EXPECT_TRUE(s.exchange_red_blue);
  ASSERT_EQ(s.notes.size(), 2U);
  EXPECT_EQ(s.notes[1], "TUM1.yaml: ignored: Somebody.Else");
}

// Settings that a file does not specify have the program's defaults.
TEST(Settings, OfAnOrbSlamFileWithoutARowThatRowIsTheDefault) {
  const Settings s =
      parse_settings("Camera.fx: 250\nCamera.fy: 251\nCamera.cx: 319\nCamera.cy: 239\n", "s.yaml");
  Camera camera;
  camera.fx_px = 250, camera.fy_px = 251, camera.cx_px = 319, camera.cy_px = 239;
  EXPECT_DOUBLE_EQ(s.camera.baseline_m, camera.baseline_m) << "in m, whatever the focal length";
  camera.baseline_m = s.camera.baseline_m;
  EXPECT_EQ(s.camera, camera);
  EXPECT_EQ(s.slam, SlamConfig{});
  EXPECT_EQ(s.depth_per_meter, Settings{}.depth_per_meter);
  EXPECT_FALSE(s.exchange_red_blue);
  EXPECT_TRUE(s.notes.empty());
}

TEST(Settings, OrbSlamsFilesAreCheckedToo) {
  std::string bad = kTum1;
  bad.replace(bad.find("517.306408"), 10, "-5");
  EXPECT_EQ(complaint(bad), "s.yaml:3: Camera.fx: -5 is outside [1, 1000000]");
  EXPECT_NE(complaint("Camera.fx: 500\n").find("'Camera.fy' is missing"), std::string::npos);
  for (const auto& [key, slip] : {std::pair("Camera.k1", "Camera.K1"),
                                  {"ORBextractor.nLevels", "ORBextractor.nLevel"},
                                  {"DepthMapFactor", "DepthMapFactr"},
                                  {"Camera.fps", "camera.fps"}}) {
    bad = kTum1;
    bad.replace(bad.find(key), std::string(key).size(), slip);
    EXPECT_NE(complaint(bad).find(std::string(slip) + ": is not a key of ORB-SLAM2's settings"),
              std::string::npos)
        << complaint(bad);
  }
  EXPECT_NE(complaint(std::string(kTum1) + "Camera.type: \"KannalaBrandt8\"\n")
                .find("'KannalaBrandt8' is neither PinHole nor Rectified"),
            std::string::npos);
  EXPECT_EQ(parse_settings(std::string(kTum1) + "Camera.type: \"PinHole\"\n", "s.yaml").camera,
            parse_settings(kTum1, "s.yaml").camera);
  // A key of ORB-SLAM3 before 1.0, as in its RealSense_D435i.yaml.
  EXPECT_EQ(parse_settings(std::string(kTum1) + "InsertKFsWhenLost: 0\n", "s.yaml").camera,
            parse_settings(kTum1, "s.yaml").camera);

  // Other files of the original have a key that occurs twice with the same value, and a matrix
  // without spaces.
  EXPECT_EQ(parse_settings(std::string(kTum1) + "Camera.width: 640\nCamera.bFishEye: 0\n" +
                               "LEFT.D: !!opencv-matrix\n   rows: 1\n   cols: 2\n   dt: d\n" +
                               "   data:[-0.28, 0.07]\n",
                           "s.yaml")
                .camera,
            parse_settings(kTum1, "s.yaml").camera);
  EXPECT_NE(complaint(std::string(kTum1) + "Camera.width: 320\n").find("appears twice"),
            std::string::npos);
  bad = kTum1;
  bad.replace(bad.find("Camera.fps: 30.0"), 16, "Camera.fps: 0");
  bad.replace(bad.find("DepthMapFactor: 5000.0"), 22, "DepthMapFactor: 0");
  EXPECT_EQ(parse_settings(bad, "s.yaml").camera.rate_hz, 30);
  EXPECT_EQ(parse_settings(bad, "s.yaml").depth_per_meter, 1);
}

constexpr const char* kTum1OfOrbSlam3 = R"(%YAML:1.0
File.version: "1.0"
Camera.type: "PinHole"
Camera1.fx: 517.306408
Camera1.fy: 516.469215
Camera1.cx: 318.643040
Camera1.cy: 255.313989
Camera1.k1: 0.262383
Camera1.k2: -0.953104
Camera1.p1: -0.005358
Camera1.p2: 0.002628
Camera1.k3: 1.163314
Camera.width: 640
Camera.height: 480
Camera.newWidth: 600
Camera.fps: 30
Camera.RGB: 0
Stereo.ThDepth: 40.0
Stereo.b: 0.07732
RGBD.DepthMapFactor: 1000.0
ORBextractor.nFeatures: 1500
System.SaveAtlasToFile: "atlas"
Viewer.PointSize: 2.0
)";

TEST(Settings, TakesOrbSlam3sFilesAsTheyAre) {
  const Settings s = parse_settings(kTum1OfOrbSlam3, "TUM1.yaml");
  EXPECT_EQ(s.camera.fx_px, 517.306408);
  EXPECT_EQ(s.camera.cy_px, 255.313989);
  EXPECT_EQ(s.camera.distortion, (Distortion{0.262383, -0.953104, -0.005358, 0.002628, 1.163314}));
  EXPECT_EQ(s.camera.baseline_m, 0.07732) << "in m, not times the focal length";
  EXPECT_NEAR(s.slam.keyframe.close_depth_m, 40 * 0.07732, 1e-12);
  EXPECT_EQ(s.depth_per_meter, 1000);
  EXPECT_TRUE(s.has_depth_per_meter);
  EXPECT_EQ(s.slam.features.count, 1500);
  ASSERT_EQ(s.notes.size(), 1U);
  EXPECT_EQ(s.notes[0], "TUM1.yaml: ignored: Camera.newWidth, System.SaveAtlasToFile");
}

TEST(Settings, OrbSlam3sFilesAreCheckedToo) {
  for (const auto& [key, slip] : {std::pair("Camera1.k1", "Camera1.K1"),
                                  {"Camera1.fx", "Camera.fx"},
                                  {"Stereo.b", "Stereo.bf"},
                                  {"RGBD.DepthMapFactor", "RGBD.DepthFactor"},
                                  {"Stereo.ThDepth", "ThDepth"}}) {
    std::string bad = kTum1OfOrbSlam3;
    bad.replace(bad.find(key), std::string(key).size(), slip);
    EXPECT_NE(complaint(bad).find(std::string(slip) + ": is not a key of ORB-SLAM3's settings"),
              std::string::npos)
        << complaint(bad);
  }
  std::string rectified = kTum1OfOrbSlam3;
  rectified.replace(rectified.find("PinHole"), 7, "Rectified");
  EXPECT_TRUE(parse_settings(rectified, "s.yaml").camera.distortion.none());
  rectified.replace(rectified.find("Rectified"), 9, "KannalaBrandt8");
  EXPECT_NE(complaint(rectified).find("'KannalaBrandt8' is neither"), std::string::npos);
}

TEST(Settings, OursMayStandBesideRosKeys) {
  const std::string ros =
      "image_width: 640\nimage_height: 480\ncamera_matrix:\n  data: [525, 0, 320, 0, 526, 240, 0, "
      "0, "
      "1]\ndistortion_model: rational_polynomial\ndistortion_coefficients:\n  data: [0.5, -0.1, "
      "0.001, 0.002, 0.03, 0.4, -0.05, 0.01]\n";
  const Settings s =
      parse_settings(ros + "images: {depth_per_meter: 4000}\nfeatures: {count: 500}\n", "s.yaml");
  EXPECT_EQ(s.camera.fy_px, 526);
  EXPECT_EQ(s.camera.distortion, (Distortion{0.5, -0.1, 0.001, 0.002, 0.03, 0.4, -0.05, 0.01}));
  EXPECT_EQ(s.depth_per_meter, 4000);
  EXPECT_EQ(s.slam.features.count, 500);
  EXPECT_FALSE(parse_settings(ros, "s.yaml").has_depth_per_meter);
  EXPECT_NE(complaint(ros + kSettingsCamera).find("keep only one"), std::string::npos);
  std::string bad = ros;
  bad.replace(bad.find("rational_polynomial"), 19, "plumb_bob");
  EXPECT_NE(complaint(bad).find("8 coefficients; plumb_bob has 5"), std::string::npos)
      << complaint(bad);
  bad = ros;
  bad.replace(bad.find(", 0.01]"), 7, "]");
  EXPECT_NE(complaint(bad).find("7 coefficients"), std::string::npos) << complaint(bad);
}

TEST(Settings, EightCoefficientsReadBackBitForBit) {
  Settings s;
  s.camera.distortion = {0.5, -0.1, 0.001, 0.002, 0.03, 0.4, -0.05, 1.0 / 3};
  const Settings read = parse_settings(format_settings(s), "s.yaml");
  EXPECT_EQ(read.camera, s.camera);
  s.camera.distortion = {.k1 = 0.1};
  EXPECT_EQ(format_settings(s).find("k4"), std::string::npos);
  const std::string folded = complaint(
      "camera: {fx_px: 525, fy_px: 525, cx_px: 319.5, cy_px: 239.5,\n  "
      "distortion: {k4: 40}}\n");
  EXPECT_NE(folded.find("k4 40, k5 0, k6 0: the distortion cannot be inverted"), std::string::npos)
      << folded;
}

TEST(Settings, RosCalibrationsAreReadStrictly) {
  const std::string good =
      "image_width: 640\nimage_height: 480\ncamera_name: kinect\ncamera_matrix:\n  rows: 3\n"
      "  cols: 3\n  data: [525, 0, 320, 0, 526, 240, 0, 0, 1]\ndistortion_model: plumb_bob\n"
      "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0, 0, 0, 0]\n";
  EXPECT_EQ(parse_settings(good, "s.yaml").camera.fy_px, 526);
  EXPECT_EQ(parse_settings(good, "s.yaml").camera.distortion.k1, 0.1);
  std::string bad = good;
  bad.replace(bad.find("coefficients"), 12, "coefficents");
  EXPECT_NE(complaint(bad).find("s.yaml:9: unknown key 'distortion_coefficents'"),
            std::string::npos);
  EXPECT_NE(complaint(good + "featurs: {count: 500}\n").find("unknown key 'featurs'"),
            std::string::npos);
  bad = good;
  bad.replace(bad.find("525, 0, 320"), 11, "525, 9, 320");
  EXPECT_NE(complaint(bad).find("s.yaml:7: camera_matrix.data: is not a matrix [fx, 0, cx"),
            std::string::npos)
      << complaint(bad);
}

// One camera in the formats of four programs.
TEST(Settings, CalibrationsOfOtherProgramsAreReadAsTheyAre) {
  const std::string opencv =
      "%YAML:1.0\n---\ncalibration_time: \"Tue 12 May 2020\"\nnr_of_frames: 20\nimage_width: "
      "752\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 458., 0., 367., 0., 457.,\n       248., 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n"
      "   data: [ -0.25, 0.07, 1e-3, 2e-3 ]\navg_reprojection_error: 0.19\n";
  const std::string driver =
      "image_width: 752\nimage_height: 480\ncamera_model: plumb_bob\ncamera_matrix: [458, 0, 367, "
      "0, "
      "457, 248, 0, 0, 1]\ndistortion_coefficients: [-0.25, 0.07, 1e-3, 2e-3]\n";
  const std::string message =
      "header:\n  seq: 131\n  frame_id: \"optical\"\nheight: 480\nwidth: 752\n"
      "distortion_model: \"plumb_bob\"\nD: [-0.25, 0.07, 1e-3, 2e-3, 0.0]\n"
      "K: [458, 0.0, 367, 0.0, 457, 248, 0.0, 0.0, 1.0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
      "binning_x: 0\nroi:\n  do_rectify: False\n---\n";
  std::string message2 = message;
  message2.replace(message2.find("D:"), 2, "d:");
  message2.replace(message2.find("K:"), 2, "k:");
  message2.replace(message2.find("R:"), 2, "r:");
  const std::string kalibr =
      "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [-0.25, 0.07, "
      "1e-3, "
      "2e-3]\n  distortion_model: radtan\n  intrinsics: [458, 457, 367, 248]\n"
      "  resolution: [752, 480]\n  rostopic: /cam0/image_raw\ncam1:\n  camera_model: pinhole\n";
  Camera expected;
  expected.width_px = 752;
  expected.fx_px = 458, expected.fy_px = 457, expected.cx_px = 367, expected.cy_px = 248;
  expected.distortion = {.k1 = -0.25, .k2 = 0.07, .p1 = 1e-3, .p2 = 2e-3};
  for (const std::string& text : {opencv, driver, message, message2, kalibr}) {
    const Settings s = parse_settings(text, "s.yaml");
    EXPECT_EQ(s.camera, expected) << text;
    EXPECT_TRUE(s.has_camera);
  }
  std::string bad = kalibr;
  bad.replace(bad.find("radtan"), 6, "equidistant");
  EXPECT_EQ(complaint(bad), "s.yaml:5: cam0.distortion_model: 'equidistant' is not radtan");
  bad = message;
  bad.replace(bad.find("binning_x: 0"), 12, "binning_x: 2");
  EXPECT_EQ(complaint(bad), "s.yaml:10: binning_x: 2 is outside [0, 1]");
  bad = message;
  bad.replace(bad.find("D:"), 2, "Dist:");
  EXPECT_NE(complaint(bad).find("s.yaml:7: unknown key 'Dist'"), std::string::npos)
      << complaint(bad);
}

TEST(Settings, ADistortionThatCannotBeUndoneIsRefused) {
  const auto with = [](const char* distortion) {
    return std::string("camera: {fx_px: 525, fy_px: 525, cx_px: 319.5, cy_px: 239.5,\n  ") +
           "distortion: " + distortion + "}\n";
  };
  // So strong that the corners have no ray: the image ends at 0.703 times the focal length.
  EXPECT_EQ(complaint(with("{k1: -0.3}")),
            "s.yaml:2: camera.distortion: k1 -0.3, k2 0, p1 0, p2 0, k3 0: the distortion cannot "
            "be inverted at pixel (0, 0)");
  EXPECT_NE(complaint(with("{k1: 1e6}")).find("cannot be inverted"), std::string::npos);
  EXPECT_EQ(parse_settings(with("{k1: -0.2, p1: 0.01}"), "s.yaml").camera.distortion.k1, -0.2);
  std::string bad = kTum1;
  bad.replace(bad.find("-0.953104"), 9, "-9.53104");
  EXPECT_NE(complaint(bad).find("s.yaml:8: Camera.k1: k1 0.262383, k2 -9.53104"), std::string::npos)
      << complaint(bad);
  EXPECT_NE(complaint("image_width: 640\nimage_height: 480\ncamera_matrix:\n  data: [525, 0, 320, "
                      "0, 525, 240, 0, 0, 1]\ndistortion_coefficients:\n  data: [5]\n")
                .find("s.yaml:6: distortion_coefficients.data: k1 5"),
            std::string::npos);
}

}  // namespace
}  // namespace mh
