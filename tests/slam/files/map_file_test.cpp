// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <xxhash.h>

#include "slam/files/map_file.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

using testing_support::box_room_frame;
using testing_support::BoxRoom;
using testing_support::vocabulary;

SlamState start() {
  SlamConfig config = testing_support::box_room_settings();
  config.keyframe.max_interval = 6;       // so that keyframes are added
  config.keyframe.redundant_share = 0.5;  // and removed
  return make_slam(BoxRoom::camera(), config, vocabulary());
}

void run(SlamState& state, int first, int last) {
  for (int i = first; i < last; ++i) step(state, box_room_frame(i), RandomStream(7).fork(i));
}

/// The state in the middle of a run, with erased keyframes and landmarks.
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

/// The error of decoding these bytes; empty if there is none.
std::string refusal_of(const std::string& bytes) {
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

/// Writes the content of a map file independently of the code under test, so that readers in other
/// languages can be modeled on it. If it has to change, kMapFileVersion must be raised.
class Layout {
 public:
  explicit Layout(const SlamState& s)
      : Layout(s, s.map.keyframes(), {s.map.landmarks().begin(), s.map.landmarks().end()}) {}
  /// @param keyframes, landmarks  replace those of the map
  Layout(const SlamState& s, const std::vector<Keyframe>& keyframes,
         const std::vector<Landmark>& landmarks) {
    const std::string settings = format_slam_config(s.config);
    put<std::uint64_t>(settings.size());
    out_ += settings;
    put<std::int32_t>(s.camera.width_px, s.camera.height_px);
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = s.camera.distortion;
    put<double>(s.camera.fx_px, s.camera.fy_px, s.camera.cx_px, s.camera.cy_px, k1, k2, p1, p2, k3,
                k4, k5, k6, s.camera.rate_hz, s.camera.baseline_m, s.camera.disparity_sigma_px);
    put<std::uint8_t>(s.camera.disparity_sigma_is_given);
    put<std::int32_t>(s.depth_frames);
    put<std::uint64_t>(keyframes.size());
    for (const Keyframe& k : keyframes) keyframe(k);
    put<std::uint64_t>(landmarks.size());
    for (const Landmark& l : landmarks) landmark(l);
    tracker(s.tracker);
    put<std::uint8_t>(s.loop_memory.drift.has_value());
    if (s.loop_memory.drift) pose(*s.loop_memory.drift);
    put<std::uint32_t>(s.loop_memory.keyframe.value);
    put<std::int32_t>(s.loop_memory.agreeing);
    put<std::uint64_t>(s.loop_memory.places.size());
    for (const PiecePlace& place : s.loop_memory.places) {
      put<std::uint32_t>(place.origin.value, place.other.value);
      pose(place.other_from_own);
      put<std::uint32_t>(place.keyframe.value);
      put<std::int32_t>(place.agreeing);
      put<double>(place.way_m);
    }
    put<std::uint64_t>(s.tracked_frames.size());
    for (const auto& [stamp_ns, frame] : s.tracked_frames) {
      put<std::int64_t>(stamp_ns);
      put<std::uint32_t>(frame.reference.value);
      pose(frame.camera_from_reference);
    }
    put<std::uint8_t>(s.last_stamp_ns.has_value());
    if (s.last_stamp_ns) put<std::int64_t>(*s.last_stamp_ns);
  }
  const std::string& bytes() const { return out_; }

 private:
  template <class T, class... Values>
  void put(const Values&... values) {
    const auto one = [&](const T& value) {
      out_.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    (one(static_cast<T>(values)), ...);
  }
  void vector(const Eigen::Vector3d& v) { put<double>(v.x(), v.y(), v.z()); }
  void pose(const SE3& p) {  // the rotation column by column
    const Eigen::Matrix3d r = p.rotation();
    for (int column = 0; column < 3; ++column) vector(r.col(column));
    vector(p.translation());
  }
  void maybe(const std::optional<SE3>& p) {
    put<std::uint8_t>(p.has_value());
    if (p) pose(*p);
  }
  void twist(const Vector6d& v) {
    for (int i = 0; i < 6; ++i) put<double>(v[i]);
  }
  void matrix(const Matrix6d& m) {  // row by row
    for (int row = 0; row < 6; ++row) twist(m.row(row));
  }
  void features(const Features& f) {
    put<std::uint64_t>(f.keypoints.size());
    for (const Keypoint& k : f.keypoints) {
      put<float>(k.u_px, k.v_px, k.depth_m, k.angle_rad);
      put<std::int32_t>(k.octave);
      put<std::uint8_t>(k.label);
    }
    put<std::uint64_t>(f.descriptors.size());
    for (const Descriptor& d : f.descriptors) put<std::uint64_t>(d[0], d[1], d[2], d[3]);
  }
  void ids(const std::vector<LandmarkId>& list) {
    put<std::uint64_t>(list.size());
    for (const LandmarkId id : list) put<std::uint32_t>(id.value);
  }
  void members(const std::vector<WeightedMember>& list) {
    put<std::uint64_t>(list.size());
    for (const WeightedMember& m : list) {
      put<std::uint32_t>(m.id);
      put<double>(m.weight);
    }
  }
  void keyframe(const Keyframe& k) {
    put<std::uint32_t>(k.id.value, k.origin.value);
    put<std::int64_t>(k.stamp_ns);
    pose(k.camera_from_world);
    features(k.features);
    members(k.words.vector.labels);
    members(k.words.vector.words);
    put<std::uint64_t>(k.words.by_node.size());
    for (const auto& [node, feature] : k.words.by_node) put<std::uint32_t>(node, feature);
    ids(k.landmarks);
    put<std::uint64_t>(k.covisible.size());
    for (const Keyframe::Neighbor& n : k.covisible) {
      put<std::uint32_t>(n.id.value);
      put<std::int32_t>(n.shared);
    }
    put<std::uint8_t>(k.erased);
    maybe(k.odom_from_camera);
    put<std::uint32_t>(k.parent.value);
    pose(k.camera_from_parent);
  }
  void landmark(const Landmark& l) {
    put<std::uint8_t>(l.erased);
    if (l.erased) return;
    put<std::uint32_t>(l.id.value);
    vector(l.position_in_world);
    put<std::uint64_t>(l.observations.size());
    for (const Observation& o : l.observations) put<std::uint32_t>(o.keyframe.value, o.feature);
    put<std::uint64_t>(l.descriptor[0], l.descriptor[1], l.descriptor[2], l.descriptor[3]);
    put<std::uint8_t>(l.label);
    vector(l.mean_direction);
    put<double>(l.min_distance_m, l.max_distance_m);
    put<std::uint32_t>(l.first_keyframe.value);
    put<std::int32_t>(l.visible, l.found);
  }
  void tracker(const Tracker& t) {
    put<std::uint8_t>(t.last.has_value());
    if (t.last) {
      put<std::int64_t>(t.last->stamp_ns);
      pose(t.last->camera_from_world);
      features(t.last->features);
      ids(t.last->landmarks);
      maybe(t.last->odom_from_camera);
    }
    put<std::uint8_t>(t.velocity_per_s.has_value());
    if (t.velocity_per_s) twist(*t.velocity_per_s);
    put<std::uint8_t>(t.motion.has_value());
    if (t.motion) {
      twist(t.motion->velocity_per_s);
      matrix(t.motion->pose_covariance);
      matrix(t.motion->pose_velocity_covariance);
      matrix(t.motion->velocity_covariance);
    }
    put<std::uint32_t>(t.reference.value);
    put<std::int32_t>(t.frames_since_keyframe);
    put<std::uint8_t>(t.coasting);
    put<double>(t.reckoning.distance_m, t.reckoning.turn_rad);
    put<std::uint8_t>(t.inertial.has_value(), t.inertial_known.has_value());  // both are false here
    put<std::uint64_t>(t.stale_scores.of.size());
    for (const auto& [similarity, query] : t.stale_scores.of) {
      put<double>(similarity);
      put<std::int32_t>(query);
    }
    put<std::int32_t>(t.stale_scores.queries);
  }

  std::string out_;
};

/// A complete file with this content.
std::string framed(const std::string& content, std::uint32_t version = kMapFileVersion) {
  std::string bytes("MHMAP\n\0\0", 8);
  const auto append = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(version);
  append(std::uint64_t{vocabulary()->digest()});
  append(std::uint64_t{content.size()});
  bytes += content;
  append(std::uint64_t{XXH3_64bits(bytes.data(), bytes.size())});
  return bytes;
}

// One wrong value at a time, each with a correct checksum; a reference to nothing is refused, and
// the error names it.
TEST(MapFile, WhatPointsNowhereIsRefusedByItsName) {
  struct Parts {
    SlamState state;
    std::vector<Keyframe> keyframes;
    std::vector<Landmark> landmarks;
    Keyframe* standing;  ///< with words, labels and neighbors
    Keyframe* fallen;
    Landmark* seen;  ///< by two keyframes or more
  };
  const auto said = [](const std::function<void(Parts&)>& lie) {
    Parts p{midway(),
            midway().map.keyframes(),
            {midway().map.landmarks().begin(), midway().map.landmarks().end()},
            {},
            {},
            {}};
    p.standing = &*std::ranges::find_if(p.keyframes, [](const Keyframe& k) {
      return !k.erased && k.id.value > 0 && !k.covisible.empty() &&
             k.words.vector.labels.size() > 1 && k.words.by_node.size() > 1;
    });
    p.fallen = &*std::ranges::find(p.keyframes, true, &Keyframe::erased);
    p.seen = &*std::ranges::find_if(
        p.landmarks, [](const Landmark& l) { return !l.erased && l.observations.size() > 1; });
    lie(p);
    return refusal_of(framed(Layout(p.state, p.keyframes, p.landmarks).bytes()));
  };
  ASSERT_EQ(said([](Parts&) {}), "");
  const auto refuses = [&](const std::string& what, const std::function<void(Parts&)>& lie) {
    EXPECT_EQ(said(lie), "room.mhmap: is not a consistent map: " + what);
  };
  const auto no_class = static_cast<ClassId>(classes().size());
  const auto keyframes = static_cast<std::uint32_t>(midway().map.keyframes().size());
  const auto landmarks = static_cast<std::uint32_t>(midway().map.landmarks().size());
  const int levels = midway().config.features.levels;

  refuses("a keyframe's id", [](Parts& p) { ++p.standing->id.value; });
  refuses("a keyframe's origin", [=](Parts& p) { p.standing->origin.value = keyframes; });
  refuses("a keyframe's origin", [](Parts& p) { p.standing->origin = p.fallen->id; });
  refuses("a keyframe of a piece's place", [=](Parts& p) {
    p.state.loop_memory.places.push_back({KeyframeId{0}, KeyframeId{keyframes}, SE3(), {}, 1, 0});
  });
  refuses("a keyframe's place", [](Parts& p) {
    p.standing->camera_from_world =
        SE3(p.standing->camera_from_world.rotation(), Eigen::Vector3d(1e6, 0, 0));
  });
  refuses("a keypoint's octave",
          [=](Parts& p) { p.standing->features.keypoints[3].octave = levels; });
  refuses("a keypoint's octave", [](Parts& p) { p.standing->features.keypoints[3].octave = -1; });
  refuses("a keypoint's label",
          [=](Parts& p) { p.standing->features.keypoints[3].label = no_class; });
  refuses("a number is not finite",
          [](Parts& p) { p.standing->features.keypoints[3].u_px = HUGE_VALF; });
  refuses("keypoints and descriptors differ in number",
          [](Parts& p) { p.standing->features.descriptors.pop_back(); });
  refuses("the order of labels or words", [](Parts& p) {
    std::swap(p.standing->words.vector.labels[0], p.standing->words.vector.labels[1]);
  });
  refuses("the order of labels or words", [](Parts& p) {
    p.standing->words.vector.words[1].id = p.standing->words.vector.words[0].id;
  });
  refuses("the order of labels or words",
          [=](Parts& p) { p.standing->words.vector.labels.back().id = no_class; });
  refuses("the order of labels or words", [](Parts& p) {
    p.standing->words.vector.words.back().id = static_cast<std::uint32_t>(vocabulary()->size());
  });
  refuses("a word's feature", [](Parts& p) {
    p.standing->words.by_node.back().second =
        static_cast<std::uint32_t>(p.standing->features.size());
  });
  refuses("the order of words", [](Parts& p) {
    std::swap(p.standing->words.by_node.front(), p.standing->words.by_node.back());
  });
  refuses("a keyframe's number of landmarks", [](Parts& p) { p.standing->landmarks.pop_back(); });
  refuses("a keyframe's landmark", [=](Parts& p) { p.standing->landmarks[0].value = landmarks; });
  refuses("a keyframe's neighbor",
          [=](Parts& p) { p.standing->covisible[0].id.value = keyframes; });
  refuses("a keyframe's neighbor", [](Parts& p) { p.standing->covisible[0].id = p.fallen->id; });
  refuses("a keyframe's parent", [=](Parts& p) { p.fallen->parent.value = keyframes; });
  refuses("a keyframe's parent", [](Parts& p) { p.fallen->parent = p.fallen->id; });
  refuses("a landmark's id", [](Parts& p) { ++p.seen->id.value; });
  refuses("a landmark's label", [=](Parts& p) { p.seen->label = no_class; });
  refuses("a landmark's first keyframe",
          [=](Parts& p) { p.seen->first_keyframe.value = keyframes; });
  refuses("a landmark's observation",
          [=](Parts& p) { p.seen->observations.back().keyframe.value = keyframes; });
  refuses("a landmark's observation",
          [](Parts& p) { p.seen->observations[0].keyframe = p.fallen->id; });
  refuses("a landmark's observation", [](Parts& p) {
    Observation& o = p.seen->observations[0];
    o.feature = static_cast<std::uint32_t>(p.keyframes[o.keyframe.value].features.size());
  });
  refuses("the order of a landmark's observations",
          [](Parts& p) { std::swap(p.seen->observations.front(), p.seen->observations.back()); });
  refuses("the last frame's number of landmarks",
          [](Parts& p) { p.state.tracker.last->landmarks.pop_back(); });
  refuses("the last frame's landmark",
          [=](Parts& p) { p.state.tracker.last->landmarks[0].value = landmarks; });
  refuses("the reference keyframe", [=](Parts& p) { p.state.tracker.reference.value = keyframes; });
  refuses("a released score's query", [](Parts& p) {
    p.state.tracker.stale_scores = {.of = {{0.5, 2}}, .queries = 1};
  });
  refuses("the number of released scores",
          [=](Parts& p) { p.state.tracker.stale_scores.of.resize(keyframes + 1); });
  refuses("a tracked frame's keyframe",
          [=](Parts& p) { p.state.tracked_frames.begin()->second.reference.value = keyframes; });
  // Keyframes and landmarks both store which keyframe sees which landmark.
  EXPECT_NE(said([](Parts& p) { p.seen->observations.pop_back(); }), "");
  EXPECT_NE(said([](Parts& p) { p.standing->covisible.pop_back(); }), "");
  EXPECT_EQ(refusal_of(framed(Layout(midway()).bytes() + "x")),
            "room.mhmap: is not a consistent map: it has data after its end");
}

TEST(MapFile, LiesAsAnotherReaderWouldExpect) {
  SlamState state = midway();
  ASSERT_TRUE(state.tracker.last && state.tracker.velocity_per_s && state.tracker.motion &&
              state.last_stamp_ns);
  state.loop_memory = {.drift = SE3::exp((Vector6d() << 1, 2, 3, 0.4, 0.5, 0.6).finished()),
                       .keyframe = KeyframeId{1},
                       .agreeing = 1,
                       .places = {{.origin = KeyframeId{1},
                                   .other = KeyframeId{0},
                                   .other_from_own = SE3::exp(Vector6d::Constant(0.3)),
                                   .keyframe = KeyframeId{2},
                                   .agreeing = 4,
                                   .way_m = 1.25}}};
  state.tracker.stale_scores = {.of = {{0.25, 1}, {0.5, 3}}, .queries = 3};
  for (const SlamState& of : {state, start()}) {
    const std::string bytes = framed(Layout(of).bytes());
    EXPECT_TRUE(bytes == encode_slam(of))
        << "sizes " << bytes.size() << ", " << encode_slam(of).size();
  }
}

TEST(MapFile, HoldsTheEightCoefficientsOfACamera) {
  SlamState state = midway();
  state.camera.distortion = {.k1 = 0.5, .k2 = -0.1, .k4 = 0.4, .k5 = -0.05, .k6 = 0.01};
  const std::string bytes = encode_slam(state);
  EXPECT_TRUE(bytes == framed(Layout(state).bytes()));
  EXPECT_EQ(decode_slam(bytes, "rational", vocabulary()).camera, state.camera);
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
  EXPECT_EQ(refusal_of("P5 an image"), "room.mhmap: is not a Modelhouse map");
  EXPECT_EQ(refusal_of(""), "room.mhmap: is not a Modelhouse map");
  std::string other = midway_bytes();
  other[8] = 13;
  EXPECT_EQ(refusal_of(other), "room.mhmap: is a map of version 13, but this program reads 12");
  EXPECT_NE(refusal_of(midway_bytes() + "x").find("too long"), std::string::npos);
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
    // Half of the lengths are near the front, where the header is.
    const std::size_t length = draws.below(i, i % 2 ? 200 : midway_bytes().size());
    const std::string said = refusal_of(midway_bytes().substr(0, length));
    EXPECT_TRUE(said.find("truncated") != std::string::npos ||
                (length == 0 && said.find("not a Modelhouse map") != std::string::npos))
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
    EXPECT_NE(refusal_of(bytes), "") << "byte " << place;
    bytes[place] ^= bit;
  }
  EXPECT_EQ(refusal_of(bytes), "");
}

// A wrongly made file with a correct checksum: whatever it contains, it is either refused or
// usable. (With -DCMAKE_BUILD_TYPE=asan, this test also detects reads beyond the end.)
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
