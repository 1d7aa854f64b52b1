// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/difficulty.hpp"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

SensorConfig handheld() {
  return load_sensor_config(std::filesystem::path(MH_SOURCE_DIR) /
                            "sim/sensors/levels/handheld.yaml");
}

TEST(Difficulty, BeginsAtTheLevelAndEndsAtWhatIsPublished) {
  const SensorConfig level = handheld();
  EXPECT_EQ(at_difficulty(level, 0), level);
  const Difficult far;
  const SensorConfig hardest = at_difficulty(level, 1);
  EXPECT_DOUBLE_EQ(hardest.motion_blur.exposure_ms, far.exposure_ms);
  EXPECT_DOUBLE_EQ(hardest.hurry.factor(), far.speed);
  EXPECT_DOUBLE_EQ(hardest.shot_noise.gain_at_exposure, level.shot_noise.gain_at_exposure *
                                                            far.light * far.exposure_ms /
                                                            level.motion_blur.exposure_ms);
}

TEST(Difficulty, NeverTurnsBack) {
  SensorConfig before = handheld();
  for (int i = 1; i <= 10; ++i) {
    const SensorConfig harder = at_difficulty(handheld(), 0.1 * i);
    EXPECT_GT(harder.motion_blur.exposure_ms, before.motion_blur.exposure_ms);
    EXPECT_LT(harder.shot_noise.gain_at_exposure, before.shot_noise.gain_at_exposure);
    EXPECT_GT(harder.hurry.factor(), before.hurry.factor());
    before = harder;
  }
}

TEST(Difficulty, IsAnOrdinaryLevelWhenPrinted) {
  const SensorConfig harder = at_difficulty(handheld(), 0.37);
  EXPECT_EQ(parse_sensor_config(format_sensor_config(harder), "level"), harder);
}

TEST(Difficulty, NeedsALevelThatHasItsDials) {
  for (const double outside : {-0.1, 1.01, std::nan("")})
    EXPECT_THROW(at_difficulty(handheld(), outside), InputError);
  EXPECT_THROW(at_difficulty(exact_sensors(), 0.5), InputError);
  SensorConfig gain_stays = handheld();
  gain_stays.shot_noise.gain_at_exposure = 0;
  EXPECT_THROW(at_difficulty(gain_stays, 0.5), InputError);
}

}  // namespace
}  // namespace mh
