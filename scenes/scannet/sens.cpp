// SPDX-License-Identifier: Apache-2.0
// The .sens format, version 4, as ScanNet's SensReader describes it: little-endian, no padding.
#include "scenes/scannet/sens.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little, "values are read as they lie");

constexpr std::uint32_t kVersion = 4;
constexpr std::uint64_t kLongestName = 4096;
constexpr std::uint32_t kLongestSide_px = 16384;
constexpr std::uint64_t kDeflateLimit = 1032;  // the maximum expansion of a deflate stream (zlib's
                                               // manual)
enum ColorKind : std::int32_t { kRawColor = 0, kPng = 1, kJpeg = 2 };
enum DepthKind : std::int32_t { kRawDepth = 0, kZlib = 1 };

/// The file ends too early.
struct Truncated : InputError {
  using InputError::InputError;
};

/// Takes values from the front of the bytes.
class Cursor {
 public:
  Cursor(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: byte {}: {}", name_, at_, what));
  }
  void need(std::uint64_t size, const std::string& what) const {
    if (size > bytes_.size() - at_)
      throw Truncated(
          fmt::format("{}: byte {}: is truncated: it ends within {}, which needs {} bytes ({} are "
                      "left)",
                      name_, at_, what, size, bytes_.size() - at_));
  }
  std::size_t left() const { return bytes_.size() - at_; }
  void end() { at_ = bytes_.size(); }
  template <class T>
  T take(const char* what) {
    need(sizeof(T), what);
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string_view take_bytes(std::uint64_t size, const std::string& what) {
    need(size, what);
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += static_cast<std::size_t>(size);
    return taken;
  }
  Eigen::Matrix4d take_matrix(const char* what) {
    Eigen::Matrix4d matrix;
    for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = take<float>(what);
    return matrix;
  }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

struct FrameRecord {
  Stamp stamp_ns = 0;
  std::optional<SE3> world_from_device;
  std::string_view color, depth;
};

class SensFile : public Recording {
 public:
  SensFile(HeldBytes bytes, const std::string& name) : held_(std::move(bytes)), name_(name) {
    Cursor cursor(held_.view, name_);
    const std::uint64_t frames = read_header(cursor);
    read_frames(cursor, frames);
    if (frames_.empty()) throw InputError(fmt::format("{}: holds no frame", name_));
    repair_stamps();
    note_faulty_poses();
    note_bytes_left(cursor);
    add_lost(frames);
  }

  const RecordingInfo& info() const override { return info_; }
  std::size_t size() const override { return frames_.size(); }
  std::vector<fs::path> images() const override { return {name_}; }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  std::uint32_t number(std::size_t index) const override {
    return static_cast<std::uint32_t>(index);
  }
  std::optional<SE3> world_from_device(std::size_t index) const override {
    return frames_[index].world_from_device;
  }
  RecordedMoment frame(std::size_t index) const override {
    const FrameRecord& record = frames_[index];
    if (index >= whole_) fail(index, "is missing: the file is truncated");
    return {record.stamp_ns, color_of(record, index), depth_of(record, index),
            record.world_from_device};
  }

 private:
  std::uint64_t read_header(Cursor& cursor) {
    const auto version = cursor.take<std::uint32_t>("the version");
    if (version != kVersion)
      throw InputError(fmt::format("{}: has version {}, but only version {} is supported", name_,
                                   version, kVersion));
    const auto length = cursor.take<std::uint64_t>("the length of the sensor's name");
    if (length > kLongestName) cursor.fail(fmt::format("a sensor's name of {} bytes", length));
    info_.sensor = cursor.take_bytes(length, "the sensor's name");
    const Eigen::Matrix4d color_intrinsics = cursor.take_matrix("the color intrinsics");
    const Eigen::Matrix4d color_extrinsics = cursor.take_matrix("the color extrinsics");
    const Eigen::Matrix4d depth_intrinsics = cursor.take_matrix("the depth intrinsics");
    const Eigen::Matrix4d depth_extrinsics = cursor.take_matrix("the depth extrinsics");
    color_kind_ = cursor.take<std::int32_t>("the color compression");
    if (color_kind_ != kRawColor && color_kind_ != kPng && color_kind_ != kJpeg)
      cursor.fail(
          fmt::format("color compression {} is not one of 0 raw, 1 png, 2 jpeg", color_kind_));
    depth_kind_ = cursor.take<std::int32_t>("the depth compression");
    if (depth_kind_ != kRawDepth && depth_kind_ != kZlib)
      cursor.fail(fmt::format("depth compression {} is not one of 0 raw, 1 zlib", depth_kind_));
    const ImageSize color = take_size(cursor, "color"), depth = take_size(cursor, "depth");
    info_.depth_per_meter = cursor.take<float>("the depth shift");
    if (!(info_.depth_per_meter >= 1e-3) || info_.depth_per_meter > 1e6)
      cursor.fail(fmt::format("a depth shift of {}", info_.depth_per_meter));
    info_.color = lens_of(color_intrinsics, color_extrinsics, static_cast<int>(color.width),
                          static_cast<int>(color.height), name_ + ": color camera");
    info_.depth = lens_of(depth_intrinsics, depth_extrinsics, static_cast<int>(depth.width),
                          static_cast<int>(depth.height), name_ + ": depth camera");
    return cursor.take<std::uint64_t>("the number of frames");
  }

  static ImageSize take_size(Cursor& cursor, const char* which) {
    ImageSize size;
    size.width = cursor.take<std::uint32_t>("the width");
    size.height = cursor.take<std::uint32_t>("the height");
    if (size.width == 0 || size.height == 0 || size.width > kLongestSide_px ||
        size.height > kLongestSide_px)
      cursor.fail(fmt::format("{} images of {} x {}: sides must be 1 to {} pixels", which,
                              size.width, size.height, kLongestSide_px));
    return size;
  }

  /// Reads the frames of a recording; if it was cut short, its complete frames are used (see
  /// add_lost()).
  void read_frames(Cursor& cursor, std::uint64_t frames) {
    for (std::uint64_t i = 0; i < frames; ++i) try {
        frames_.push_back(read_record(cursor, i));
      } catch (const Truncated& error) {
        if (frames_.empty()) throw;
        notes_.push_back(fmt::format("{}; {} of {} frames are complete", error.what(), i, frames));
        cursor.end();
        return;
      }
  }

  /// Adds the frames that a truncated file has lost as unreadable frames, so that they are counted.
  /// Their stamps continue at the mean interval of the others.
  void add_lost(std::uint64_t frames) {
    constexpr std::uint64_t kCredible = 1'000'000;  // 9 h; a damaged header may state any number
    whole_ = frames_.size();
    if (frames > kCredible) return;
    const Stamp first_ns = frames_.front().stamp_ns, last_ns = frames_.back().stamp_ns;
    const Stamp interval_ns =
        whole_ > 1 ? (last_ns - first_ns) / static_cast<Stamp>(whole_ - 1) : 1'000'000'000 / 30;
    while (frames_.size() < frames)
      frames_.push_back({frames_.back().stamp_ns + std::max<Stamp>(interval_ns, 1), {}, {}, {}});
  }

  FrameRecord read_record(Cursor& cursor, std::uint64_t index) {
    const std::string frame = fmt::format("frame {}", index);
    cursor.need(16 * sizeof(float) + 4 * sizeof(std::uint64_t), frame);
    FrameRecord record;
    const Eigen::Matrix4d pose = cursor.take_matrix("the pose");
    record.world_from_device =
        pose_or_none([&] { return pose_of(pose, fmt::format("{}: {}", name_, frame)); });
    const auto stamp_us = cursor.take<std::uint64_t>("the color stamp");
    if (stamp_us > static_cast<std::uint64_t>(std::numeric_limits<Stamp>::max() / 1000))
      cursor.fail(fmt::format("{}: a stamp of {} us", frame, stamp_us));
    record.stamp_ns = static_cast<Stamp>(stamp_us * 1000);
    cursor.take<std::uint64_t>("the depth stamp");
    const auto color_size = cursor.take<std::uint64_t>("the size of the color image");
    const auto depth_size = cursor.take<std::uint64_t>("the size of the depth image");
    record.color = cursor.take_bytes(color_size, frame + "'s color image");
    record.depth = cursor.take_bytes(depth_size, frame + "'s depth image");
    return record;
  }

  /// Some recordings have no stamps, or stamps that do not increase: 30 Hz is assumed for them.
  void repair_stamps() {
    const auto back = std::ranges::adjacent_find(
        frames_, [](Stamp a, Stamp b) { return a >= b; }, &FrameRecord::stamp_ns);
    if (back == frames_.end()) return;
    notes_.push_back(
        fmt::format("{}: the stamp of frame {} is not later than the one before: 30 Hz is assumed",
                    name_, back - frames_.begin() + 1));
    for (std::size_t i = 0; i < frames_.size(); ++i)
      frames_[i].stamp_ns = static_cast<Stamp>(i) * 1'000'000'000 / 30;
  }

  /// The frames are followed by inertial measurements, which are not used; each is five vectors of
  /// doubles and a stamp. Any other bytes indicate that the header states too few frames.
  void note_bytes_left(Cursor& cursor) {
    constexpr std::size_t kMeasurement = 5 * 3 * sizeof(double) + sizeof(std::uint64_t);
    const std::size_t left = cursor.left();
    if (left == 0) return;
    const bool counted = left >= sizeof(std::uint64_t);
    const std::uint64_t count = counted ? cursor.take<std::uint64_t>("inertial measurements") : 0;
    if (counted && cursor.left() % kMeasurement == 0 && cursor.left() / kMeasurement == count)
      return;
    notes_.push_back(
        fmt::format("{}: the {} bytes after frame {}, the last, are not a whole number of inertial "
                    "measurements and are not read",
                    name_, left, frames_.size() - 1));
  }

  [[noreturn]] void fail(std::size_t index, const std::string& what) const {
    throw InputError(fmt::format("{}: frame {}: {}", name_, index, what));
  }

  Grid2d<Rgb8> color_of(const FrameRecord& record, std::size_t index) const {
    const RecordedLens& lens = info_.color;
    const auto fail_size = [&](std::uint64_t width, std::uint64_t height) {
      fail(index, fmt::format("the color image is {} x {}, the header says {} x {}", width, height,
                              lens.width_px, lens.height_px));
    };
    if (color_kind_ == kRawColor) {
      Grid2d<Rgb8> image = empty_image<Rgb8>(lens, record.color.size(), index, "color");
      std::memcpy(static_cast<void*>(image.data()), record.color.data(), record.color.size());
      return image;
    }
    const auto size = declared_size(record.color);
    if (!size) fail(index, "the color image is neither JPEG nor PNG");
    if (size->width != static_cast<std::uint32_t>(lens.width_px) ||
        size->height != static_cast<std::uint32_t>(lens.height_px))
      fail_size(size->width, size->height);
    if (const char* fault = image_fault(record.color))
      fail(index, fmt::format("the color image {}", fault));
    auto image = decode_color(record.color);
    if (!image) fail(index, "the color image does not have 3 x 8 bits, or is damaged");
    if (image->width() != lens.width_px || image->height() != lens.height_px)
      fail_size(static_cast<std::uint64_t>(image->width()),
                static_cast<std::uint64_t>(image->height()));
    return std::move(*image);
  }

  /// An image of a camera's size for raw pixels. @throws InputError if `bytes` does not fit that
  /// size.
  template <class Pixel>
  Grid2d<Pixel> empty_image(const RecordedLens& lens, std::size_t bytes, std::size_t index,
                            const char* which) const {
    const std::uint64_t wanted = sizeof(Pixel) * static_cast<std::uint64_t>(lens.width_px) *
                                 static_cast<std::uint64_t>(lens.height_px);
    if (bytes != wanted)
      fail(index, fmt::format("the {} image has {} bytes, {} x {} pixels have {}", which, bytes,
                              lens.width_px, lens.height_px, wanted));
    return {lens.width_px, lens.height_px};
  }

  Grid2d<std::uint16_t> depth_of(const FrameRecord& record, std::size_t index) const {
    const RecordedLens& lens = info_.depth;
    if (depth_kind_ == kRawDepth) {
      auto image = empty_image<std::uint16_t>(lens, record.depth.size(), index, "depth");
      std::memcpy(image.data(), record.depth.data(), record.depth.size());
      return image;
    }
    const std::uint64_t bytes =
        2 * static_cast<std::uint64_t>(lens.width_px) * static_cast<std::uint64_t>(lens.height_px);
    const auto wrong = [&](const char* why) {
      fail(index, fmt::format("the depth image does not decompress to {} x {} pixels: {}",
                              lens.width_px, lens.height_px, why));
    };
    if (bytes / kDeflateLimit > record.depth.size()) wrong("there are too few bytes");
    Grid2d<std::uint16_t> image(lens.width_px, lens.height_px);
    uLongf size = bytes;
    const int result = uncompress(reinterpret_cast<Bytef*>(image.data()), &size,
                                  reinterpret_cast<const Bytef*>(record.depth.data()),
                                  static_cast<uLong>(record.depth.size()));
    if (result == Z_BUF_ERROR) wrong("it has more, or is truncated");
    if (result != Z_OK) wrong("it is damaged");
    if (size != bytes) wrong("it has fewer");
    return image;
  }

  HeldBytes held_;
  std::string name_;
  RecordingInfo info_;
  std::int32_t color_kind_ = kJpeg, depth_kind_ = kZlib;
  std::vector<FrameRecord> frames_;
  std::size_t whole_ = 0;  ///< complete frames; a truncated file has lost the later ones
};

/// Writes values one after the other.
class Writer {
 public:
  explicit Writer(const fs::path& file) : out_(file, std::ios::binary) {}

  template <class T>
  void put(T value) {
    put_bytes({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void put(const Eigen::Matrix4d& matrix) {
    for (int i = 0; i < 16; ++i) put(static_cast<float>(matrix(i / 4, i % 4)));
  }
  void put_bytes(std::string_view bytes) {
    if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())) && error_ == 0)
      error_ = errno;
  }
  /// @returns 0, or errno of the first write that failed
  int finish() {
    if (!out_.flush() && error_ == 0) error_ = errno;
    return error_;
  }

 private:
  std::ofstream out_;
  int error_ = out_ ? 0 : errno;
};

std::string compressed(const Grid2d<std::uint16_t>& depth) {
  uLongf size = compressBound(2 * depth.size());
  std::string bytes(size, '\0');
  compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
            reinterpret_cast<const Bytef*>(depth.data()), 2 * depth.size(), Z_DEFAULT_COMPRESSION);
  bytes.resize(size);
  return bytes;
}

bool fits(const auto& image, const RecordedLens& lens) {
  return image.width() == lens.width_px && image.height() == lens.height_px;
}

}  // namespace

