// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/frame_files.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace mh {
namespace {

/// The header of a portable anymap.
struct PnmHead {
  const char* magic;  ///< P5 (gray) or P6 (color)
  int width, height, greatest;
};

std::string pnm(const PnmHead& head, const void* pixels, std::size_t bytes) {
  std::string file =
      fmt::format("{}\n{} {}\n{}\n", head.magic, head.width, head.height, head.greatest);
  return file.append(static_cast<const char*>(pixels), bytes);
}

}  // namespace

Grid2d<ClassId> class_image(const SemanticImage& semantics) {
  std::vector<ClassId> class_of;
  for (const ClassDistribution& distribution : semantics.palette)
    class_of.push_back(distribution.most_probable());
  Grid2d<ClassId> image(semantics.index.width(), semantics.index.height());
  std::transform(semantics.index.begin(), semantics.index.end(), image.begin(),
                 [&](std::uint8_t entry) { return class_of[entry]; });
  return image;
}

Grid2d<ClassId> classes_of(const RgbdFrame& frame) {
  if (frame.semantics.index.empty())
    return Grid2d<ClassId>(frame.color.width(), frame.color.height(), kVoid);
  return class_image(frame.semantics);
}

FrameFiles image_files(const RgbdFrame& frame) {
  static_assert(sizeof(Rgb8) == 3);
  const int width = frame.color.width(), height = frame.color.height();
  FrameFiles files;
  files.color = pnm({"P6", width, height, 255}, frame.color.data(), 3 * frame.color.size());
  std::vector<std::uint8_t> depth(2 * frame.depth_m.size());
  for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
    const std::uint16_t units = depth_units(frame.depth_m.data()[i]);
    depth[2 * i] = static_cast<std::uint8_t>(units >> 8);  // big-endian, as the format requires
    depth[2 * i + 1] = static_cast<std::uint8_t>(units & 0xff);
  }
  files.depth = pnm({"P5", width, height, 65535}, depth.data(), depth.size());
  if (frame.semantics.index.empty()) return files;
  const Grid2d<ClassId> labels = class_image(frame.semantics);
  files.labels = pnm({"P5", width, height, 255}, labels.data(), labels.size());
  return files;
}

std::string settings_text(const Camera& camera) {
  const Distortion& d = camera.distortion;
  const std::string rational =
      d.is_rational()
          ? fmt::format("Camera.k4: {:#}\nCamera.k5: {:#}\nCamera.k6: {:#}\n", d.k4, d.k5, d.k6)
          : "";
  const std::string sigma =
      camera.disparity_sigma_is_given
          ? fmt::format("Modelhouse.disparity_sigma_px: {:#}\n", camera.disparity_sigma_px)
          : "";
  return fmt::format(
      "%YAML:1.0\n"
      "# Written by Modelhouse. Pixel centers at integers; depth is metric and registered.\n"
      "Camera.type: \"PinHole\"\n"  // ORB-SLAM3 asks for it
      // '#' keeps a decimal point in whole numbers: some readers refuse an integer here.
      "Camera.fx: {:#}\nCamera.fy: {:#}\nCamera.cx: {:#}\nCamera.cy: {:#}\n"
      "Camera.k1: {:#}\nCamera.k2: {:#}\nCamera.p1: {:#}\nCamera.p2: {:#}\nCamera.k3: {:#}\n{}"
      "Camera.width: {}\nCamera.height: {}\nCamera.fps: {:#}\nCamera.bf: {:#}\n"
      "# Images are RGB; OpenCV's imread hands them over as BGR.\nCamera.RGB: 0\n"
      "DepthMapFactor: {:#}\nThDepth: 40.0\n"
      "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
      "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n"
      "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1\nViewer.GraphLineWidth: 0.9\n"
      "Viewer.PointSize: 2\nViewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3\n"
      "Viewer.ViewpointX: 0\nViewer.ViewpointY: -0.7\nViewer.ViewpointZ: -1.8\n"
      "Viewer.ViewpointF: 500\n{}",
      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, d.k1, d.k2, d.p1, d.p2, d.k3,
      rational, camera.width_px, camera.height_px, camera.rate_hz, camera.baseline_m * camera.fx_px,
      kDepthPerMeter, sigma);
}

const char* distortion_model(const Distortion& distortion) {
  return distortion.is_rational() ? "rational_polynomial" : "plumb_bob";
}

std::string camera_info_text(const Camera& camera) {
  const auto matrix = [](const char* name, int rows, const std::vector<double>& data) {
    return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", name, rows,
                       data.size() / static_cast<std::size_t>(rows), fmt::join(data, ", "));
  };
  const double fx = camera.fx_px, fy = camera.fy_px, cx = camera.cx_px, cy = camera.cy_px;
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: modelhouse\n",
                     camera.width_px, camera.height_px) +
         matrix("camera_matrix", 3, {fx, 0, cx, 0, fy, cy, 0, 0, 1}) +
         fmt::format("distortion_model: {}\n", distortion_model(camera.distortion)) +
         matrix("distortion_coefficients", 1, coefficients_of(camera.distortion)) +
         matrix("rectification_matrix", 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix("projection_matrix", 3, {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0});
}

}  // namespace mh
