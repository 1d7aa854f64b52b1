// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/grid2d.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {

/// One image of ids for each frame of a recording: ScanNet's label-filt (raw category ids) or
/// instance-filt (objectId + 1). 8 or 16 bits.
class LabelImages {
 public:
  virtual ~LabelImages() = default;
  /// The folder or zip that contains the images.
  virtual const std::string& place() const = 0;
  /// Whether a frame has an image.
  virtual bool contains(std::uint32_t number) const = 0;
  /// The file with a frame's image, which is read on demand; empty if there is none, or if all
  /// images are in one file that was already read.
  virtual std::filesystem::path file(std::uint32_t) const { return {}; }
  /// The image of a frame; nullopt if there is none. @throws InputError if it is damaged.
  virtual std::optional<Grid2d<std::uint16_t>> read(std::uint32_t number) const = 0;
};

/// Opens the label images next to a recording: a folder `kind` ("label-filt", "instance-filt"), or
/// a zip *_2d-KIND.zip. Null if neither exists.
/// @throws InputError if the zip is damaged, or if an entry would be extracted outside of the
/// target folder.
std::unique_ptr<LabelImages> find_label_images(const std::filesystem::path& folder,
                                               const std::string& kind);
/// Opens a zip of label images; `name` names the file in messages.
std::unique_ptr<LabelImages> open_label_zip(HeldBytes bytes, const std::string& name);

/// Writes KIND/N.png into a folder, or into a zip of that name: 16 bits, or 8 if no id exceeds 255
/// and the kind is instance-filt, as in ScanNet.
class LabelImageWriter {
 public:
  virtual ~LabelImageWriter() = default;
  virtual void add(std::uint32_t number, const Grid2d<std::uint16_t>& ids) = 0;
  virtual void finish() = 0;
};
std::unique_ptr<LabelImageWriter> write_label_folder(const std::filesystem::path& folder,
                                                     const std::string& kind);
/// The zip appears when finish() is called.
std::unique_ptr<LabelImageWriter> write_label_zip(const std::filesystem::path& file,
                                                  const std::string& kind);

}  // namespace mh
