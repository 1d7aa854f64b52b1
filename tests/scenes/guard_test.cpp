// SPDX-License-Identifier: Apache-2.0
#include "scenes/guard.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

using Warnings = std::vector<std::string>;

/// A scene in which no field has its default value.
Scene full_scene() {
  Scene scene{
      .name = "full",
      .positions_m = {{0, 1, 2}, {3, 4, 5}, {6, 7, 9}},
      .uvs = {{0.5F, 1}, {2, 3}, {4, 5}},
      .colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
      .light = {{1, 1, 2}, {3, 5, 8}, {13, 21, 34}},
      .triangles = {{0, 1, 2}, {2, 1, 0}},
      .material_of = {1, 0},
      .class_of = {2, 3},
      .instance_of = {7, 0},
      .materials = {{.name = "plain", .texture = {}}, {.name = "all", .texture = {}}},
      .instances =
          {{.id = 7, .class_id = 3, .name = "thing", .min_m = {1, 2, 3}, .max_m = {4, 5, 6}}},
      .lights = {{.kind = Light::Kind::kSun,
                  .position_m = {1, 2, 3},
                  .direction = {0, 1, 0},
                  .radius_m = 0.2F,
                  .angular_radius_rad = 0.3F,
                  .color = {4, 5, 6}}},
      .rooms = {{.name = "room", .polygon_m = {{0, 0}, {1, 0}, {1, 1}}}},
      .floor = {.middle_m = {1, 2, 3}, .up = {0, 0.6, 0.8}, .rough_m = 0.07, .area_m2 = 12.5}};
  Material& all = scene.materials[1];
  all.base_color = {9, 8, 7};
  Grid2d<Rgb8> texture(200, 100, {1, 2, 3});  // too large for one write to the pipe
  texture(199, 99) = {5, 6, 7};
  all.texture = texture;
  all.opacity = Grid2d<std::uint8_t>(200, 100, 130);
  all.tile_m = {2, 3};
  all.emission = {0.1F, 0.2F, 0.3F};
  all.transmission = {0.4F, 0.5F, 0.6F};
  return scene;
}

namespace fs = std::filesystem;

class Guard : public TemporaryFolder {
 protected:
  static std::string error_of_load(const std::function<Scene(Warnings*)>& load,
                                   const GuardLimits& limits = {}) {
    return error_of([&] { load_guarded("a/b.dae", nullptr, load, limits); });
  }
};

TEST_F(Guard, WhatTheChildReadIsNotedHere) {
  const auto file = write("a.txt", "a"), absent = folder_ / "b.txt";
  const auto load = [&](Warnings*) {
    read_file(file);
    is_there(absent);
    return full_scene();
  };
  const ReadScope guarded;
  load_guarded(file, nullptr, load);
  const ReadScope here;
  load(nullptr);
  EXPECT_EQ(here.record().observations.size(), 2U);
  EXPECT_EQ(guarded.record().observations.size(), 4U) << "both loads";
  EXPECT_TRUE(std::equal(here.record().observations.begin(), here.record().observations.end(),
                         guarded.record().observations.begin()));
}

