// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>
#include <xxhash.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/pipeline/map_file.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

using testing_support::box_room_frame;
using testing_support::BoxRoom;

std::shared_ptr<const Vocabulary> vocabulary() {
  static const auto trained = testing_support::box_room_vocabulary();
  return trained;
}

SlamState start() {
  SlamConfig config = testing_support::box_room_settings();
  config.keyframe.max_interval = 6;       // so that keyframes come
  config.keyframe.redundant_share = 0.5;  // and go
  return make_slam(BoxRoom::camera(), config, vocabulary());
}

void run(SlamState& state, int first, int last) {
  for (int i = first; i < last; ++i) step(state, box_room_frame(i), RandomStream(7).fork(i));
}

/// The middle of a run, with erased keyframes and landmarks in it.
const SlamState& midway() {
  static const SlamState state = [] {
    SlamState s = start();
    run(s, 0, 60);
    return s;
  }();
  return state;
}

const std::string& midway_bytes() {
  static const std::string bytes = encode_slam(midway());
  return bytes;
}

/// What decoding says against these bytes; empty if it finds nothing wrong.
std::string complaint(const std::string& bytes) {
  try {
    decode_slam(bytes, "room.mhmap", vocabulary());
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string sealed(std::string bytes) {
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), bytes.size() - sizeof checksum);
  std::memcpy(bytes.data() + bytes.size() - sizeof checksum, &checksum, sizeof checksum);
  return bytes;
}

TEST(MapFile, LoadingChangesNothing) {
  const auto& keyframes = midway().map.keyframes();
  ASSERT_TRUE(std::any_of(keyframes.begin(), keyframes.end(), [](auto& k) { return k.erased; }))
      << "no keyframe was culled: the test does not see tombstones";
  const SlamState loaded = decode_slam(midway_bytes(), "room.mhmap", vocabulary());
  EXPECT_EQ(encode_slam(loaded), midway_bytes());
  EXPECT_EQ(loaded.map.digest(), midway().map.digest());
}

TEST(MapFile, ARunThatIsSavedAndLoadedGoesOnWithTheSameBits) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("mh_map_" + std::to_string(getpid()) + ".mhmap");
  save_slam(file, midway());
  SlamState loaded = load_slam(file, vocabulary());
  std::filesystem::remove(file);
  SlamState straight = midway();
  run(loaded, 60, 90);
  run(straight, 60, 90);
  EXPECT_NE(straight.map.digest(), midway().map.digest());
  EXPECT_EQ(encode_slam(loaded), encode_slam(straight));
}

TEST(MapFile, ALoadedMapRelocalizesAsTheOneThatWasSaved) {
  const SlamState loaded = decode_slam(midway_bytes(), "room.mhmap", vocabulary());
  Tracker a, b;
  const StepReport ra = localize(midway(), a, box_room_frame(33), RandomStream(3));
  const StepReport rb = localize(loaded, b, box_room_frame(33), RandomStream(3));
  ASSERT_EQ(ra.status, TrackStatus::kRelocalized);
  ASSERT_EQ(rb.status, TrackStatus::kRelocalized);
  EXPECT_EQ(ra.world_from_camera->translation(), rb.world_from_camera->translation());
  EXPECT_EQ(ra.candidates->c1, rb.candidates->c1);
  EXPECT_GT(ra.candidates->label_mass, 0) << "labels are not part of it";
}

TEST(MapFile, AnEmptyMapIsAMapToo) {
  const std::string bytes = encode_slam(start());
  EXPECT_EQ(encode_slam(decode_slam(bytes, "empty", vocabulary())), bytes);
}

TEST(MapFile, DigestsTellEveryPartOfAMapApart) {
  const std::uint64_t digest = midway().map.digest();
  Map map = midway().map;
  const LandmarkId standing = (*std::ranges::find(map.landmarks(), false, &Landmark::erased)).id;
  map.count_visible(standing);
  EXPECT_NE(map.digest(), digest);
  map = midway().map;
  map.set_position(standing, {0, 0, 1});
  EXPECT_NE(map.digest(), digest);
}

TEST(MapFile, SaysWhatIsWrong) {
  EXPECT_EQ(complaint("P5 a picture"), "room.mhmap: is no map of Modelhouse's");
  EXPECT_EQ(complaint(""), "room.mhmap: is no map of Modelhouse's");
  std::string other = midway_bytes();
  other[8] = 9;
  EXPECT_EQ(complaint(other), "room.mhmap: is a map of version 9, but this program reads 5");
  EXPECT_NE(complaint(midway_bytes() + "x").find("too long"), std::string::npos);
  try {
    decode_slam(midway_bytes(), "room.mhmap", testing_support::box_room_vocabulary(2));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("another vocabulary"), std::string::npos);
  }
  EXPECT_THROW(load_slam("/nowhere/room.mhmap", vocabulary()), InputError);
}

TEST(MapFile, EveryCutIsNoticed) {
  const RandomStream draws(1);
  for (std::uint64_t i = 0; i < 300; ++i) {
    // Half of them near the front, where the header is.
    const std::size_t length = draws.below(i, i % 2 ? 200 : midway_bytes().size());
    const std::string said = complaint(midway_bytes().substr(0, length));
    EXPECT_TRUE(said.find("cut short") != std::string::npos ||
                (length == 0 && said.find("no map") != std::string::npos))
        << length << ": " << said;
  }
}

TEST(MapFile, EveryFlippedBitIsNoticed) {
  const RandomStream draws(2);
  std::string bytes = midway_bytes();
  for (std::uint64_t i = 0; i < 300; ++i) {
    const std::size_t place = draws.below(2 * i, i % 4 == 0 ? 32 : bytes.size());
    const char bit = static_cast<char>(1 << draws.below(2 * i + 1, 8));
    bytes[place] ^= bit;
    EXPECT_NE(complaint(bytes), "") << "byte " << place;
    bytes[place] ^= bit;
  }
  EXPECT_EQ(complaint(bytes), "");
}

// A file that was made wrong, its checksum right: whatever it says, it is refused or it can be
// worked with. (Under -DCMAKE_BUILD_TYPE=asan this test sees reads beyond the end, too.)
TEST(MapFile, AFileThatLiesIsRefusedOrHarmless) {
  const RandomStream draws(3);
  int refused = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    std::string bytes = midway_bytes();
    const std::size_t place = 28 + draws.below(2 * i, bytes.size() - 36);
    bytes[place] = static_cast<char>(draws.bits(2 * i + 1));
    try {
      SlamState state = decode_slam(sealed(std::move(bytes)), "liar", vocabulary());
      if (i % 10 == 0) {
        run(state, 60, 61);
        Tracker lost;
        localize(state, lost, box_room_frame(20), RandomStream(1));
      }
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
  EXPECT_LT(refused, 300) << "if nothing gets through, nothing was tried";
}

}  // namespace
}  // namespace mh
