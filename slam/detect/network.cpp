// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>
#include <opencv2/core/utility.hpp>

#include "slam/detect/detector.hpp"
#include "slam/detect/fit_image.hpp"
#include "slam/detect/heads.hpp"
#include "slam/detect/import_network.hpp"
#include "slam/io/error.hpp"
#include "slam/io/guarded_child.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Imports and runs the network once in a child process, where a crash does no harm.
void try_in_child(const DetectorSpec& spec, const NetworkFiles& files) {
  if (reads_here()) return;
  constexpr std::uint64_t kMemoryPerByte = 20;
  const GuardLimits limits{
      .processor_s = 30 + static_cast<int>(files.network.size() >> 22),
      .memory_bytes = (std::uint64_t{4} << 30) + kMemoryPerByte * files.network.size()};
  in_child(
      files.is_darknet ? spec.config : spec.network, limits,
      [&]() -> std::function<void(PipeWriter&)> {
        import_network(spec, files);
        return [](PipeWriter&) {};
      },
      [](PipeReader&) {});
}

class Network : public Detector {
 public:
  explicit Network(const DetectorSpec& spec) {
    const NetworkFiles files = read_network_files(spec);
    cv::setNumThreads(1);
    try_in_child(spec, files);
    imported_ = import_network(spec, files);
    file_ = spec.network;
    digest_ = XXH3_64bits(files.network.data(), files.network.size());
    digest_ = XXH3_64bits_withSeed(files.config.data(), files.config.size(), digest_);
    std::string decides = fmt::format("{}", fmt::join(imported_.names.names, "\n"));
    DetectorSettings seen = imported_.settings;
    seen.fill = {};  // affects only labels, which are not cached
    decides += format_detector_settings(seen, false) +
               fmt::format("OpenCV {} input {} x {}", CV_VERSION, imported_.input.width,
                           imported_.input.height);
    digest_ = XXH3_64bits_withSeed(decides.data(), decides.size(), digest_);
  }

  std::string check_frames(std::span<const Stamp>) const override {
    return imported_.names.unknown_note(file_);
  }

  Detected detect(const Grid2d<Rgb8>& color, std::size_t, Stamp) const override {
    const DetectorSettings& settings = imported_.settings;
    const Placement at =
        place_image(color.width(), color.height(), imported_.input, settings.letterbox);
    const cv::Mat input = network_input(color, imported_.input, at, settings);
    const std::scoped_lock lock(mutex_);
    const NetworkOutputs out = run_network(file_, imported_, input);
    Detected found;
    if (settings.head == Head::kSegmentation) {
      if (const Tensor* tensor = segmentation_in(out.tensors, imported_.input))
        found.pixels = segmented(*tensor, at, imported_.input, {color.width(), color.height()},
                                 imported_.names, settings.confidence);
    } else {
      found.boxes = select_boxes(candidates(out), at, color.width(), color.height(),
                                 imported_.names, settings);
    }
    return found;
  }
  const ClassNames& names() const override { return imported_.names; }
  std::string description() const override {
    return fmt::format("{}, {} classes, input {} x {}",
                       SettingsWriter::word_of(imported_.settings.head), imported_.names.size(),
                       imported_.input.width, imported_.input.height);
  }
  std::uint64_t digest() const override { return digest_; }

 private:
  std::vector<Candidate> candidates(const NetworkOutputs& out) const {
    const DetectorSettings& settings = imported_.settings;
    try {
      return decode(settings.head, out.tensors, imported_.input, settings.confidence);
    } catch (const InputError& error) {
      refuse_network(file_, error.what());
    }
  }

  mutable std::mutex mutex_;
  mutable ImportedNetwork imported_;  // running a network changes its memory
  fs::path file_;
  std::uint64_t digest_ = 0;
};

}  // namespace

std::unique_ptr<Detector> open_network(const DetectorSpec& spec) {
  return std::make_unique<Network>(spec);
}

std::unique_ptr<Detector> open_detector(const DetectorSpec& spec) {
  return spec.network.empty() ? open_boxes(spec) : open_network(spec);
}

}  // namespace mh
