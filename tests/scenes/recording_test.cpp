// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/recording.hpp"

#include <set>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "scenes/image_file.hpp"
#include "scenes/scannet/frame_folder.hpp"
#include "scenes/scannet/label_images.hpp"
#include "scenes/scannet/sens.hpp"
#include "slam/io/files.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

RecordingInfo info() {
  return {.sensor = "StructureSensor",
          .color = {16, 8, 20, 21, 7.5, 3.5, SE3(Eigen::Matrix3d::Identity(), {0.01, 0, 0})},
          .depth = {8, 6, 10, 10.5, 3.5, 2.5, {}},
          .depth_per_meter = 1000};
}

/// A smooth frame, so that JPEG changes little; the second of three frames has no pose.
RecordedMoment moment(std::size_t index) {
  RecordedMoment m{.stamp_ns = static_cast<Stamp>(1000 * (33'333 * index + 7)),
                   .color = Grid2d<Rgb8>(16, 8),
                   .depth = Grid2d<std::uint16_t>(8, 6),
                   .world_from_device = std::nullopt};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      const auto level = static_cast<std::uint8_t>(100 + 4 * x + 3 * y);
      m.color(x, y) = {level, level, static_cast<std::uint8_t>(level + 10 * index)};
    }
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) m.depth(x, y) = static_cast<std::uint16_t>(1000 * x + y + index);
  if (index != 1)
    m.world_from_device = SE3(so3_exp({0.1, 0.2 * static_cast<double>(index), 0.3}), {1, 2, 3.5});
  return m;
}

void expect_recorded(const Recording& recording, bool stamps) {
  EXPECT_EQ(recording.info().color.width_px, 16);
  EXPECT_EQ(recording.info().depth.height_px, 6);
  EXPECT_NEAR(recording.info().depth.fy_px, 10.5, 1e-6);
  EXPECT_NEAR(recording.info().color.device_from_camera.translation().x(), 0.01, 1e-8);
  EXPECT_EQ(recording.info().depth_per_meter, 1000);
  ASSERT_EQ(recording.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const RecordedMoment expected = moment(i), read = recording.frame(i);
    EXPECT_EQ(read.depth, expected.depth);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x)  // a smooth ramp survives JPEG to within a few levels
        EXPECT_NEAR(read.color(x, y).g, expected.color(x, y).g, 6);
    const Stamp at_thirty_hertz = static_cast<Stamp>(i) * 1'000'000'000 / 30;
    EXPECT_EQ(recording.stamp_ns(i), stamps ? expected.stamp_ns : at_thirty_hertz);
    EXPECT_EQ(recording.number(i), i);
    ASSERT_EQ(recording.world_from_device(i).has_value(), i != 1);
    if (i == 1) continue;
    const SE3 moved = recording.world_from_device(i)->inverse() * *expected.world_from_device;
    EXPECT_LT(moved.log().norm(), 1e-6);  // stored as floats
  }
}

class SensFile : public TemporaryFolder {
 protected:
  /// The bytes of a complete file; the constants below are the offsets of its fields.
  std::string bytes() const {
    save_sens(folder_ / "a.sens", info(), 3, moment);
    return read_file(folder_ / "a.sens");
  }
  static constexpr std::size_t kName = 4 + 8, kMatrices = kName + 15, kKinds = kMatrices + 4 * 64,
                               kSizes = kKinds + 8, kCount = kSizes + 16 + 4, kFrame = kCount + 8,
                               kStamps = kFrame + 64, kDepthSize = kStamps + 24;
  template <class T>
  static std::string with(std::string bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
  }
  /// The error of opening the file and reading all of its frames.
  static std::string error(const std::string& bytes) {
    return error_of([&] {
      const auto recording = open_sens(hold(bytes), "a.sens");
      for (std::size_t i = 0; i < recording->size(); ++i) recording->frame(i);
    });
  }
};

