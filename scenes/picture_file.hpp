// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace cv {
class Mat;
}

namespace mh {

struct PictureSize {
  std::uint32_t width = 0, height = 0;
};

/// The size that a JPEG or PNG announces, without decoding it; nullopt if the bytes are neither.
std::optional<PictureSize> announced_size(std::string_view bytes);

/// What is wrong with a JPEG or PNG as a file, found without decoding it: "is cut short", or a
/// PNG's wrong sum; nullptr if nothing, or if the bytes are neither. Decoders would show a picture
/// whose end is gray, and tell it to stderr at most.
const char* picture_fault(std::string_view bytes);

/// Whether they announce more pixels than so few bytes can hold, or than anybody needs: to be
/// refused before anything is allocated for them.
bool claims_too_much(std::string_view bytes);

/// The same picture without what a PNG says beside it (color profiles, texts, times): no decoder
/// here heeds that, and libpng prints its opinion of it to stderr. Other bytes stay as they are.
std::string without_remarks(std::string_view bytes);

/// What to make of a picture's pixels: channels (in OpenCV's order) and depth as stored, three of 8
/// bits, or one of 8 bits.
enum class PictureForm { kStored, kColor, kGray };

/// Decodes a picture of any kind that OpenCV reads; all that the program decodes comes through
/// here.
/// @throws InputError that says what is wrong with it, to be put behind a file's name: damaged, cut
/// short, or announcing more than such a file can hold.
cv::Mat decode_picture(std::string_view bytes, PictureForm form = PictureForm::kStored);
/// The picture in a file. @throws InputError naming the file.
cv::Mat read_picture(const std::filesystem::path& file, PictureForm form = PictureForm::kStored);

/// Decodes a picture of three 8-bit channels; nullopt if the bytes hold none.
std::optional<Grid2d<Rgb8>> decode_color(std::string_view bytes);
/// Decodes a picture of one channel, 8 or 16 bits; nullopt if the bytes hold none.
std::optional<Grid2d<std::uint16_t>> decode_gray16(std::string_view bytes);

/// @param quality  of the JPEG, 1 to 100
std::string encode_jpeg(const Grid2d<Rgb8>& picture, int quality);
std::string encode_png(const Grid2d<std::uint16_t>& picture);
std::string encode_png(const Grid2d<std::uint8_t>& picture);

}  // namespace mh