TEST_F(Guard, EveryFieldOfASceneComesBack) {
  const pid_t here = getpid();
  Warnings warnings{"before"};
  const Scene scene = load_guarded("x.glb", &warnings, [&](Warnings* reported) {
    EXPECT_NE(getpid(), here);
    reported->push_back(getpid() == here ? "not in a child" : "first");
    reported->emplace_back(100'000, 'w');
    return full_scene();
  });
  EXPECT_EQ(warnings, (Warnings{"before", "first", std::string(100'000, 'w')}));
  const Scene wanted = full_scene();
  EXPECT_EQ(digest(scene), digest(wanted));
  // Fields that the digest leaves out:
  EXPECT_EQ(scene.name, wanted.name);
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[1].name, "all");
  EXPECT_EQ(scene.materials[1].tile_m, wanted.materials[1].tile_m);
  ASSERT_EQ(scene.instances.size(), 1U);
  EXPECT_EQ(scene.instances[0].name, "thing");
  EXPECT_EQ(scene.instances[0].min_m, wanted.instances[0].min_m);
  EXPECT_EQ(scene.instances[0].max_m, wanted.instances[0].max_m);
  ASSERT_EQ(scene.rooms.size(), 1U);
  EXPECT_EQ(scene.rooms[0].name, "room");
  EXPECT_EQ(scene.rooms[0].polygon_m, wanted.rooms[0].polygon_m);
  EXPECT_EQ(scene.floor.middle_m, wanted.floor.middle_m);
  EXPECT_EQ(scene.floor.up, wanted.floor.up);
  EXPECT_EQ(scene.floor.rough_m, wanted.floor.rough_m);
  EXPECT_EQ(scene.floor.area_m2, wanted.floor.area_m2);
}

TEST_F(Guard, ErrorsComeBackAsTheyWereThrown) {
  EXPECT_EQ(error_of_load([](Warnings*) -> Scene { throw InputError("b.dae:3: wrong"); }),
            "b.dae:3: wrong");
  EXPECT_THROW(load_guarded("b", nullptr, [](Warnings*) -> Scene { throw MachineError("full"); }),
               MachineError);
  EXPECT_EQ(error_of_load([](Warnings*) -> Scene { throw std::length_error("too long"); }),
            "a/b.dae: cannot be read: its reader gave up: too long");
}

TEST_F(Guard, ACrashIsOneLineWithTheFileAndTheCause) {
  const auto crash = [](Warnings*) -> Scene { std::abort(); };
  EXPECT_TRUE(names(error_of_load(crash), {"a/b.dae: ", "crashed on it", "Aborted"}));
  EXPECT_TRUE(names(error_of_load([](Warnings*) -> Scene { std::_Exit(0); }),
                    {"a/b.dae: ", "without a message"}));
}

TEST_F(Guard, TheInnermostFileIsNamed) {
  const auto within = [](Warnings* reported) {
    load_guarded("inner/good.obj", reported, [](Warnings*) { return Scene(); });
    return load_guarded("inner/bad.obj", reported, [](Warnings*) -> Scene { std::abort(); });
  };
  EXPECT_TRUE(names(error_of_load(within), {"inner/bad.obj: ", "crashed"}));
  const auto after = [](Warnings* reported) -> Scene {
    load_guarded("inner/good.obj", reported, [](Warnings*) { return Scene(); });
    std::abort();
  };
  EXPECT_TRUE(names(error_of_load(after), {"a/b.dae: ", "crashed"}));
}

TEST_F(Guard, WhoTakesTooLongIsEnded) {
  const auto works = [](Warnings*) -> Scene {
    static volatile bool on = true;
    while (on) {
    }
    return Scene();
  };
  EXPECT_TRUE(names(error_of_load(works, {.processor_s = 1}),
                    {"a/b.dae: ", "more than 1 s of processor time"}));
  const auto waits = [](Warnings*) -> Scene {
    for (;;) pause();
  };
  EXPECT_TRUE(names(error_of_load(waits, {.wall_s = 1}), {"a/b.dae: ", "more than 1 s"}));
}

#ifndef __SANITIZE_ADDRESS__
TEST_F(Guard, WhoTakesTooMuchMemoryIsEnded) {
  const auto hungry = [](Warnings*) {
    std::vector<std::vector<char>> all;
    for (;;) all.emplace_back(1 << 20, 'x');
    return Scene();
  };
  EXPECT_TRUE(names(error_of_load(hungry, {.memory_bytes = 200'000'000}),
                    {"a/b.dae: ", "needs more than 0.2 GB"}));
}

TEST_F(Guard, WhoReadsMoreMayTakeMore) {
  const fs::path file = write("large", std::string(3'000'000, 'x'));
  const auto reads = [&](Warnings*) {
    EXPECT_EQ(read_file(file).size(), 3'000'000U);
    const std::vector<char> much(150'000'000, 'x');
    struct rusage used {};
    do getrusage(RUSAGE_SELF, &used);
    while (used.ru_utime.tv_sec + used.ru_stime.tv_sec < 2);
    Scene scene;
    scene.name = std::string(1, much.back());
    return scene;
  };
  GuardLimits limits{.processor_s = 1, .processor_s_per_mb = 1.0, .memory_bytes = 100'000'000};
  EXPECT_EQ(load_guarded("x", nullptr, reads, limits).name, "x");
  limits.memory_per_byte = 1;
  EXPECT_TRUE(names(error_of_load(reads, limits), {"needs more than 0.103 GB"}));
}

TEST_F(Guard, AChildHasItsOwnStack) {
  const auto deep = [](Warnings*) {
    struct Recurse {
      static int run(int depth) {  // about 200 bytes per call
        volatile char held[128] = {};
        held[depth % 128] = 1;
        return depth == 0 ? 0 : run(depth - 1) + held[depth % 128];
      }
    };
    Scene scene;
    scene.name = std::to_string(Recurse::run(300'000));
    return scene;
  };
  EXPECT_EQ(load_guarded("x", nullptr, deep).name, "300000");
}
#endif

TEST_F(Guard, TheParentPrintsNothingTwice) {
  testing::internal::CaptureStdout();
  std::fputs("waiting", stdout);
  load_guarded("x", nullptr, [](Warnings*) {
    std::fputs("chatter", stdout);
    std::fflush(stdout);
    return Scene();
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "waiting");
}

}  // namespace
}  // namespace mh
