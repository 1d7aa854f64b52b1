// SPDX-License-Identifier: Apache-2.0
// Misbehaving outside programs, as shell scripts: each fault is one OutsideError that names the
// program, its command and what it did, and none ends the bench.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "bench/systems/child_process.hpp"
#include "bench/systems/conversation.hpp"
#include "bench/systems/outside_error.hpp"
#include "bench/systems/outside_system.hpp"
#include "bench/systems/program_folder.hpp"
#include "bench/systems/recorded_run.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "tests/bench/protocol/fake_system.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class OutsideFaults : public testing::Test {
 protected:
  OutsideFaults() : folder_(fs::temp_directory_path() / ("mh_faults_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "out");
    camera_.width_px = camera_.height_px = 2;
    camera_.cx_px = camera_.cy_px = 0.5;
  }
  ~OutsideFaults() override { fs::remove_all(folder_); }

  OutsideProgram program(OutsideMode mode, const std::string& command) const {
    OutsideProgram p{.name = "theirs", .command = command, .mode = mode};
    p.run_limit_s = p.reply_limit_s = 10;
    return p;
  }

  /// The OutsideError of an action; it must name the program and the command.
  std::string error_of(const OutsideProgram& program, const std::function<void()>& action) {
    try {
      action();
    } catch (const OutsideError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("outside program 'theirs' ("), std::string::npos) << what;
      EXPECT_NE(what.find(program.command.substr(0, 4)), std::string::npos) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what;
    } catch (const std::exception& error) {
      return std::string("another kind of error: ") + error.what();
    }
    return "no error";
  }

  /// Whether the folder of its images is a mount, which the program can neither remove nor move.
  bool keeps_folder() const {
    return read_file(folder_ / "log").find("what others have in shared memory\n") !=
           std::string::npos;
  }

  // The error in trajectory mode over three frames at 1, 2 and 3 s.
  std::string trajectory_error(OutsideProgram p) {
    return error_of(p, [&] { run(p); });
  }
  Trajectory run(const OutsideProgram& p) {
    const std::vector<Stamp> stamps = {1'000'000'000, 2'000'000'000, 3'000'000'000};
    ProgramFolder given(folder_ / "out");
    fs::create_directories(given.path() / "dataset");
    std::ofstream(given.path() / "dataset" / "rgb.txt") << "# stamp (s) file\n";
    Trajectory trajectory =
        run_on_dataset(p, given.path(), stamps, 0, folder_ / "out" / "outside.log");
    given.move_to_run();
    return trajectory;
  }
  OutsideProgram writes(const std::string& poses) const {
    return program(OutsideMode::kTrajectory, "printf '" + poses + "' > {trajectory}");
  }

  // A program in conversation mode that runs `after_hello` after the greeting, with the request in
  // $line.
  OutsideProgram says(const std::string& after_hello) const {
    return program(OutsideMode::kConversation,
                   R"(read -r line; echo '{"id":1,"protocol":1}'; read -r line; )" + after_hello);
  }
  std::string track_error(const OutsideProgram& p) {
    return error_of(p, [&] {
      const auto system = make_conversation_system(p, camera_, 0, folder_ / "log");
      system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
    });
  }
  std::string hello_error(const std::string& command) {
    const OutsideProgram p = program(OutsideMode::kConversation, command);
    return error_of(p, [&] { make_conversation_system(p, camera_, 0, folder_ / "log"); });
  }

  /// An empty folder for process ids.
  fs::path pids() const {
    fs::remove_all(folder_ / "pids");
    fs::create_directories(folder_ / "pids");
    return folder_ / "pids";
  }
  /// Number of processes with an id in that folder that do not end soon; clears the folder.
  int left_running() const {
    int left = 0, all = 0;
    for (const std::string& name : names_in(folder_ / "pids")) {
      ++all;
      left += ends_soon(std::stoi(name)) ? 0 : 1;
    }
    EXPECT_EQ(all, 4);
    pids();
    return left;
  }
  static std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.insert(entry.path().filename().string());
    return names;
  }
  static bool comes_soon(const fs::path& file) {
    for (int i = 0; i < 1000 && !fs::exists(file); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return fs::exists(file);
  }

  /// Whether a process ends within seconds; a zombie that init has yet to reap counts as ended.
  static bool ends_soon(pid_t process) {
    for (int i = 0; i < 500; ++i) {
      std::string stat;
      std::getline(std::ifstream("/proc/" + std::to_string(process) + "/stat"), stat);
      if (stat.empty() || stat.find(") Z") != std::string::npos) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  fs::path folder_;
  Camera camera_;
};

#define EXPECT_HOLDS(text, part)                                       \
  do {                                                                 \
    const std::string holds_text = text;                               \
    EXPECT_NE(holds_text.find(part), std::string::npos) << holds_text; \
  } while (false)

TEST_F(OutsideFaults, WhatTheMachineRefusesIsToldByProgramThingAndReason) {
  const fs::path log = folder_ / "nowhere" / "log";
  try {
    ChildProcess(program(OutsideMode::kTrajectory, "true"), "true", ChildProcess::Talk::kNo, log,
                 folder_);
    FAIL();
  } catch (const MachineError& error) {
    EXPECT_EQ(error.what(), "theirs: " + log.string() + ": No such file or directory");
  }
}

TEST_F(OutsideFaults, TrajectoryProgramsThatFail) {
  const auto fails = [&](const std::string& command, const std::string& part) {
    EXPECT_HOLDS(trajectory_error(program(OutsideMode::kTrajectory, command)), part);
  };
  fails("exit 3; : {trajectory}", "exited with code 3");
  fails("echo no vocabulary >&2; exit 1; : {trajectory}", "it last wrote: no vocabulary");
  fails("/nowhere/slam {trajectory}", "exited with code 127");
  fails("kill -SEGV $$; : {trajectory}", "was killed by signal 11");
  fails("exit 0; : {trajectory}", "ended well but wrote no trajectory");
  OutsideProgram elsewhere = writes("");
  elsewhere.folder = "/nowhere";
  EXPECT_HOLDS(trajectory_error(elsewhere), "its folder cannot be entered");
}

TEST_F(OutsideFaults, AFailureReadsTheSameInAnyFolder) {
  const std::string dataset = trajectory_error(
      program(OutsideMode::kTrajectory,
              "echo cannot open {trajectory} in $(dirname {trajectory}) >&2; exit 1"));
  EXPECT_HOLDS(dataset, "(echo cannot open {trajectory} in");
  EXPECT_HOLDS(dataset, "it last wrote: cannot open trajectory.txt in .");
  EXPECT_EQ(trajectory_error(writes("what is this\\n")).find(folder_.string()), std::string::npos);
  // Images are in a folder with a random name.
  const std::string image =
      track_error(says(R"(echo "$line" | sed 's/.*"color":"//; s/".*//' >&2; exit 1)"));
  EXPECT_HOLDS(image, "it last wrote: color.ppm");
}

TEST_F(OutsideFaults, ATrajectoryThatIsNone) {
  EXPECT_HOLDS(trajectory_error(writes("what is this\\n")), "trajectory.txt: contains no poses");
  EXPECT_HOLDS(trajectory_error(writes("1 0 0 0 0 0 0 1\\n2 nan 0 0 0 0 0 1\\n")),
               "trajectory.txt:2: tx: 'nan' is not finite");
  EXPECT_HOLDS(trajectory_error(writes("1 0 0 0 0 0 0 1\\n2.5 0 0 0 0 0 0 1\\n")),
               "wrote 1 of 2 poses at stamps that match no frame, the first at 2.500000000");
  EXPECT_HOLDS(trajectory_error(writes("2.9995 0 0 0 0 0 0 1\\n3 0 0 0 0 0 0 1\\n")),
               "wrote two poses for the frame at 3.000000000");
  EXPECT_HOLDS(trajectory_error(writes("1 0 0 0 0 0 0 1\\n2 0 -1e200 0 0 0 0 1\\n")),
               "trajectory.txt:2: position: lies 1e+200 m from the origin");
}

TEST_F(OutsideFaults, StampsOfFewDigitsAreTheFramesOwn) {
  const Trajectory trajectory = run(writes("1.0001 0 0 0 0 0 0 1\\n2.9995 5 0 0 0 0 0 1\\n"));
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].stamp_ns, 1'000'000'000);
  EXPECT_EQ(trajectory[1].stamp_ns, 3'000'000'000);
  EXPECT_EQ(trajectory[1].world_from_camera.translation().x(), 5.0);
}

TEST_F(OutsideFaults, AProgramThatTrackedNothingHasAnEmptyTrajectory) {
  EXPECT_TRUE(run(writes("# nothing held\\n")).empty());
}

TEST_F(OutsideFaults, ATrajectoryOfAnOlderRunIsNotTakenForThisOne) {
  EXPECT_EQ(run(writes("1 0 0 0 0 0 0 1\\n")).size(), 1u);
  EXPECT_HOLDS(trajectory_error(program(OutsideMode::kTrajectory, "exit 0; : {trajectory}")),
               "wrote no trajectory");
}

TEST_F(OutsideFaults, TimeAndMemoryAreLimited) {
  OutsideProgram sleeper = program(OutsideMode::kTrajectory, "sleep 60; : {trajectory}");
  sleeper.run_limit_s = 0.3;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_HOLDS(trajectory_error(sleeper), "was still running after 0.3 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));

  // tail keeps its input's last line in memory, and this line never ends.
  OutsideProgram glutton = program(OutsideMode::kTrajectory, "tail /dev/zero; : {trajectory}");
  glutton.memory_limit_mb = 50;
  EXPECT_HOLDS(trajectory_error(glutton), "its limit is 50 MB");
}

/// Starts processes that ignore SIGTERM, in several sessions, some of them with parents that have
/// exited; each writes its id into the folder PIDS. Waits until all of them run.
const std::string kEscapes =
    "sleeper='trap \"\" TERM HUP INT; echo $$ > $PIDS/$$; while :; do sleep 60; done'; "
    "sh -c \"$sleeper\" & setsid sh -c \"$sleeper\" & (setsid sh -c \"$sleeper\" &) ; "
    "(setsid sh -c \"(setsid sh -c '$sleeper' &) ; exit 0\" &) ; "
    "while [ $(ls $PIDS | wc -l) -lt 4 ]; do sleep 0.02; done";

TEST_F(OutsideFaults, WhatAProgramLeavesBehindIsEndedToo) {
  const std::string start = "export PIDS=" + pids().string() + "; " + kEscapes;
  run(program(OutsideMode::kTrajectory, start + "; echo 1 0 0 0 0 0 0 1 > {trajectory}"));
  EXPECT_EQ(left_running(), 0);
  EXPECT_HOLDS(
      trajectory_error(program(OutsideMode::kTrajectory, start + "; exit 3; {trajectory}")),
      "exited with code 3");
  EXPECT_EQ(left_running(), 0);
  OutsideProgram slow = program(OutsideMode::kTrajectory, start + "; sleep 60; : {trajectory}");
  slow.run_limit_s = 1.5;
  EXPECT_HOLDS(trajectory_error(slow), "was still running after 1.5 s");
  EXPECT_EQ(left_running(), 0);
  EXPECT_HOLDS(track_error(says(start + "; exit 3")), "exited with code 3 during track");
  EXPECT_EQ(left_running(), 0);
}

TEST_F(OutsideFaults, ABenchThatIsKilledLeavesNothingRunning) {
  const fs::path scratch = folder_ / "scratch";
  fs::create_directories(scratch / "sub");
  pids();
  const pid_t bench = fork();
  if (bench == 0) {
    const std::string command = "export PIDS=" + (folder_ / "pids").string() + "; " + kEscapes +
                                "; touch " + (folder_ / "all").string() + "; sleep 60";
    ChildProcess child(program(OutsideMode::kTrajectory, command), command, ChildProcess::Talk::kNo,
                       folder_ / "log", scratch);
    pause();
    _exit(0);
  }
  EXPECT_TRUE(comes_soon(folder_ / "all"));
  kill(bench, SIGKILL);
  waitpid(bench, nullptr, 0);
  EXPECT_EQ(left_running(), 0);
  for (int i = 0; i < 500 && fs::exists(scratch); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(fs::exists(scratch));
}

TEST_F(OutsideFaults, MemoryOfASessionOfItsOwnCounts) {
  OutsideProgram glutton =
      program(OutsideMode::kTrajectory, "setsid tail /dev/zero & sleep 60; : {trajectory}");
  glutton.memory_limit_mb = 50;
  EXPECT_HOLDS(trajectory_error(glutton), "its limit is 50 MB");
}

TEST_F(OutsideFaults, AProgramThatKillsItsWatcherFails) {
  EXPECT_HOLDS(trajectory_error(
                   program(OutsideMode::kTrajectory, "kill -9 $PPID; sleep 60; : {trajectory}")),
               "was lost: the process that watched it was killed");
}

TEST_F(OutsideFaults, AProgramThatStopsItsWatcherIsEndedInTime) {
  const auto start = std::chrono::steady_clock::now();
  OutsideProgram stopping = says("kill -STOP $PPID; sleep 60");
  stopping.reply_limit_s = 0.3;
  EXPECT_HOLDS(track_error(stopping), "did not reply to track (request 2) within 0.3 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

// If the program removes the folder of its images, the next image cannot be written, which must not
// be reported as a full disk.
TEST_F(OutsideFaults, AProgramThatRemovesTheFolderOfItsImagesFailsUnlessItCannot) {
  const OutsideProgram p = says(
      R"sh(rm -rf "$(dirname "$(echo "$line" | sed 's/.*"color":"//; s/".*//')")"; )sh"
      R"(echo '{"id":2,"pose":null}'; read -r line; echo '{"id":3,"pose":null}'; read -r line)");
  const auto system = make_conversation_system(p, camera_, 0, folder_ / "log");
  const std::string error = error_of(p, [&] {
    for (std::uint64_t i = 0; i < 2; ++i)
      system->track(fake_frame(i, RandomStream(i)), RandomStream(i));
  });
  if (keeps_folder())
    EXPECT_EQ(error, "no error");
  else
    EXPECT_HOLDS(error, "removed the folder of its images");
}

/// Replies to a track request after doing something with $color, its image file.
std::string with_image(const std::string& work) {
  return R"sh(color=$(echo "$line" | sed 's/.*"color":"//; s/".*//'); folder=$(dirname "$color"); )sh" +
         work +
         R"(; echo '{"id":2,"pose":null}'; read -r line; echo '{"id":3,"pose":null}'; )"
         R"(read -r line)";
}

TEST_F(OutsideFaults, NothingThatAProgramPutsInThePlaceOfAnImageIsOpened) {
  const fs::path mine = folder_ / "mine";
  const auto after = [&](const std::string& work) {
    std::ofstream(mine) << "mine";
    const fs::path note = folder_ / "scratch";
    const OutsideProgram p = says(with_image("echo $folder > " + note.string() + "; " + work));
    const std::string error = error_of(p, [&] {
      const auto system = make_conversation_system(p, camera_, 0, folder_ / "log");
      for (std::uint64_t i = 0; i < 2; ++i)
        system->track(fake_frame(i, RandomStream(i)), RandomStream(i));
    });
    EXPECT_EQ(read_file(mine), "mine") << work;
    std::string scratch = read_file(note);
    scratch.pop_back();
    for (const char* moved : {"", ".moved"})
      EXPECT_FALSE(fs::exists(fs::symlink_status(scratch + moved))) << scratch + moved << work;
    return error;
  };
  EXPECT_HOLDS(after("rm $color; mkdir $color"), "replaced its color.ppm with a folder");
  EXPECT_EQ(after("rm $color"), "no error");
  EXPECT_EQ(after("rm $color; mkfifo $color"), "no error");
  EXPECT_EQ(after("ln -sf " + mine.string() + " $color"), "no error");
  EXPECT_EQ(after("ln -f " + mine.string() + " $color || cp " + mine.string() + " $color"),
            "no error");
  EXPECT_EQ(after("chmod 0 $color; mkdir -p $folder/a/b; chmod 0 $folder/a"), "no error");
  for (const char* move :
       {"mv $folder $folder.moved", "mv $folder $folder.moved; ln -s $folder.moved $folder"}) {
    const std::string error = after(move);
    if (keeps_folder())
      EXPECT_EQ(error, "no error");
    else
      EXPECT_HOLDS(error, "removed the folder of its images");
  }
  if (geteuid() != 0) {
    EXPECT_HOLDS(after("chmod 555 $folder"), "left its color.ppm unwritable: Permission denied");
  }
}

TEST_F(OutsideFaults, RepliesOfAnyShapeCostLittle) {
  const auto start = std::chrono::steady_clock::now();
  const auto brackets = [](const std::string& key, char open, char close) {
    const auto many = [](char c) {
      return std::string("head -c 100000 /dev/zero | tr '\\0' '") + c + "'; ";
    };
    return "printf '{\"id\":2,\"" + key + "\":'; " + many(open) + many(close) +
           "echo '}'; sleep 60";
  };
  for (const char* key : {"pose", "error", "what", "stage", "candidates"})
    EXPECT_HOLDS(track_error(says(brackets(key, '[', ']'))),
                 "nested its reply more than 200 levels deep: '{\"id\":2,");
  EXPECT_HOLDS(track_error(says(brackets("pose", '{', '}'))), "nested its reply");
  EXPECT_HOLDS(track_error(says(R"sh((printf '{"id":2,"pose":null'; seq 1 200000 | )sh"
                                R"sh(sed 's/.*/,"k&":0/' | tr -d '\n'; echo '}'); sleep 60)sh")),
               "gave an unknown key 'k1'");
  EXPECT_HOLDS(track_error(says("head -c 100000000 /dev/zero | tr '\\0' 'a'; sleep 60")),
               "with a line of more than 16 MB");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST_F(OutsideFaults, AKeyframeHasAPose) {
  EXPECT_HOLDS(track_error(says(R"(echo '{"id":2,"pose":null,"keyframe":true}'; sleep 60)")),
               "gave a keyframe without a pose");
}

TEST_F(OutsideFaults, ATrajectoryIsAFileOfItsFolderOfABearableSize) {
  const fs::path truth = folder_ / "truth.tum";
  std::ofstream(truth) << "1 0 0 0 0 0 0 1\n";
  const auto error = [&](const std::string& command) {
    return trajectory_error(
        program(OutsideMode::kTrajectory, "cd $(dirname {trajectory}); " + command));
  };
  EXPECT_HOLDS(error("ln -s " + truth.string() + " {trajectory}"),
               "made its trajectory a link to outside its folder");
  EXPECT_HOLDS(error("mv $PWD $PWD.moved; mkdir elsewhere; ln -s " + truth.string() +
                     " elsewhere/trajectory.txt; ln -s $PWD.moved/elsewhere $PWD"),
               "made its trajectory a link to outside its folder");
  EXPECT_EQ(run(program(OutsideMode::kTrajectory,
                        "cd $(dirname {trajectory}); "
                        "echo 1 0 0 0 0 0 0 1 > mine; "
                        "ln -s mine {trajectory}"))
                .size(),
            1u);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_HOLDS(error("truncate -s 3900M {trajectory}"),
               "wrote a trajectory of 3900 MB, 64 MB is the most");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_HOLDS(error("mkfifo {trajectory}"), "it is not a file");
  EXPECT_HOLDS(error("mkdir {trajectory}"), "it is a folder");
  EXPECT_HOLDS(error("ln -s trajectory.txt {trajectory}"), "wrote no trajectory");
  const std::string endless =
      error("head -c 30000000 /dev/zero | tr '\\0' 'a' > {trajectory}; echo >> {trajectory}");
  EXPECT_HOLDS(endless, "trajectory.txt: contains no poses");
  EXPECT_LT(error("printf '1 ' > {trajectory}; head -c 3000000 /dev/zero | tr '\\0' 'a' >> "
                  "{trajectory}; echo ' 0 0 0 0 0 1' >> {trajectory}")
                .size(),
            1200u);
}

TEST_F(OutsideFaults, NothingIsWrittenThroughALinkOfAProgram) {
  const fs::path mine = folder_ / "mine";
  std::ofstream(mine) << "mine";
  fs::create_symlink(mine, folder_ / "out" / "outside.log");
  run(program(OutsideMode::kTrajectory,
              "cd $(dirname {trajectory}); echo 1 0 0 0 0 0 0 1 > {trajectory}; ln -s " +
                  mine.string() + " .modelhouse-files; echo said"));
  EXPECT_EQ(read_file(mine), "mine");
  EXPECT_EQ(read_file(folder_ / "out" / "outside.log"), "said\n");
  EXPECT_HOLDS(read_file(folder_ / "out" / "outside" / ProgramFolder::kList), "trajectory.txt\n");
  // A folder with the name of the list of files, and folders without write permission, are also
  // replaced by the next run.
  const std::string locks =
      "cd $(dirname {trajectory}); echo 1 0 0 0 0 0 0 1 > {trajectory}; mkdir -p "
      ".modelhouse-files/a b; touch b/c; chmod 500 b; chmod 500 .";
  for (int times = 0; times < 2; ++times) run(program(OutsideMode::kTrajectory, locks));
  EXPECT_EQ(names_in(folder_ / "out"), (std::set<std::string>{"outside", "outside.log"}));
}

TEST_F(OutsideFaults, ALogThatAProgramReplacesBlocksNobody) {
  EXPECT_HOLDS(trajectory_error(program(
                   OutsideMode::kTrajectory,
                   "echo first words >&2; rm " + (folder_ / "out" / "outside.log").string() +
                       "; mkfifo " + (folder_ / "out" / "outside.log").string() +
                       "; printf 'last \\377 words' >&2; exit 3; : {trajectory}")),
               "exited with code 3; it last wrote: last ? words");
}

// If this machine allows no mount namespace, the log says so, and the program sees everything.
TEST_F(OutsideFaults, AProgramDoesNotSeeWhatIsHiddenFromIt) {
  const fs::path secret = folder_ / "secret", other = folder_ / "other.yaml";
  fs::create_directories(secret / "run");
  fs::create_directories(folder_ / "suite");
  std::ofstream(secret / "run" / "truth.tum") << "the truth";
  std::ofstream(other) << "the truth";
  std::ofstream(folder_ / "suite" / "own") << "its own";
  const auto look = [&](std::vector<fs::path> hidden) {
    OutsideProgram p =
        program(OutsideMode::kTrajectory,
                "cd .; grep -rs . ../secret ../other.yaml own; touch ../secret/x ../new "
                "/tmp/mh_new 2>/dev/null; "
                "rm -f /tmp/mh_new; umount " +
                    secret.string() + " 2>/dev/null; echo 1 0 0 0 0 0 0 1 > {trajectory}");
    p.folder = folder_ / "suite";
    p.hidden = std::move(hidden);
    EXPECT_EQ(run(p).size(), 1u);
    return read_file(folder_ / "out" / "outside.log");
  };
  EXPECT_HOLDS(look({}), "the truth");
  ASSERT_TRUE(fs::remove(secret / "x")) << "nothing was hidden";
  const std::string log = look({secret, other, folder_ / "nowhere", secret / "run"});
  if (log.starts_with("modelhouse: nothing is hidden from the program: no mount namespace here: "))
    GTEST_SKIP() << log;
  EXPECT_TRUE(log.starts_with(
      "modelhouse: hidden from the program by a mount namespace: " + secret.string() +
      ", 1 file of the recording or scene, what others have in shared memory\n"))
      << log;
  EXPECT_EQ(log.find("the truth"), std::string::npos) << log;
  EXPECT_HOLDS(log, "own:its own");
  EXPECT_TRUE(fs::exists(folder_ / "new")) << "it may write elsewhere";
  EXPECT_FALSE(fs::exists(secret / "x"));
  EXPECT_EQ(read_file(other), "the truth");
  const std::string inside = look({folder_, secret});
  EXPECT_HOLDS(inside,
               "; not hidden, since the program's own files are there: " + folder_.string() + "\n");
  EXPECT_EQ(inside.find("truth.tum:"), std::string::npos) << inside;
}

TEST_F(OutsideFaults, AConversationSeesNoOthersImages) {
  const fs::path others = "/dev/shm/mh_of_another_" + std::to_string(getpid());
  std::ofstream(others) << "an image";
  const fs::path log = folder_ / "out" / "outside.log";
  const OutsideProgram p =
      program(OutsideMode::kConversation,
              "ls /dev/shm >&2; cat /dev/shm/*/settings.yaml >&2; touch /dev/shm/left; echo gone");
  error_of(p, [&] { make_conversation_system(p, camera_, 0, log); });
  fs::remove(others);
  const std::string said = read_file(log);
  if (said.starts_with("modelhouse: nothing is hidden")) GTEST_SKIP() << said;
  EXPECT_EQ(said.find("mh_of_another"), std::string::npos) << said;
  EXPECT_HOLDS(said, "modelhouse-");  // its own folder, which contains its inputs
  EXPECT_HOLDS(said, "Camera.fx");
  EXPECT_FALSE(fs::exists("/dev/shm/left"));
}

TEST_F(OutsideFaults, SharedMemoryHoldsNoMoreThanAProgramMayUse) {
  OutsideProgram p = program(OutsideMode::kConversation,
                             "head -c 150000000 /dev/zero >/dev/shm/fill; ls -s /dev/shm >&2");
  p.memory_limit_mb = 100;
  const fs::path log = folder_ / "out" / "outside.log";
  error_of(p, [&] { make_conversation_system(p, camera_, 0, log); });
  const std::string said = read_file(log);
  if (said.starts_with("modelhouse: nothing is hidden")) GTEST_SKIP() << said;
  EXPECT_HOLDS(said, "No space left on device");
}

/// Records the timestamps of the frames that it is shown.
class NotesStamps : public OutsideSystem {
 public:
  mutable std::vector<Stamp> stamps_ns;
  void rewind() override {}

 protected:
  SystemReport ask(Question, std::uint64_t, const RgbdFrame& frame, RandomStream) const override {
    stamps_ns.push_back(frame.stamp_ns);
    SystemReport report;
    report.world_from_camera = SE3();
    return report;
  }
  void forget() override {}
  std::optional<Trajectory> end_mapping() override { return std::nullopt; }
  void fail(const std::string& what) const override { throw OutsideError(what); }
};

// A held-out frame's own timestamp lies between those of mapped frames and would reveal where it
// was taken.
TEST(OutsideSessions, BeginAfterTheMappingAndKeepTheirPace) {
  NotesStamps system;
  RgbdFrame frame;
  frame.color = Grid2d<Rgb8>(2, 2);
  frame.depth_m = Grid2d<float>(2, 2, 1.0F);
  const auto at = [&](Stamp stamp_ns) {
    frame.stamp_ns = stamp_ns;
    return frame;
  };
  for (const Stamp stamp_ns : {10, 30, 40}) system.track(at(stamp_ns), RandomStream(1));
  system.freeze();
  for (int session = 0; session < 2; ++session) {
    const auto opened = system.open_session();
    for (const Stamp stamp_ns : {20, 20, 25}) opened->feed(at(stamp_ns), RandomStream(1));
  }
  const Stamp later = 1'000'000'040;
  EXPECT_EQ(system.stamps_ns,
            (std::vector<Stamp>{10, 30, 40, later, later, later + 5, later, later, later + 5}));
}

TEST_F(OutsideFaults, WhatAProgramIsToldLiesBelowNoResults) {
  run(program(OutsideMode::kTrajectory,
              "dirname {trajectory}; echo 1 0 0 0 0 0 0 1 > {trajectory}"));
  const std::string told = read_file(folder_ / "out" / "outside.log");
  EXPECT_NE(told.substr(0, folder_.string().size()), folder_.string()) << told;
}

TEST_F(OutsideFaults, WhatIsSaidIsBounded) {
  const auto start = std::chrono::steady_clock::now();
  // The program would write 3 GB if it could.
  EXPECT_HOLDS(trajectory_error(program(OutsideMode::kTrajectory,
                                        "yes 'all is well' | head -c 3000000000; : {trajectory}")),
               "wrote more than 64 MB to its log, the limit");
  EXPECT_LT(fs::file_size(folder_ / "out" / "outside.log"), std::uintmax_t{65} << 20);
  EXPECT_HOLDS(read_file(folder_ / "out" / "outside.log"), "wrote too much and was stopped");
  EXPECT_HOLDS(track_error(says("yes >&2")), "wrote more than 64 MB to its log, the limit");
  EXPECT_LT(fs::file_size(folder_ / "log"), std::uintmax_t{65} << 20);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(120));
  // A shorter log is kept to the last byte, including what was written just before the program's
  // end.
  run(program(OutsideMode::kTrajectory,
              "yes 1234567 | head -c 8000000; echo 1 0 0 0 0 0 0 1 > {trajectory}"));
  EXPECT_EQ(fs::file_size(folder_ / "out" / "outside.log"), 8000000u);
}

TEST_F(OutsideFaults, WhatIsWrittenIsBounded) {
  const auto writes_much = [&](const std::string& command) {
    OutsideProgram p = program(OutsideMode::kTrajectory, "cd $(dirname {trajectory}); " + command);
    p.disk_limit_mb = 5;
    return trajectory_error(p);
  };
  EXPECT_HOLDS(writes_much("exec head -c 8000000 /dev/zero > map"),
               "wrote a file of more than 5 MB, its limit");
  EXPECT_LE(fs::file_size(folder_ / "out" / "outside" / "map"), 5u << 20);
  EXPECT_HOLDS(writes_much("sh -c 'head -c 8000000 /dev/zero > map'"),
               "wrote a file of more than 5 MB, its limit");
  EXPECT_HOLDS(writes_much("for i in 1 2 3 4; do head -c 4000000 /dev/zero > $i; done; sleep 60"),
               "MB into its folder during its run, its limit is 5 MB");
}

TEST_F(OutsideFaults, ARunMeetsNothingOfAnEarlierOne) {
  const fs::path out = folder_ / "out", kept = out / "outside";
  const std::string look =
      "find $(dirname {trajectory}) $(dirname $(dirname {trajectory})); touch $(dirname "
      "{trajectory})/map.bin $(dirname {trajectory})/edited; echo 1 0 0 0 0 0 0 1 > {trajectory}";
  const auto look_about = [&] {
    run(program(OutsideMode::kTrajectory, look));
    return read_file(out / "outside.log");
  };
  std::ofstream(out / "truth.tum") << "the truth of an earlier run";
  const std::string first = look_about();
  EXPECT_HOLDS(first, "dataset/rgb.txt");
  EXPECT_EQ(first.find("truth"), std::string::npos) << first;
  const std::set<std::string> all = {"dataset", "edited", "map.bin", "trajectory.txt",
                                     ProgramFolder::kList};
  EXPECT_EQ(names_in(kept), all);
  // The second run does not see the first run's files, and its own files replace them.
  std::ofstream(kept / "trajectory.txt", std::ios::app) << "# read by hand\n";
  fs::remove(kept / "trajectory.txt");
  const std::string second = look_about();
  EXPECT_EQ(second.find("map.bin"), std::string::npos) << second;
  EXPECT_EQ(names_in(kept), all);
  EXPECT_EQ(names_in(out), (std::set<std::string>{"outside", "outside.log", "truth.tum"}));
  // Files that the program did not make stay where they are, and so do files that a user changed.
  const fs::path elsewhere = folder_ / "elsewhere";
  fs::create_directory(elsewhere);
  for (const char* file : {"map.bin", "rgb.txt", "photograph.jpg"})
    std::ofstream(elsewhere / file) << "mine";
  std::ofstream(kept / "notes.txt") << "mine";
  std::ofstream(kept / "edited") << "mine";
  fs::remove_all(kept / "dataset");
  fs::create_directory_symlink(elsewhere, kept / "dataset");
  std::ofstream(kept / ProgramFolder::kList, std::ios::app)
      << "4 0 ../../elsewhere/map.bin\n../../elsewhere/\n";
  look_about();
  EXPECT_EQ(names_in(kept), (std::set<std::string>{"dataset", "edited", "notes.txt"}));
  EXPECT_EQ(read_file(kept / "edited"), "mine");
  EXPECT_EQ(names_in(elsewhere), (std::set<std::string>{"map.bin", "photograph.jpg", "rgb.txt"}));
  EXPECT_EQ(names_in(out / "outside.2"), all);
  look_about();
  EXPECT_EQ(names_in(out / "outside.2"), all);
  EXPECT_FALSE(fs::exists(out / "outside.3"));
}

TEST_F(OutsideFaults, AConversationIsGivenTimeToEndWell) {
  const auto farewell = [&](const std::string& last_words) {
    const OutsideProgram p =
        program(OutsideMode::kConversation, R"(read -r line; echo '{"id":1,"protocol":1}'; )"
                                            "read -r line; sleep 0.2; " +
                                                last_words);
    return error_of(p, [&] { make_conversation_system(p, camera_, 0, folder_ / "log")->finish(); });
  };
  const fs::path note = folder_ / "saved";
  EXPECT_EQ(farewell("touch " + note.string()), "no error");
  EXPECT_TRUE(fs::exists(note)) << "it had no time to save its map";
  EXPECT_HOLDS(farewell("echo no room >&2; exit 3"),
               "exited with code 3 after its input was closed; it last wrote: no room");
  EXPECT_HOLDS(farewell("kill -SEGV $$"), "was killed by signal 11 after its input");
}

TEST_F(OutsideFaults, ConversationsThatDoNotBegin) {
  EXPECT_HOLDS(hello_error("exit 4"), "exited with code 4");
  EXPECT_HOLDS(hello_error("echo Welcome to my SLAM; sleep 60"),
               "wrote something that is not a line of JSON: 'Welcome to my SLAM', replying to "
               "hello (request 1)");
  EXPECT_HOLDS(hello_error(R"(printf '{"id":1,"protocol":1}\0\n'; sleep 60)"),
               "wrote something that is not a line of JSON");
  EXPECT_HOLDS(hello_error(R"(echo '{"id":1}'; sleep 60)"), "named no \"protocol\": expected 1");
  EXPECT_HOLDS(hello_error(R"(echo '{"id":1,"protocol":2}'; sleep 60)"),
               "speaks protocol 2, not 1");
  EXPECT_HOLDS(hello_error(R"(echo '[1]'; sleep 60)"), "wrote no JSON object");
}

TEST_F(OutsideFaults, ConversationsThatBreakOff) {
  EXPECT_HOLDS(track_error(says("exit 3")), "exited with code 3 during track (request 2)");
  EXPECT_HOLDS(track_error(says("echo out of luck >&2; exit 3")), "it last wrote: out of luck");
  EXPECT_HOLDS(track_error(says("kill -9 $$")), "was killed by signal 9 during track");
  EXPECT_HOLDS(track_error(says("exec >&-; sleep 60")), "closed its pipe during track");
  OutsideProgram silent = says("sleep 60");
  silent.reply_limit_s = 0.3;
  EXPECT_HOLDS(track_error(silent), "did not reply to track (request 2) within 0.3 s");
  // The program exits before the first question: writing to it must not kill the bench by SIGPIPE.
  const OutsideProgram short_lived =
      program(OutsideMode::kConversation, R"(read -r line; echo '{"id":1,"protocol":1}'; exit 0)");
  EXPECT_HOLDS(track_error(short_lived), "exited with code 0");
}

TEST_F(OutsideFaults, AnswersThatAreNone) {
  const auto replies = [&](const std::string& json) {
    return track_error(says("echo '" + json + "'; sleep 60"));
  };
  EXPECT_HOLDS(replies("garbage"), "wrote something that is not a line of JSON: 'garbage'");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[NaN,0,0,0,0,0,1]})"), "a number that is not finite");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[1e999,0,0,0,0,0,1]})"), "a number that is too large");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[null,0,0,0,0,0,1]})"),
               "pose that does not consist of numbers");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[0,0,0,0,0,0,"1"]})"),
               "pose that does not consist of numbers");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[0,-1e9,0,0,0,0,1]})"), "a pose more than 1e+08 m away");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[0,0,0,0,0,0]})"), "expected [x, y, z, qx, qy, qz, qw]");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[0,0,0,0,0,0,2]})"), "quaternion has norm 2");
  EXPECT_HOLDS(replies(R"({"id":2})"), "neither a pose nor");
  EXPECT_HOLDS(replies(R"({"id":3,"pose":null})"), "replied to request 3, which was not sent");
  EXPECT_HOLDS(replies(R"({"pose":null})"), "gave no request number");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"mood":"good"})"), "unknown key 'mood'");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"inliers":-1})"), "expected a count");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"keypoints":5,"inliers":50})"),
               "gave 50 inliers of 5 keypoints");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"map_reset":1})"), "gave a map_reset of 1");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"candidates":{"c4":1}})"), "'candidates.c4'");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"candidates":{"keyframes":3,"final":9}})"),
               "a step cannot leave more than the one before it");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"stage":"lunch"})"), "unknown stage");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":[0,0,0,0,0,0,1],"stage":"no_candidate"})"),
               "gave a pose and the stage \"no_candidate\"");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"stage":"verified"})"),
               "gave the stage \"verified\" without a pose");
  EXPECT_HOLDS(replies(R"({"id":2,"pose":null,"pose":[0,0,0,0,0,0,1]})"), "the key 'pose' twice");
  EXPECT_HOLDS(replies(R"({"id":2,"error":"no memory"})"), "reported an error: \"no memory\"");
}