TEST_F(SensFile, ReadsBackWhatItWrote) {
  save_sens(folder_ / "a.sens", info(), 3, moment);
  const auto recording = open_recording(folder_ / "a.sens");
  expect_recorded(*recording, true);
  EXPECT_EQ(recording->info().sensor, "StructureSensor");
  expect_recorded(*open_recording(folder_), true);  // the only .sens file in its folder
  save_sens(folder_ / "b.sens", info(), 1, moment);
  EXPECT_TRUE(names(error_of([&] { open_recording(folder_); }), {"2 .sens files"}));
}

TEST_F(SensFile, CutAnywhereTheFramesBeforeAreUsedAndTheLostOnesCount) {
  const std::string whole = bytes();
  EXPECT_EQ(error(whole), "");
  const std::size_t frames_end =
      whole.size() - 8;  // inertial measurements follow; they are not read
  std::set<std::size_t> used;
  for (std::size_t size = 0; size < frames_end; size += 13) {
    std::vector<std::string> notes;
    const std::string refused = error_of([&] {
      const auto recording = open_sens(hold(whole.substr(0, size)), "a.sens");
      notes = recording->notes();
      EXPECT_EQ(recording->size(), 3U);
      std::size_t whole_frames = 0;
      while (whole_frames < 3 && error_of([&] { recording->frame(whole_frames); }).empty())
        ++whole_frames;
      used.insert(whole_frames);
      for (std::size_t i = whole_frames; i < 3; ++i) {
        const std::string number = fmt::format("frame {}", i);
        EXPECT_TRUE(
            names(error_of([&] { recording->frame(i); }), {"a.sens", number.c_str(), "truncated"}));
        EXPECT_FALSE(recording->world_from_device(i));
        EXPECT_GT(recording->stamp_ns(i), recording->stamp_ns(i - 1));
      }
    });
    EXPECT_TRUE(names(notes.empty() ? refused : notes.front(), {"a.sens", "truncated"})) << size;
  }
  EXPECT_EQ(used, (std::set<std::size_t>{1, 2})) << "without a whole frame it is refused";
}

TEST_F(SensFile, SaysWhichFieldIsWrong) {
  const std::string whole = bytes();
  EXPECT_TRUE(names(error(with(whole, 0, std::uint32_t{3})), {"version 3", "version 4"}));
  EXPECT_TRUE(names(error(with(whole, 4, std::uint64_t{1} << 60)), {"sensor's name"}));
  EXPECT_TRUE(names(error(with(whole, kKinds, std::int32_t{-1})), {"color compression -1"}));
  EXPECT_TRUE(names(error(with(whole, kKinds + 4, std::int32_t{2})), {"depth compression 2"}));
  EXPECT_TRUE(names(error(with(whole, kSizes, std::uint32_t{100000})), {"100000 x 8"}));
  EXPECT_TRUE(names(error(with(whole, kMatrices, 0.0F)), {"color camera", "fx 0"}));
  const auto more = open_sens(hold(with(whole, kCount, std::uint64_t{1} << 62)), "a.sens");
  EXPECT_EQ(more->size(), 3U);
  EXPECT_TRUE(names(more->notes().at(0), {"frame 3", "truncated", "3 of 4611686018427387904"}));
  EXPECT_TRUE(names(error(with(whole, kDepthSize, std::uint64_t{1} << 62)),
                    {"frame 0's depth image", "truncated"}));
}

TEST_F(SensFile, APoseThatIsNoneCostsItsFrameTheTruth) {
  const auto recording = open_sens(hold(with(bytes(), kFrame, 2.0F)), "a.sens");
  EXPECT_FALSE(recording->world_from_device(0).has_value());
  EXPECT_TRUE(recording->world_from_device(2).has_value());
  ASSERT_EQ(recording->notes().size(), 1U);
  EXPECT_TRUE(names(recording->notes()[0], {"frame 0", "not a rotation", "1 such frame"}));
}

