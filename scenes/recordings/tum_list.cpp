// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/tum_list.hpp"

#include <sstream>

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Whether a stamp is in nanoseconds since 1970: ROS programs name images this way. A stamp in
/// seconds cannot be mistaken for one, since it has at most ten digits before the decimal point.
bool is_in_nanoseconds(const std::string& stamp) {
  constexpr std::size_t kDigits = 18;  // since 1973
  return stamp.size() >= kDigits && stamp.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::vector<TumListEntry> parse_tum_list(const std::string& text, const std::string& name,
                                         int skip) {
  std::istringstream lines(text);
  std::vector<TumListEntry> entries;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string stamp, file;
    if (!(words >> stamp)) continue;
    for (int k = 0; k < skip; ++k)
      if (!(words >> stamp)) stamp.clear();
    if (!(words >> file))
      throw InputError(fmt::format("{}:{}: a stamp and a file are needed", name, number));
    try {
      entries.push_back({parse_stamp(stamp, is_in_nanoseconds(stamp) ? -9 : 0), file});
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", name, number, error.what()));
    }
  }
  return entries;
}

}  // namespace mh
