// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "slam/io/fields.hpp"

namespace mh {

struct SlamConfig;

/// All settings of SLAM as an immutable value that is cheap to copy. A header with a member of this
/// type need not include slam/config/slam.hpp; only files that read the settings do.
class SharedSlamConfig {
 public:
  SharedSlamConfig();                                      ///< the defaults
  SharedSlamConfig(const SlamConfig& config);              // NOLINT(google-explicit-constructor)
  operator const SlamConfig&() const { return *config_; }  // NOLINT(google-explicit-constructor)
  const SlamConfig* operator->() const { return config_.get(); }
  const SlamConfig& operator*() const { return *config_; }
  friend bool operator==(const SharedSlamConfig& a, const SharedSlamConfig& b);

 private:
  std::shared_ptr<const SlamConfig> config_;  // never null
};
template <>
inline constexpr bool kIsShared<SharedSlamConfig> = true;

}  // namespace mh