TEST_F(SensFile, ImagesThatAreNotWhatTheHeaderSaysAreRefused) {
  const std::string whole = bytes();
  EXPECT_TRUE(names(error(with(whole, kSizes, std::uint32_t{18})),
                    {"frame 0", "16 x 8", "header says 18 x 8"}));
  EXPECT_TRUE(names(error(with(whole, kSizes + 8, std::uint32_t{9})), {"depth", "9 x 6"}));
  EXPECT_TRUE(names(error(with(whole, kSizes + 8, std::uint32_t{7})), {"depth", "7 x 6"}));
  // A header that declares half a gigabyte for each image is refused, as the file has too few
  // bytes.
  EXPECT_TRUE(names(
      error(with(with(whole, kSizes + 8, std::uint32_t{16384}), kSizes + 12, std::uint32_t{16384})),
      {"16384 x 16384", "too few bytes"}));
  std::string damaged = whole;
  const std::size_t jpeg = kDepthSize + 8;
  damaged[jpeg] = 'x';
  EXPECT_TRUE(names(error(damaged), {"frame 0", "neither JPEG nor PNG"}));
  std::uint64_t jpeg_size = 0;
  std::memcpy(&jpeg_size, whole.data() + kDepthSize - 8, sizeof jpeg_size);
  damaged = whole;
  damaged[jpeg + jpeg_size + 5] ^= 0x5a;
  EXPECT_TRUE(names(error(damaged), {"frame 0", "decompress"}));
}

TEST_F(SensFile, ACutColorImageIsAnErrorNotHalfAImage) {
  const std::string whole = bytes();
  const std::size_t jpeg = kDepthSize + 8;
  std::uint64_t size = 0;
  std::memcpy(&size, whole.data() + kDepthSize - 8, sizeof size);
  const std::size_t image = static_cast<std::size_t>(size);
  for (const std::size_t kept : {image - 1, image - 2, image - 20}) {
    std::string cut = with(whole, kDepthSize - 8, std::uint64_t{kept});
    cut.erase(jpeg + kept, image - kept);
    EXPECT_TRUE(names(error(cut), {"a.sens", "frame 0", "color image is truncated"})) << kept;
  }
  EXPECT_TRUE(names(error(with(whole, kCount, std::uint64_t{0})), {"a.sens", "no frame"}));
}

TEST(ImageFault, TellsWhatADecoderWouldHideOrPrint) {
  const std::string jpeg = encode_jpeg(moment(0).color, 90), png = encode_png(moment(0).depth);
  EXPECT_EQ(image_fault(jpeg), nullptr);
  EXPECT_EQ(image_fault(png), nullptr);
  EXPECT_EQ(image_fault(jpeg + "behind it"), nullptr);
  EXPECT_EQ(image_fault("P5 some other format"), nullptr);
  for (std::size_t size = 2; size < jpeg.size(); size += 3)
    EXPECT_STREQ(image_fault(jpeg.substr(0, size)), "is truncated") << size;
  for (std::size_t size = 8; size < png.size(); size += 3)
    EXPECT_STREQ(image_fault(png.substr(0, size)), "is truncated") << size;
  std::string damaged = png;
  damaged[50] ^= 1;
  EXPECT_TRUE(names(image_fault(damaged), {"sum"}));
  EXPECT_FALSE(decode_gray16(damaged));
  // The end marker of a thumbnail inside the header does not end the image.
  const std::string thumbnail = std::string("\xff\xe1\0\6\xff\xd8\xff\xd9", 8);
  const std::string with_thumbnail = jpeg.substr(0, 2) + thumbnail + jpeg.substr(2);
  EXPECT_EQ(image_fault(with_thumbnail), nullptr);
  EXPECT_STREQ(image_fault(with_thumbnail.substr(0, jpeg.size() - 20)), "is truncated");
}

