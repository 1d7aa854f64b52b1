// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/scannet_folder.hpp"

#include <gtest/gtest.h>

#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "scenes/scannet/frame_folder.hpp"
#include "scenes/scannet/label_images.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/files.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class ScannetFolder : public TemporaryFolder {
 protected:
  ScannetFolder() {
    camera_.width_px = 32;
    camera_.height_px = 24;
    camera_.fx_px = camera_.fy_px = 30;
    camera_.cx_px = 15.5;
    camera_.cy_px = 11.5;
  }

  /// Gray that gets brighter to the right; two classes, left and right; depth in whole millimeters.
  ExactFrame frame(std::size_t index) const {
    ExactFrame f;
    f.seen.stamp_ns = static_cast<Stamp>(index) * 40'000'000;
    f.seen.color = Grid2d<Rgb8>(32, 24);
    f.seen.depth_m = Grid2d<float>(32, 24, 1.5F);
    f.seen.depth_m(3, 3) = 0;
    f.seen.depth_m(4, 4) = 70.0F;  // too large for 16 bits of millimeters
    f.classes = Grid2d<ClassId>(32, 24, ClassId{5});
    f.instances = Grid2d<InstanceId>(32, 24, InstanceId{3});
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 32; ++x) {
        const auto gray = static_cast<std::uint8_t>(40 + 5 * x);
        f.seen.color(x, y) = {gray, gray, gray};
        if (x >= 16) f.classes(x, y) = 43;  // a potted plant, which NYU40 lacks
      }
    f.world_from_camera = SE3(so3_exp({0, 0.1 * static_cast<double>(index), 0}), {1, 2, 3});
    return f;
  }

  Camera camera_;
};

TEST_F(ScannetFolder, ARecordingReadBackIsWhatWasSeen) {
  write_scannet_recording(folder_ / "s", camera_, 3, [&](std::size_t i) { return frame(i); });
  std::vector<std::string> notes;
  const auto sequence = open_scannet(folder_ / "s", notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(sequence->camera().width_px, 32);
  EXPECT_NEAR(sequence->camera().cx_px, 15.5, 1e-6);
  ASSERT_EQ(sequence->size(), 3U);
  EXPECT_EQ(sequence->stamp_ns(2), 80'000'000);
  const RgbdFrame read = sequence->frame(1, RandomStream());
  const ExactFrame expected = frame(1);
  EXPECT_FLOAT_EQ(read.depth_m(10, 10), 1.5F);
  EXPECT_EQ(read.depth_m(3, 3), 0.0F);
  EXPECT_EQ(read.depth_m(4, 4), 0.0F);
  for (int x = 0; x < 32; ++x) {
    EXPECT_NEAR(read.color(x, 12).g, expected.seen.color(x, 12).g, 4) << x;
    EXPECT_EQ(read.semantics.at(x, 12).most_probable(), x < 16 ? 5 : 43);
  }
  const auto truth = sequence->truth();
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->size(), 3U);
  const SE3 moved = (*truth)[1].world_from_camera.inverse() * expected.world_from_camera;
  EXPECT_LT(moved.log().norm(), 1e-6);
  const auto instances = find_label_images(folder_ / "s", "instance-filt");
  ASSERT_NE(instances, nullptr);
  EXPECT_EQ((*instances->read(1))(20, 20), 3);
}

TEST_F(ScannetFolder, WithoutALabelTableLabelsAreLeftOutWithANote) {
  write_scannet_recording(folder_ / "s", camera_, 1, [&](std::size_t i) { return frame(i); });
  fs::remove(folder_ / "s" / "scannetv2-labels.combined.tsv");
  std::vector<std::string> notes;
  EXPECT_TRUE(open_scannet(folder_ / "s", notes)->frame(0, RandomStream()).semantics.index.empty());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(names(notes[0], {"labels are left out"}));
}

