// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/label_images.hpp"

#include <zip.h>

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "scenes/scannet/frame_folder.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
constexpr zip_uint64_t kLargestEntry = 1U << 28;

Grid2d<std::uint16_t> decode(std::string_view bytes, const std::string& name) {
  if (const char* fault = image_fault(bytes)) throw InputError(fmt::format("{}: {}", name, fault));
  if (!bytes.starts_with("\x89PNG"))
    throw InputError(fmt::format("{}: is not a PNG image: only PNG keeps ids exact", name));
  auto image = decode_gray16(bytes);
  if (!image) throw InputError(fmt::format("{}: is not an image of one channel", name));
  return std::move(*image);
}

class LabelFolder : public LabelImages {
 public:
  explicit LabelFolder(const fs::path& folder)
      : files_(folder, {".png"}), place_(folder.string()) {}
  const std::string& place() const override { return place_; }
  bool contains(std::uint32_t number) const override { return files_.contains(number); }
  fs::path file(std::uint32_t number) const override {
    return files_.contains(number) ? files_.file(number) : fs::path();
  }
  std::optional<Grid2d<std::uint16_t>> read(std::uint32_t number) const override {
    if (!files_.contains(number)) return std::nullopt;
    const fs::path& file = files_.file(number);
    return decode(read_file(file), file.string());
  }

 private:
  NumberedFiles files_;
  std::string place_;
};

/// Whether an entry would be extracted outside of the target folder.
bool points_outside(const std::string& entry) {
  const fs::path path = fs::path(entry).lexically_normal();
  return entry.empty() || path.is_absolute() || entry.find('\\') != entry.npos ||
         (!path.empty() && *path.begin() == "..");
}

class LabelZip : public LabelImages {
 public:
  LabelZip(HeldBytes bytes, const std::string& name) : held_(std::move(bytes)), name_(name) {
    // libzip rejects an empty buffer.
    if (held_.view.empty()) throw InputError(fmt::format("{}: is empty, not a zip", name_));
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* source =
        zip_source_buffer_create(held_.view.data(), held_.view.size(), 0, &error);
    zip_t* opened = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
    if (opened == nullptr) {
      const std::string why = zip_error_strerror(&error);
      zip_error_fini(&error);
      if (source) zip_source_free(source);
      throw InputError(fmt::format("{}: is not a zip that can be read: {}", name_, why));
    }
    zip_error_fini(&error);
    archive_.reset(opened);
    index_entries();
  }

  const std::string& place() const override { return name_; }
  bool contains(std::uint32_t number) const override { return entries_.contains(number); }
  std::optional<Grid2d<std::uint16_t>> read(std::uint32_t number) const override {
    const auto found = entries_.find(number);
    if (found == entries_.end()) return std::nullopt;
    const std::string bytes = read_entry(found->second);
    return decode(bytes, fmt::format("{}: {}", name_, entry_name(found->second)));
  }

 private:
  struct Closer {
    void operator()(zip_t* archive) const { zip_discard(archive); }
  };

  std::string entry_name(zip_uint64_t index) const {
    const char* name = zip_get_name(archive_.get(), index, ZIP_FL_ENC_RAW);
    if (name == nullptr) throw InputError(fmt::format("{}: entry {} has no name", name_, index));
    return name;
  }

  void index_entries() {
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
      const std::string name = entry_name(static_cast<zip_uint64_t>(i));
      if (points_outside(name))
        throw InputError(fmt::format("{}: entry '{}' points outside of the zip", name_, name));
      const fs::path path(name);
      if (path.extension() != ".png") continue;
      if (const auto number = number_of_name(path))
        entries_.try_emplace(*number, static_cast<zip_uint64_t>(i));
    }
  }

  std::string read_entry(zip_uint64_t index) const {
    const auto fail = [&](const std::string& what) {
      throw InputError(fmt::format("{}: {}: {}", name_, entry_name(index), what));
    };
    zip_stat_t info;
    if (zip_stat_index(archive_.get(), index, 0, &info) != 0 || (info.valid & ZIP_STAT_SIZE) == 0)
      fail("its size cannot be read");
    // Deflate expands data at most 1032 times; an image that claims more is invalid.
    if (info.size > kLargestEntry || info.size / 1032 > held_.view.size())
      fail(fmt::format("claims {} bytes", info.size));
    const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
        zip_fopen_index(archive_.get(), index, 0), zip_fclose);
    if (!file) fail(zip_strerror(archive_.get()));
    std::string bytes(static_cast<std::size_t>(info.size), '\0');
    // Asking for one byte more than declared reveals whether there is more, and makes libzip verify
    // the checksum.
    char more = 0;
    if (zip_fread(file.get(), bytes.data(), bytes.size()) !=
            static_cast<zip_int64_t>(bytes.size()) ||
        zip_fread(file.get(), &more, 1) != 0)
      fail("cannot be unpacked");
    return bytes;
  }

  HeldBytes held_;
  std::string name_;
  std::unique_ptr<zip_t, Closer> archive_;
  std::map<std::uint32_t, zip_uint64_t> entries_;
};