TEST_F(SensFile, AJpegThatClaimsAnotherSizeIsNotDecoded) {
  std::string jpeg = encode_jpeg(moment(0).color, 90);
  const std::size_t frame_header = jpeg.find("\xff\xc0");
  ASSERT_NE(frame_header, jpeg.npos);
  jpeg[frame_header + 5] = '\x7f';  // height: 32 thousand rows
  const auto size = declared_size(jpeg);
  ASSERT_TRUE(size);
  EXPECT_GT(size->height, 32000U);
  jpeg[frame_header + 7] = '\x7f';
  EXPECT_FALSE(decode_color(jpeg));  // 10^9 pixels
  EXPECT_FALSE(declared_size("GIF89a"));
  EXPECT_FALSE(declared_size("\xff\xd8\xff"));
}

TEST_F(SensFile, WithoutIncreasingStampsFramesCountAtThirtyHertz) {
  std::string same = bytes();
  const auto recording = open_sens(hold(with(same, kStamps, std::uint64_t{1} << 40)), "a.sens");
  EXPECT_EQ(recording->stamp_ns(0), 0);
  EXPECT_EQ(recording->stamp_ns(2), 66'666'666);
  ASSERT_EQ(recording->notes().size(), 1U);
  EXPECT_TRUE(names(recording->notes()[0], {"a.sens", "frame 1", "30 Hz"}));
}

TEST_F(SensFile, BytesBehindTheFramesThatAreNoMeasurementsAreNoted) {
  const std::string whole = bytes();
  const auto notes = [](const std::string& bytes) {
    return open_sens(hold(bytes), "a.sens")->notes();
  };
  EXPECT_TRUE(notes(whole).empty());
  EXPECT_TRUE(notes(whole.substr(0, whole.size() - 8)).empty());  // some writers stop here
  std::string measured = with(whole, whole.size() - 8, std::uint64_t{2});
  measured += std::string(2 * 128, 'm');
  EXPECT_TRUE(notes(measured).empty());
  for (const std::string& odd :
       {whole.substr(0, whole.size() - 1), whole + "more", measured.substr(0, measured.size() - 1),
        with(whole, kCount, std::uint64_t{2})}) {
    const auto found = notes(odd);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(names(found[0], {"a.sens", "bytes after frame"}));
  }
}

class Extracted : public TemporaryFolder {};

TEST_F(Extracted, ReadsBackWhatItWrote) {
  save_extracted(folder_, info(), 3, moment);
  for (const char* file : {"color/2.jpg", "depth/2.png", "pose/2.txt",
                           "intrinsic/intrinsic_depth.txt", "intrinsic/extrinsic_color.txt"})
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  expect_recorded(*open_recording(folder_), false);
}

TEST_F(Extracted, TakesPartOfTheFramesAndPaddedNames) {
  save_extracted(folder_, info(), 3, moment);
  fs::remove(folder_ / "depth/0.png");
  fs::rename(folder_ / "color/2.jpg", folder_ / "color/000002.jpg");
  fs::rename(folder_ / "pose/2.txt", folder_ / "pose/000002.txt");
  fs::remove(folder_ / "pose/1.txt");
  const auto recording = open_recording(folder_);
  ASSERT_EQ(recording->size(), 2U);
  EXPECT_EQ(recording->number(1), 2U);
  EXPECT_EQ(recording->stamp_ns(1), 66'666'666);
  EXPECT_FALSE(recording->world_from_device(0));
  EXPECT_TRUE(recording->world_from_device(1));
  ASSERT_EQ(recording->notes().size(), 2U);
  EXPECT_TRUE(names(recording->notes()[0], {"color: 1 of 3 images", "depth/", "first is 0"}));
  EXPECT_TRUE(names(recording->notes()[1], {"1 of 2 frames", "pose/"}));
}

TEST_F(Extracted, ALensWithoutAPlaceIsToldToBeTheDevices) {
  save_extracted(folder_, info(), 1, moment);
  fs::remove(folder_ / "intrinsic/extrinsic_color.txt");
  const auto recording = open_recording(folder_);
  ASSERT_EQ(recording->notes().size(), 1U);
  EXPECT_TRUE(names(recording->notes()[0], {"extrinsic_color.txt", "missing", "color camera"}));
  EXPECT_TRUE(recording->info().color.device_from_camera.translation().isZero());
}