TEST_F(ScannetFolder, ATableThatKnowsNoneOfTheIdsIsTold) {
  write_scannet_recording(folder_ / "s", camera_, 1, [&](std::size_t i) { return frame(i); });
  write("other.yaml", "900: chair\n");
  const auto notes = [&](const RecordingConfig& config) {
    return kScannetReader.open(folder_ / "s", config).notes;
  };
  EXPECT_TRUE(notes({}).empty());
  const auto told = notes({.calibration = {}, .classes = folder_ / "other.yaml"});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(names(told[0], {"s_2d-label-filt.zip", "frame 0", "other.yaml"}));
  // A damaged label image costs only its frame, not the recording.
  write("d/a.sens", read_file(folder_ / "s" / "s.sens"));
  write("d/label-filt/0.png", "no image");
  EXPECT_TRUE(
      kScannetReader.open(folder_ / "d", {.calibration = {}, .classes = folder_ / "other.yaml"})
          .notes.empty());
}

TEST_F(ScannetFolder, SaysWhichFileIsWrongAndWhichLabelsAreMissing) {
  write_scannet_recording(folder_ / "s", camera_, 2, [&](std::size_t i) { return frame(i); });
  const fs::path table = folder_ / "s" / "scannetv2-labels.combined.tsv";
  // cx 15.5 is less than the width of 16 pixels, but half a pixel beyond the center of the last
  // one.
  std::string sens = read_file(folder_ / "s" / "s.sens");
  const std::uint32_t width = 16;
  const std::size_t depth_width = 4 + 8 + 10 + 4 * 64 + 8 + 8;  // after the name "Modelhouse"
  sens.replace(depth_width, 4, std::string(reinterpret_cast<const char*>(&width), 4));
  const auto file = write("b/narrow.sens", sens);
  std::vector<std::string> notes;
  EXPECT_TRUE(names(error_of([&] { open_scannet(file, notes); }), {"narrow.sens", "depth camera"}));

  const auto labeled = [&](const char* name, int label_width, std::uint32_t number) {
    write(std::string(name) + "/a.sens", read_file(folder_ / "s" / "s.sens"));
    write(std::string(name) + "/scannetv2-labels.combined.tsv", read_file(table));
    const auto writer = write_label_folder(folder_ / name, "label-filt");
    writer->add(number, Grid2d<std::uint16_t>(label_width, 24));
    return folder_ / name;
  };
  const auto wrong = open_scannet(labeled("c", 10, 0), notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(names(notes[0], {"c/label-filt", "1 of 2 frames", "frame 1"}));
  EXPECT_TRUE(names(error_of([&] { wrong->frame(0, RandomStream()); }),
                    {"c/label-filt", "0.png", "10 x 24"}));
  EXPECT_TRUE(wrong->frame(1, RandomStream()).semantics.index.empty());
  notes.clear();
  open_scannet(labeled("d", 32, 7), notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(names(notes[0], {"2 of 2 frames", "frame 0"}));
}

TEST_F(ScannetFolder, BothLayoutsHoldTheSameImages) {
  write_scannet_recording(folder_ / "s", camera_, 1, [&](std::size_t i) { return frame(i); });
  const ExactFrame f = frame(0);
  const auto writer = make_sequence_writer("scannet-frames", folder_ / "f", camera_);
  writer->add(0, f);
  writer->finish();
  const std::string sens = read_file(folder_ / "s" / "s.sens");
  const std::string jpeg = read_file(folder_ / "f" / "color" / "0.jpg");
  EXPECT_NE(sens.find(jpeg), sens.npos);
  const auto packed = open_recording(folder_ / "s"), loose = open_recording(folder_ / "f");
  EXPECT_EQ(packed->frame(0).depth, loose->frame(0).depth);
  for (const char* kind : {"label-filt", "instance-filt"})
    EXPECT_EQ(find_label_images(folder_ / "s", kind)->read(0),
              find_label_images(folder_ / "f", kind)->read(0));
  std::vector<std::string> notes;
  EXPECT_EQ(open_scannet(folder_ / "f", notes)
                ->frame(0, RandomStream())
                .semantics.at(20, 12)
                .most_probable(),
            43);
}

TEST_F(ScannetFolder, APoseThatIsNoneIsCountedAndItsFrameOffered) {
  RecordingInfo info;
  info.depth = {16, 12, 20, 20, 7.5, 5.5, {}};
  info.color = info.depth;
  const RecordedMoment moment{.stamp_ns = 0,
                              .color = Grid2d<Rgb8>(16, 12),
                              .depth = Grid2d<std::uint16_t>(16, 12, std::uint16_t{2000}),
                              .world_from_device = SE3()};
  save_extracted(folder_, info, 3, [&](std::size_t) { return moment; });
  write("pose/0.txt", "");
  write("pose/1.txt", "0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n");
  std::vector<std::string> notes;
  const auto sequence = open_scannet(folder_, notes);
  EXPECT_EQ(sequence->size(), 3U);
  EXPECT_EQ(sequence->truth()->size(), 1U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("pose/0.txt: holds 0 numbers, 16 are needed; 2 such frames are without "
                          "truth"),
            std::string::npos)
      << notes[0];
}

/// The color camera has twice the resolution and a different center, and is 10 cm to the right: a
/// point at depth z appears fx * 0.1 / z farther to the left.
TEST_F(ScannetFolder, ColorAndLabelsAreTakenWhereTheColorCameraSawThePixel) {
  RecordingInfo info;
  info.depth = {16, 12, 20, 20, 7.5, 5.5, {}};
  info.color = {64, 48, 80, 80, 33.5, 23.5, SE3(Eigen::Matrix3d::Identity(), {0.1, 0, 0})};
  RecordedMoment moment{.stamp_ns = 0,
                        .color = Grid2d<Rgb8>(64, 48),
                        .depth = Grid2d<std::uint16_t>(16, 12, std::uint16_t{2000}),
                        .world_from_device = SE3()};
  Grid2d<std::uint16_t> labels(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      moment.color(x, y) = {static_cast<std::uint8_t>(3 * x), static_cast<std::uint8_t>(4 * y), 0};
      labels(x, y) = x < 32 ? 1 : 2;
    }
  moment.depth(8, 6) = 0;  // far away: no parallax
  save_extracted(folder_, info, 1, [&](std::size_t) { return moment; });
  write_label_folder(folder_, "label-filt")->add(0, labels);
  write("scannetv2-labels.combined.tsv", "id\traw_category\tnyu40id\n1\twall\t1\n2\tchair\t5\n");
  std::vector<std::string> notes;
  const RgbdFrame frame = open_scannet(folder_, notes)->frame(0, RandomStream());
  ASSERT_EQ(frame.color.width(), 16);
  const auto column_of = [&](int x, double depth_m) {
    return 80 * ((x - 7.5) / 20 - 0.1 / depth_m) + 33.5;
  };
  for (int x = 2; x < 14; ++x) {
    const double column = column_of(x, 2.0), row = 80 * ((5 - 5.5) / 20) + 23.5;
    // Averaging over 4 x 4 pixels, JPEG and remap's steps of 1/32 px cost a few gray levels.
    EXPECT_NEAR(frame.color(x, 5).r, 3 * column, 6) << x;
    EXPECT_NEAR(frame.color(x, 5).g, 4 * row, 8) << x;
    EXPECT_EQ(frame.semantics.at(x, 5).most_probable(), std::round(column) < 32 ? 1 : 5) << x;
  }
  EXPECT_NEAR(frame.color(8, 6).r, 3 * column_of(8, 1e9), 6);
}

TEST_F(ScannetFolder, ARosCalibrationReadsBackAndServesATumFolder) {
  camera_.distortion = {.k1 = 0.25, .k2 = -0.5, .p1 = 0.001, .p2 = -0.002, .k3 = 1.125};
  const Settings read = parse_settings(camera_info_text(camera_), "camera_info.yaml");
  EXPECT_TRUE(read.has_camera);
  EXPECT_EQ(read.camera, camera_);
  EXPECT_EQ(read.depth_per_meter, 5000);
  const auto error = [](const std::string& text) {
    return error_of([&] { parse_settings(text, "info.yaml"); });
  };
  std::string text = camera_info_text(camera_);
  EXPECT_TRUE(names(
      error(text.substr(0, text.find("distortion_model")) + "distortion_model: equidistant\n"),
      {"info.yaml", "equidistant"}));
  EXPECT_TRUE(names(error("camera_matrix: {data: [1, 2]}\nimage_width: 4\nimage_height: 3\n"),
                    {"info.yaml:1"}));
  TumWriter writer(folder_ / "t", camera_);
  const ExactFrame f = frame(0);
  writer.add(0, f);
  writer.finish();
  EXPECT_EQ(load_settings(folder_ / "t" / "camera_info.yaml").camera, camera_);
}

}  // namespace
}  // namespace mh
