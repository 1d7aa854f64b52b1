// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/words.hpp"

namespace mh {

/// What a system reports for a frame: only kLost comes without a pose.
enum class TrackStatus { kInitialized, kTracked, kRelocalized, kLost };

constexpr Names<TrackStatus, 4> words(TrackStatus) {
  return {{{"initialized", TrackStatus::kInitialized},
           {"tracked", TrackStatus::kTracked},
           {"relocalized", TrackStatus::kRelocalized},
           {"lost", TrackStatus::kLost}}};
}
constexpr std::string_view name(TrackStatus status) {
  return name_of(status, words(status));
}

}  // namespace mh