TEST_F(Extracted, APoseThatIsNoneIsToldAndCostsItsFrameTheTruth) {
  save_extracted(folder_, info(), 3, moment);
  const auto note = [&](const char* pose) {
    write("pose/0.txt", pose);
    const auto recording = open_recording(folder_);
    EXPECT_EQ(recording->size(), 3U);
    EXPECT_FALSE(recording->world_from_device(0));
    return recording->notes().empty() ? "" : recording->notes()[0];
  };
  EXPECT_TRUE(names(note("1 0 0 0 0 1 0 0 0 0 1\n"), {"pose/0.txt", "11 numbers"}));
  EXPECT_TRUE(names(note("1 0 0 0 0 1 0 0 0 0 1 0 5 5 5 5\n"), {"pose/0.txt", "last row"}));
  EXPECT_TRUE(names(note("1 0 0 1e30 0 1 0 0 0 0 1 0 0 0 0 1\n"), {"pose/0.txt", "1e+30 m"}));
  EXPECT_TRUE(names(note("1 0 0 0 0 x"), {"pose/0.txt", "number 6", "'x'"}));
}

TEST_F(Extracted, ABadExtrinsicIsNamedAsTheFileThatItIs) {
  save_extracted(folder_, info(), 1, moment);
  for (const char* matrix :
       {"2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n", "-inf 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"}) {
    write("intrinsic/extrinsic_color.txt", matrix);
    EXPECT_TRUE(names(error_of([&] { open_recording(folder_); }), {"extrinsic_color.txt"}));
  }
}

TEST_F(Extracted, NamesTheFileThatIsWrong) {
  const auto error = [&] {
    return error_of([&] {
      const auto recording = open_recording(folder_);
      for (std::size_t i = 0; i < recording->size(); ++i) recording->frame(i);
    });
  };
  EXPECT_TRUE(names(error(), {"neither color/ nor a .sens file"}));
  save_extracted(folder_, info(), 3, moment);
  EXPECT_EQ(error(), "");
  const std::string lens = read_file(folder_ / "intrinsic/intrinsic_depth.txt");
  write("intrinsic/intrinsic_depth.txt", "10 1 3.5 0 0 10.5 2.5 0 0 0 1 0 0 0 0 1\n");
  EXPECT_TRUE(names(error(), {"intrinsic_depth.txt", "row 1, column 2", "is 1"}));
  write("intrinsic/intrinsic_depth.txt", "10 0 7.5 0 0 10.5 2.5 0 0 0 1 0 0 0 0 1\n");
  EXPECT_TRUE(names(error(), {"intrinsic_depth.txt", "cx 7.5", "8 x 6"}));
  write("intrinsic/intrinsic_depth.txt", lens);
  write("pose/0.txt", "-inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf 0 0 0 1\n");
  EXPECT_EQ(error(), "");
  for (const char* file : {"color/1.jpg", "depth/1.png"}) {
    const std::string whole = read_file(folder_ / file);
    write(file, whole.substr(0, whole.size() - 15));
    EXPECT_TRUE(names(error(), {file, "is truncated"}));
    write(file, whole);
  }
  const std::string depth = read_file(folder_ / "depth/1.png");
  write("depth/1.png", encode_png(Grid2d<std::uint8_t>(8, 6)));
  EXPECT_TRUE(names(error(), {"depth/1.png", "8 bits"}));
  write("depth/1.png", read_file(folder_ / "color/1.jpg"));
  EXPECT_TRUE(names(error(), {"depth/1.png", "8 bits"}));
  write("depth/1.png", depth);
  write("color/1.jpg", "no image");
  EXPECT_TRUE(names(error(), {"color/1.jpg"}));
  fs::remove(folder_ / "intrinsic/intrinsic_depth.txt");
  EXPECT_TRUE(names(error(), {"intrinsic_depth.txt"}));
}