/// A PNG with the bit depth that ScanNet uses for the kind.
std::string encode(const Grid2d<std::uint16_t>& ids, const std::string& kind) {
  if (kind != "instance-filt" || std::ranges::any_of(ids, [](auto id) { return id > 255; }))
    return encode_png(ids);
  Grid2d<std::uint8_t> narrow(ids.width(), ids.height());
  std::ranges::transform(ids, narrow.begin(),
                         [](std::uint16_t id) { return static_cast<std::uint8_t>(id); });
  return encode_png(narrow);
}

class FolderWriter : public LabelImageWriter {
 public:
  FolderWriter(const fs::path& folder, const std::string& kind)
      : folder_(folder / kind), kind_(kind) {
    make_output_folder(folder_);
  }
  void add(std::uint32_t number, const Grid2d<std::uint16_t>& ids) override {
    write_atomically(folder_ / fmt::format("{}.png", number), encode(ids, kind_));
  }
  void finish() override {}

 private:
  fs::path folder_;
  std::string kind_;
};

class ZipWriter : public LabelImageWriter {
 public:
  ZipWriter(const fs::path& file, const std::string& kind) : file_(file), kind_(kind) {}
  void add(std::uint32_t number, const Grid2d<std::uint16_t>& ids) override {
    images_[number] = encode(ids, kind_);
  }
  void finish() override {
    write_atomically(file_, [&](const fs::path& temporary) { write(temporary); });
  }

 private:
  void write(const fs::path& temporary) const {
    int error = 0;
    zip_t* archive = zip_open(temporary.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &error);
    if (archive == nullptr)
      throw InputError(fmt::format("{}: cannot be written: zip error {}", file_.string(), error));
    const auto fail = [&] {
      const std::string why = zip_strerror(archive);
      const zip_error_t* what = zip_get_error(archive);
      const int system =
          zip_error_system_type(what) == ZIP_ET_SYS ? zip_error_code_system(what) : 0;
      zip_discard(archive);
      if (system != 0) throw_unwritable(file_, system);
      throw InputError(fmt::format("{}: cannot be written: {}", file_.string(), why));
    };
    for (const auto& [number, png] : images_) {
      zip_source_t* source = zip_source_buffer(archive, png.data(), png.size(), 0);
      const std::string name = fmt::format("{}/{}.png", kind_, number);
      const zip_int64_t entry = zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8);
      if (entry < 0) {
        zip_source_free(source);
        fail();
      }
      // PNG is already compressed. A fixed time makes zips of equal content identical, byte for
      // byte.
      const auto index = static_cast<zip_uint64_t>(entry);
      zip_set_file_compression(archive, index, ZIP_CM_STORE, 0);
      zip_file_set_dostime(archive, index, 0, 0x21, 0);  // 1980-01-01, the earliest that zip can
                                                         // represent
    }
    if (zip_close(archive) != 0) fail();
  }

  fs::path file_;
  std::string kind_;
  std::map<std::uint32_t, std::string> images_;
};

}  // namespace

std::unique_ptr<LabelImages> find_label_images(const fs::path& folder, const std::string& kind) {
  if (is_folder(folder / kind)) return std::make_unique<LabelFolder>(folder / kind);
  const std::vector<std::string> zips = list_folder(folder, fmt::format("*_2d-{}.zip", kind));
  if (zips.empty()) return nullptr;
  if (zips.size() > 1)
    throw InputError(fmt::format("{}: holds {} files of {} images ({}, {}, ...): one is needed",
                                 folder.string(), zips.size(), kind, zips[0], zips[1]));
  const fs::path first = folder / zips.front();
  return open_label_zip(map_file(first, MapPages::kAsTouched), first.string());
}

std::unique_ptr<LabelImages> open_label_zip(HeldBytes bytes, const std::string& name) {
  return std::make_unique<LabelZip>(std::move(bytes), name);
}

std::unique_ptr<LabelImageWriter> write_label_folder(const fs::path& folder,
                                                     const std::string& kind) {
  return std::make_unique<FolderWriter>(folder, kind);
}

std::unique_ptr<LabelImageWriter> write_label_zip(const fs::path& file, const std::string& kind) {
  return std::make_unique<ZipWriter>(file, kind);
}

}  // namespace mh
