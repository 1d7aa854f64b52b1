// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/report/pages/source.hpp"

namespace mh {

/// The folder with what a browser runs: index.html, app.js, app.css (bench/report/pages/bundle).
std::filesystem::path bundle_folder();

/// Digest of the files that the bundle is made from, below bench/report/web; the bundle's scripts
/// hold the same in their second line. FNV-1a, 64 bits, over each file's path and content in order
/// of the paths, so that bench/report/web/build.mjs computes it too.
std::string digest_of_web(const std::filesystem::path& web);

/// Names of the files that write_pages() leaves in a folder; its data are in the folder `data`.
std::vector<std::string> names_of_pages();

/// What was written.
struct WrittenPages {
  std::filesystem::path index;  ///< to be opened
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

/// Writes results as a folder of pages that a browser opens from the disk, without a network. Old
/// data of the folder are removed first.
/// @param budget  bytes that the trajectories of all runs may take
WrittenPages write_pages(const std::filesystem::path& out, std::span<const PagesSource> sources,
                         std::size_t budget = 12'000'000);

}  // namespace mh
