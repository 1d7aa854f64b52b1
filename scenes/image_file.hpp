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

struct ImageSize {
  std::uint32_t width = 0, height = 0;
};

/// The size that a JPEG or PNG header declares, without decoding it; nullopt if the bytes are
/// neither.
std::optional<ImageSize> declared_size(std::string_view bytes);

/// What is wrong with a JPEG or PNG as a file, found without decoding it: "is truncated", a PNG's
/// wrong checksum, or the kind of the image if it is not supported; nullptr if nothing is wrong.
/// For a truncated file, decoders would return an image whose end is gray, and at most report that
/// on stderr.
const char* image_fault(std::string_view bytes);

/// Whether the header declares more pixels than this number of bytes can encode, or more than are
/// ever needed: such files are refused before anything is allocated for them.
bool claims_too_much(std::string_view bytes);

/// The same image without a PNG's ancillary chunks (color profiles, texts, times): no decoder here
/// uses them, and libpng prints warnings about them to stderr. Other bytes are unchanged.
std::string without_remarks(std::string_view bytes);

/// Pixel format to decode to: as stored (the file's bit depth and number of channels, in OpenCV's
/// order), three 8-bit channels, or one 8-bit channel.
enum class ImageForm { kStored, kColor, kGray };

/// Decodes an image of any kind that OpenCV reads, or a TGA (only as stored). All image decoding in
/// the program goes through this function.
/// @throws InputError whose text is to be appended to the file's name and states what is wrong:
/// damaged, truncated, or declaring more pixels than the file can contain.
cv::Mat decode_image(std::string_view bytes, ImageForm form = ImageForm::kStored);
/// Reads an image file. @throws InputError naming the file.
cv::Mat read_image(const std::filesystem::path& file, ImageForm form = ImageForm::kStored);

/// Converts OpenCV's blue-green-red image of 8 bits to color.
Grid2d<Rgb8> color_of(const cv::Mat& bgr);

/// Decodes an image of three 8-bit channels; nullopt if the bytes are not such an image.
std::optional<Grid2d<Rgb8>> decode_color(std::string_view bytes);
/// Decodes an image of one channel, 8 or 16 bits; nullopt if the bytes are not such an image.
std::optional<Grid2d<std::uint16_t>> decode_gray16(std::string_view bytes);

/// Decodes a depth image: one channel of 16 bits. Fewer bits cannot hold millimeters.
/// @throws InputError whose text is to be appended to the file's name and states what the image is
/// instead.
Grid2d<std::uint16_t> decode_depth16(std::string_view bytes);

/// @param quality  of the JPEG, 1 to 100
std::string encode_jpeg(const Grid2d<Rgb8>& image, int quality);
std::string encode_png(const Grid2d<std::uint16_t>& image);
std::string encode_png(const Grid2d<std::uint8_t>& image);

}  // namespace mh
