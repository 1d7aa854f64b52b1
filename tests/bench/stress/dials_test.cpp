// SPDX-License-Identifier: Apache-2.0
// The laws of all dials that the shipped stress test turns.
#include <algorithm>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/suite/shipped.hpp"
#include "bench/suite/suite.hpp"
#include "sim/simulation/faulty_sequence.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "tests/bench/stress/small_room.hpp"

namespace mh {
namespace {

using testing::HasSubstr;

const Suite& shipped() {
  static const Suite suite = load_suite(shipped_file("stress", Shipped::kSuite));
  return suite;
}

SensorConfig at_dose(const StressDial& dial, double dose) {
  Level level = shipped().levels.front();
  level.doses = {{dial.dial, dose}};
  return sensors_at(level);
}

TEST(Dials, AtLeastTwoDozenAreTurned) {
  EXPECT_GE(shipped().stress->dials.size(), 24U);
}

TEST(Dials, TheDoseOfNoFaultChangesNoBit) {
  const SmallRoom room;
  const std::vector<RgbdFrame> clean = room.frames(sensors_at(shipped().levels.front()));
  for (const StressDial& dial : shipped().stress->dials) {
    const SensorConfig level = at_dose(dial, dial.from);
    const std::vector<RgbdFrame> frames = room.frames(level);
    ASSERT_EQ(frames.size(), clean.size()) << dial.dial;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(digest(frames[i]), digest(clean[i])) << dial.dial << " frame " << i;
      EXPECT_EQ(frames[i].stamp_ns, clean[i].stamp_ns) << dial.dial;
    }
    EXPECT_EQ(room.camera(level), room.camera(sensors_at(shipped().levels.front()))) << dial.dial;
  }
}

TEST(Dials, TheStrongestDoseChangesSomething) {
  const SmallRoom room;
  const SensorConfig base = sensors_at(shipped().levels.front());
  const std::vector<RgbdFrame> clean = room.frames(base);
  for (const StressDial& dial : shipped().stress->dials) {
    if (dial.dial.starts_with("hurry.")) continue;  // changes the path, not what is seen on it
    const SensorConfig level = at_dose(dial, dial.to);
    const std::vector<RgbdFrame> frames = room.frames(level);
    bool differs = frames.size() != clean.size() || !(room.camera(level) == room.camera(base));
    for (std::size_t i = 0; i < frames.size() && !differs; ++i)
      differs = digest(frames[i]) != digest(clean[i]);
    EXPECT_TRUE(differs) << dial.dial;
  }
}

/// Mean absolute difference of the images: color in gray levels, and the share of depths that
/// differ by more than 1 %.
double distance(const std::vector<RgbdFrame>& a, const std::vector<RgbdFrame>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double color = 0, depth = 0;
    for (std::size_t k = 0; k < a[i].color.size(); ++k)
      color += std::abs(a[i].color.data()[k].g - b[i].color.data()[k].g);
    for (std::size_t k = 0; k < a[i].depth_m.size(); ++k)
      depth += std::abs(a[i].depth_m.data()[k] - b[i].depth_m.data()[k]);
    sum += color / static_cast<double>(a[i].color.size()) +
           100 * depth / static_cast<double>(a[i].depth_m.size());
  }
  return sum / static_cast<double>(a.size());
}

TEST(Dials, AStrongerDoseIsNotNearerToTheCleanImage) {
  const SmallRoom room;
  const std::vector<RgbdFrame> clean = room.frames(sensors_at(shipped().levels.front()));
  for (const StressDial& dial : shipped().stress->dials) {
    const std::string section = dial.dial.substr(0, dial.dial.find('.'));
    if (section == "hurry" || section == "feed" || section == "told" || section == "dropped_frames")
      continue;  // change which frames are seen, or the camera
    double before = 0;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const double now = distance(clean, room.frames(at_dose(dial, dose_at(dial, share))));
      EXPECT_GE(now, 0.95 * before) << dial.dial << " at " << dose_at(dial, share);
      before = now;
    }
  }
}