TEST_F(OutsideFaults, AFinalTrajectoryHoldsShownFramesOnly) {
  const auto freeze_error = [&](const std::string& trajectory) {
    const OutsideProgram p = says(
        R"(echo '{"id":2,"pose":[0,0,0,0,0,0,1]}'; read -r line; echo '{"id":3,"trajectory":)" +
        trajectory + "}'; sleep 60");
    return error_of(p, [&] {
      const auto system = make_conversation_system(p, camera_, 0, folder_ / "log");
      system->track(fake_frame(7, RandomStream(1)), RandomStream(2));
      system->freeze();
      const Trajectory t = system->trajectory();
      ASSERT_EQ(t.size(), 1u);
      EXPECT_EQ(t[0].stamp_ns, 7);
      EXPECT_EQ(t[0].world_from_camera.translation().x(), 4.0);
    });
  };
  EXPECT_EQ(freeze_error(R"(["0.000000007 4 0 0 0 0 0 1"])"), "no error");
  EXPECT_HOLDS(freeze_error(R"(["0.000000008 4 0 0 0 0 0 1"])"),
               "gave a pose at 0.000000008 in its trajectory, a frame that it never saw");
  EXPECT_HOLDS(freeze_error(R"(["0.000000007 nan 0 0 0 0 0 1"])"), "trajectory:1: tx: 'nan'");
  EXPECT_HOLDS(freeze_error(R"(["0.000000007 4e30 0 0 0 0 0 1"])"),
               "trajectory:1: position: lies 4e+30 m from the origin");
  EXPECT_HOLDS(freeze_error("7"), "not a list of lines");
}

