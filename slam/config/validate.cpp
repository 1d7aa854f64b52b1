// SPDX-License-Identifier: Apache-2.0
#include "slam/config/slam.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {
namespace {

struct Check {
  std::string part;
  void section(const char* name) { part = name; }
  void operator()(const char* key, double value, const SettingRange& range, const char*) const {
    if (!std::isfinite(value) || value < range.min || value > range.max ||
        (range.open && value == range.max))
      throw InputError(fmt::format("slam settings: {}.{} = {} is outside [{}, {}{}", part, key,
                                   value, range.min, range.max, range.open ? ")" : "]"));
  }
  void operator()(const char*, Overlap, const SettingRange&, const char*) const {}
};

}  // namespace

void validate(const SlamConfig& config) {
  for_each_setting(config, Check{});
}

}  // namespace mh