TEST(Dials, ARecordingOfTheCleanImagesBecomesWhatTheLevelRenders) {
  const SmallRoom room;
  const SensorConfig exact = exact_sensors();
  for (const StressDial& dial : shipped().stress->dials) {
    Level level{.file = kRecordedLevel, .of_recordings = true, .doses = {{dial.dial, dial.to}}};
    const SensorConfig faults = sensors_at(level);
    if (!faults_of_scene(faults).empty()) continue;
    const auto recorded = degraded(room.recording(exact), faults);
    const std::vector<RgbdFrame> rendered = room.frames(faults);
    ASSERT_EQ(recorded->size(), rendered.size()) << dial.dial;
    for (std::size_t i = 0; i < rendered.size(); ++i)
      EXPECT_EQ(digest(recorded->frame(i, room.noise())), digest(rendered[i]))
          << dial.dial << " frame " << i;
  }
}

TEST(Dials, WhatNeedsTheSceneIsRefusedForARecording) {
  const SmallRoom room;
  for (const char* dial : {"motion_blur.exposure_ms", "rolling_shutter.readout_ms",
                           "depth_offset.offset_ms", "hurry.speed"}) {
    Level level{.file = kRecordedLevel, .of_recordings = true, .doses = {{dial, 5}}};
    try {
      degraded(room.recording(exact_sensors()), sensors_at(level));
      ADD_FAILURE() << dial;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("needs images along the camera's motion")) << dial;
    }
  }
}

TEST(Dials, WrongStampsMoveTheTruthAlong) {
  const SmallRoom room;
  const auto frames =
      with_feed_faults(room.recording(exact_sensors()),
                       with_doses(exact_sensors(), std::vector<Dose>{{"feed.jitter_ms", 20}}));
  ASSERT_NE(frames->truth(), nullptr);
  ASSERT_EQ(frames->truth()->size(), frames->size());
  bool moved = false;
  for (std::size_t i = 0; i < frames->size(); ++i) {
    EXPECT_EQ(frames->stamp_ns(i), (*frames->truth())[i].stamp_ns);
    EXPECT_EQ(frames->frame(i, room.noise()).stamp_ns, frames->stamp_ns(i));
    if (i > 0) EXPECT_GT(frames->stamp_ns(i), frames->stamp_ns(i - 1));
    moved = moved || frames->stamp_ns(i) != room.recording(exact_sensors())->stamp_ns(i);
  }
  EXPECT_TRUE(moved);
}

TEST(Dials, BackwardIsTheSameFramesInTheOtherOrder) {
  const SmallRoom room;
  const auto forward = room.recording(exact_sensors());
  const auto back = with_feed_faults(
      forward, with_doses(exact_sensors(), std::vector<Dose>{{"feed.backward", 1}}));
  const std::size_t n = forward->size();
  ASSERT_EQ(back->size(), n);
  EXPECT_EQ(back->stamp_ns(0), forward->stamp_ns(0));
  for (std::size_t i = 0; i < n; ++i) {
    const RgbdFrame frame = back->frame(i, room.noise());
    EXPECT_EQ(frame.color, forward->frame(n - 1 - i, room.noise()).color);
    EXPECT_EQ((*back->truth())[i].stamp_ns, frame.stamp_ns);
    EXPECT_EQ((*back->truth())[i].world_from_camera.numbers(),
              (*forward->truth())[n - 1 - i].world_from_camera.numbers());
    if (i > 0) EXPECT_GT(back->stamp_ns(i), back->stamp_ns(i - 1));
  }
}

TEST(Doses, AreRefusedByNameAndRange) {
  const auto why = [](const std::string& dial, double value) -> std::string {
    try {
      with_doses(exact_sensors(), std::vector<Dose>{{dial, value}});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(why("lens_blur.sigma_px", 2), "");
  EXPECT_THAT(why("lens_blur.sigma", 2), HasSubstr("did you mean 'lens_blur.sigma_px'"));
  EXPECT_THAT(why("lens_blur.sigma_px", 2000), HasSubstr("outside [0, 20]"));
  EXPECT_THAT(why("depth_noise.max_range_m", 0.1), HasSubstr("must be above min_range_m"));
}

}  // namespace
}  // namespace mh