TEST_F(OutsideFaults, PosesInAMapThatWasGivenUpAreVoid) {
  const OutsideProgram p =
      says(R"(echo '{"id":2,"pose":[1,0,0,0,0,0,1]}'; read -r line; )"
           R"(echo '{"id":3,"pose":[0,0,0,0,0,0,1],"map_reset":true}'; read -r line; )"
           R"(echo '{"id":4}'; read -r line; )"
           R"(echo '{"id":5,"pose":[0,0,0,0,0,0,1],"map_reset":true}'; sleep 60)");
  const auto system = make_conversation_system(p, camera_, 0, folder_ / "log");
  EXPECT_FALSE(system->track(fake_frame(7, RandomStream(1)), RandomStream(2)).map_reset);
  EXPECT_TRUE(system->track(fake_frame(8, RandomStream(1)), RandomStream(2)).map_reset);
  const Trajectory t = system->trajectory();
  ASSERT_EQ(t.size(), 1u);
  EXPECT_EQ(t[0].stamp_ns, 8);
  system->freeze();
  const auto session = system->open_session();
  EXPECT_HOLDS(error_of(p, [&] { session->feed(fake_frame(9, RandomStream(1)), RandomStream(2)); }),
               "dropped a map that must not change any more");
}

TEST_F(OutsideFaults, CommandsAreCheckedBeforeTheyRun) {
  const auto refused = [&](OutsideMode mode, const std::string& command) -> std::string {
    try {
      validate(program(mode, command));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_HOLDS(refused(OutsideMode::kTrajectory, " "), "theirs: command: is empty");
  EXPECT_HOLDS(refused(OutsideMode::kTrajectory, "slam {dataset}"), "{trajectory} is missing");
  EXPECT_HOLDS(refused(OutsideMode::kTrajectory, "slam {datset} {trajectory}"),
               "'{datset}' is not one of {dataset}");
  EXPECT_HOLDS(refused(OutsideMode::kConversation, "slam {dataset}"), "'{dataset}' is not one of");
  EXPECT_EQ(refused(OutsideMode::kTrajectory, "a={b,c}; slam ${HOME} {trajectory}"), "no error");
  EXPECT_EQ(refused(OutsideMode::kConversation, "slam {settings} {seed}"), "no error");
  for (const char* quoted : {"'{dataset}'", "\"{dataset}\"", "\"--data={dataset}\"",
                             "sh -c 'slam {dataset}'", "'{dataset}"})
    EXPECT_HOLDS(refused(OutsideMode::kTrajectory, quoted + std::string(" {trajectory}")),
                 "is inside quotes: its value is already quoted");
  EXPECT_EQ(refused(OutsideMode::kTrajectory, R"(sh -c "slam {dataset} it's" 'a b' {trajectory})"),
            "no error");
  OutsideProgram p = program(OutsideMode::kConversation, "slam");
  p.reply_limit_s = 0;
  EXPECT_THROW(validate(p), InputError);
}

TEST(ExpandCommand, QuotesForTheShell) {
  EXPECT_EQ(expand_command("slam {dataset} ${HOME} {", {{"dataset", "/a b/it's"}}),
            "slam '/a b/it'\\''s' ${HOME} {");
}

}  // namespace
}  // namespace mh