std::unique_ptr<Recording> open_sens(HeldBytes bytes, const std::string& name) {
  return std::make_unique<SensFile>(std::move(bytes), name);
}

std::unique_ptr<Recording> open_sens(const fs::path& file) {
  return open_sens(map_file(file, MapPages::kAsTouched), file.string());
}

void save_sens(const fs::path& file, const RecordingInfo& info, std::size_t frames,
               const std::function<RecordedMoment(std::size_t index)>& frame_at) {
  write_atomically(file, [&](const fs::path& temporary) {
    Writer out(temporary);
    out.put(kVersion);
    out.put(static_cast<std::uint64_t>(info.sensor.size()));
    out.put_bytes(info.sensor);
    for (const RecordedLens& lens : {info.color, info.depth}) {
      out.put(intrinsics_of(lens));
      out.put(matrix_of(lens.device_from_camera));
    }
    out.put(static_cast<std::int32_t>(kJpeg));
    out.put(static_cast<std::int32_t>(kZlib));
    for (const RecordedLens& lens : {info.color, info.depth}) {
      out.put(static_cast<std::uint32_t>(lens.width_px));
      out.put(static_cast<std::uint32_t>(lens.height_px));
    }
    out.put(static_cast<float>(info.depth_per_meter));
    out.put(static_cast<std::uint64_t>(frames));
    for (std::size_t i = 0; i < frames; ++i) {
      const RecordedMoment moment = frame_at(i);
      if (!fits(moment.color, info.color) || !fits(moment.depth, info.depth))
        throw InputError(
            fmt::format("{}: frame {} does not have the cameras' size", file.string(), i));
      const std::string color = encode_jpeg(moment.color, kRecordedJpegQuality);
      const std::string depth = compressed(moment.depth);
      const double lost = -std::numeric_limits<double>::infinity();
      out.put(moment.world_from_device ? matrix_of(*moment.world_from_device)
                                       : Eigen::Matrix4d::Constant(lost).eval());
      for (int stamp = 0; stamp < 2; ++stamp)  // color's and depth's
        out.put(static_cast<std::uint64_t>(moment.stamp_ns / 1000));
      out.put(static_cast<std::uint64_t>(color.size()));
      out.put(static_cast<std::uint64_t>(depth.size()));
      out.put_bytes(color);
      out.put_bytes(depth);
    }
    out.put(std::uint64_t{0});  // inertial measurements
    if (const int error = out.finish()) throw_unwritable(file, error);
  });
}

}  // namespace mh
