// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/frame_folder.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::string matrix_text(const Eigen::Matrix4d& matrix) {
  std::string text;
  for (int row = 0; row < 4; ++row)
    text += fmt::format("{} {} {} {}\n", matrix(row, 0), matrix(row, 1), matrix(row, 2),
                        matrix(row, 3));
  return text;
}

}  // namespace

std::optional<std::uint32_t> number_of_name(const fs::path& name) {
  const std::string stem = name.stem().string();
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (stem.empty() || error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return number;
}

NumberedFiles::NumberedFiles(const fs::path& folder,
                             std::initializer_list<std::string_view> endings) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  for (const std::string_view ending : endings)
    for (const std::string& name : list_folder(folder, fmt::format("*{}", ending))) {
      const auto number = number_of_name(name);
      if (!number) continue;
      // If two files have the same number, the first by name is used.
      const auto [place, is_new] = files_.try_emplace(*number, folder / name);
      if (!is_new) place->second = std::min(place->second, folder / name);
    }
}

std::vector<std::uint32_t> NumberedFiles::numbers() const {
  std::vector<std::uint32_t> numbers;
  for (const auto& [number, file] : files_) numbers.push_back(number);
  return numbers;
}

void save_extracted(const fs::path& folder, const RecordingInfo& info, std::size_t frames,
                    const std::function<RecordedMoment(std::size_t index)>& frame_at) {
  for (const char* part : {"color", "depth", "pose", "intrinsic"})
    make_output_folder(folder / part);
  for (std::size_t i = 0; i < frames; ++i) {
    const RecordedMoment moment = frame_at(i);
    const double lost = -std::numeric_limits<double>::infinity();
    write_atomically(folder / "color" / fmt::format("{}.jpg", i),
                     encode_jpeg(moment.color, kRecordedJpegQuality));
    write_atomically(folder / "depth" / fmt::format("{}.png", i), encode_png(moment.depth));
    write_atomically(
        folder / "pose" / fmt::format("{}.txt", i),
        matrix_text(moment.world_from_device ? matrix_of(*moment.world_from_device)
                                             : Eigen::Matrix4d::Constant(lost).eval()));
  }
  const auto write_lens = [&](const char* which, const RecordedLens& lens) {
    write_atomically(folder / "intrinsic" / fmt::format("intrinsic_{}.txt", which),
                     matrix_text(intrinsics_of(lens)));
    write_atomically(folder / "intrinsic" / fmt::format("extrinsic_{}.txt", which),
                     matrix_text(matrix_of(lens.device_from_camera)));
  };
  write_lens("color", info.color);
  write_lens("depth", info.depth);
}

}  // namespace mh
