// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>
#include <string>

#include "slam/detect/detector.hpp"
#include "slam/io/files.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

namespace fs = std::filesystem;

/// A folder in which the bytes become a file that is read as boxes or as class names.
struct Files {
  fs::path folder = fs::temp_directory_path() / ("mh_fuzz_boxes_" + std::to_string(getpid()));
  Files() { fs::create_directories(folder / "yolo"); }
  ~Files() { fs::remove_all(folder); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Files files;
  const std::string bytes(mh::bytes_of(data, size));
  static const mh::Grid2d<mh::Rgb8> image(64, 48);
  for (const char* name : {"boxes.json", "boxes.csv", "yolo/000000.txt"}) {
    const fs::path file = files.folder / name;
    mh::write_atomically(file, bytes);
    mh::DetectorSpec spec;
    spec.boxes = file.parent_path() == files.folder ? file : file.parent_path();
    mh::try_input([&] {
      const mh::Detected found = mh::open_detector(spec)->detect(image, 0, 0);
      mh::labels_of(found, {}, image.width(), image.height(), mh::BoxFill::kBox);
    });
  }
  mh::try_input([&] { mh::load_class_names(files.folder / "boxes.csv"); });
  return 0;
}