class LabelImagesOf : public TemporaryFolder {
 protected:
  static Grid2d<std::uint16_t> ids(std::uint16_t first) {
    Grid2d<std::uint16_t> image(5, 4, first);
    image(2, 1) = 3;
    return image;
  }
};

TEST_F(LabelImagesOf, FoldersAndZipsReadBackTheSame) {
  for (const bool zipped : {false, true}) {
    const fs::path place = folder_ / (zipped ? "zip" : "folder");
    fs::create_directories(place);
    const auto writer = zipped ? write_label_zip(place / "s_2d-label-filt.zip", "label-filt")
                               : write_label_folder(place, "label-filt");
    writer->add(0, ids(1163));
    writer->add(40, ids(2));
    writer->finish();
    const auto images = find_label_images(place, "label-filt");
    ASSERT_NE(images, nullptr);
    EXPECT_EQ(images->read(0), ids(1163));
    EXPECT_EQ(images->read(40), ids(2));
    EXPECT_FALSE(images->read(1));
    EXPECT_TRUE(images->contains(40));
    EXPECT_FALSE(images->contains(1));
    EXPECT_TRUE(names(images->place(), {zipped ? "s_2d-label-filt.zip" : "label-filt"}));
    EXPECT_EQ(find_label_images(place, "instance-filt"), nullptr);
  }
}

TEST_F(LabelImagesOf, InstancesHaveEightBitsWhereTheyFitAsInScannet) {
  const auto writer = write_label_folder(folder_, "instance-filt");
  writer->add(0, ids(255));
  writer->add(1, ids(256));
  const auto bits = [&](const char* file) { return read_file(folder_ / file)[24]; };
  EXPECT_EQ(bits("instance-filt/0.png"), 8);
  EXPECT_EQ(bits("instance-filt/1.png"), 16);
  const auto images = find_label_images(folder_, "instance-filt");
  EXPECT_EQ(images->read(0), ids(255));
  EXPECT_EQ(images->read(1), ids(256));
}

TEST_F(LabelImagesOf, ZipsThatPointOutsideAreDamagedOrClaimTooMuchAreRefused) {
  const fs::path file = folder_ / "s_2d-label-filt.zip";
  const auto writer = write_label_zip(file, "label-filt");
  writer->add(0, ids(7));
  writer->finish();
  const std::string whole = read_file(file);
  const auto error = [](const std::string& bytes) {
    return error_of([&] { open_label_zip(hold(bytes), "l.zip")->read(0); });
  };
  EXPECT_EQ(error(whole), "");
  std::string outside = whole;
  for (std::size_t at; (at = outside.find("label-filt/0.png")) != outside.npos;)
    outside.replace(at, 16, "../bel-filt/0.pn");
  EXPECT_TRUE(names(error(outside), {"l.zip", "../bel-filt/0.pn", "outside"}));
  for (std::size_t at; (at = outside.find("../bel-filt/0.pn")) != outside.npos;)
    outside.replace(at, 16, "/etc/passwd/0.pn");
  EXPECT_TRUE(names(error(outside), {"/etc/passwd", "outside"}));
  EXPECT_TRUE(names(error(whole.substr(0, whole.size() / 2)), {"l.zip", "not a zip"}));
  EXPECT_TRUE(names(error("no zip"), {"l.zip"}));
  EXPECT_TRUE(names(error(""), {"l.zip", "empty"}));
  std::string claims = whole;  // the size in the central directory, 24 bytes after its signature
  const std::size_t central = claims.find("PK\x01\x02");
  ASSERT_NE(central, claims.npos);
  claims.replace(central + 24, 4, "\xff\xff\xff\x7f");
  EXPECT_TRUE(names(error(claims), {"l.zip"}));
  std::string text = whole;
  text.replace(text.find("\x89PNG"), 4, "text");
  EXPECT_TRUE(names(error(text), {"l.zip"}));
}

}  // namespace
}  // namespace mh
