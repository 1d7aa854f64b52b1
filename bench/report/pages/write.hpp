// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/report/pages/source.hpp"

namespace mh {

/// The folder with the files that a browser runs: index.html, app.js, app.css
/// (bench/report/pages/bundle).
std::filesystem::path bundle_folder();

/// Digest of the files below bench/report/web, from which the bundle is made; the second line of
/// the bundle's scripts holds the digest that they were made from. FNV-1a, 64 bits, over each
/// file's path and content in order of the paths, so that bench/report/web/build.mjs can compute
/// it, too.
std::string digest_of_web(const std::filesystem::path& web);

/// Names of the files that write_pages() leaves in a folder. The data are in its subfolder `data`.
std::vector<std::string> names_of_pages();

/// What was written.
struct WrittenPages {
  std::filesystem::path index;  ///< the page to open first
  std::size_t files = 0;
  std::uintmax_t bytes = 0;
};

/// Writes results as a folder of pages that a browser opens from the disk, without a network. Data
/// of an earlier report in the folder are removed first.
/// @param budget  limit on the total size of all runs' trajectories, bytes
WrittenPages write_pages(const std::filesystem::path& out, std::span<const PagesSource> sources,
                         std::size_t budget = 12'000'000);

}  // namespace mh
