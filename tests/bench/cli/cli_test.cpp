// SPDX-License-Identifier: Apache-2.0
// The executable as a user sees it: bad input gives one clear line, exit code 2 and no file.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/suite/protocol_config.hpp"
#include "scenes/image_file.hpp"
#include "sim/sensors/config.hpp"
#include "slam/io/files.hpp"
#include "slam/io/settings_io.hpp"
#include "source_dir.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using mh::test::content;

class CommandLine : public testing::Test {
 protected:
  CommandLine() : folder_(fs::temp_directory_path() / ("mh_cli_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CommandLine() override { fs::remove_all(folder_); }

  /// Runs `modelhouse ARGUMENTS`; keeps what it printed. @returns its exit code
  int run(const std::string& arguments) {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const std::string command =
        std::string(MH_EXECUTABLE) + " " + arguments + " >" + out.string() + " 2>" + err.string();
    const int status = std::system(command.c_str());
    out_ = content(out);
    err_ = content(err);
    fs::remove(out);
    fs::remove(err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Expects a run to fail as on bad input: code 2 and one line of error that contains `part`.
  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << err_;
    const std::string mark = "modelhouse: error: ";
    const auto at = err_.find(mark);
    ASSERT_NE(at, std::string::npos) << err_;
    EXPECT_EQ(std::count(err_.begin() + static_cast<std::ptrdiff_t>(at), err_.end(), '\n'), 1)
        << err_;
    EXPECT_NE(err_.find(part, at), std::string::npos) << err_;
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The shipped suite with one key's value replaced; its other paths made absolute.
  fs::path suite_with(const std::string& key, const std::string& value) const {
    const std::string root = MH_SOURCE_DIR;
    std::istringstream lines(content(root + "/bench/suites/model_house.yaml"));
    std::string text, line;
    while (std::getline(lines, line)) {
      const auto at_key = line.find(key + ":");
      if (at_key == line.find_first_not_of(' ')) line = line.substr(0, at_key) + key + ": " + value;
      for (auto at = line.find("../../"); at != std::string::npos; at = line.find("../../"))
        line.replace(at, 6, root + "/");
      text += line + "\n";
    }
    return write("suite.yaml", text);
  }

  /// Number of files below the folder, apart from the suite.
  std::size_t files_left() const {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      count += entry.is_regular_file() && entry.path().filename() != "suite.yaml" ? 1 : 0;
    return count;
  }

  const std::string house_ = std::string(MH_SOURCE_DIR) + "/scenes/model_house/house.yaml";
  const std::string robot_ = std::string(MH_SOURCE_DIR) + "/robots/pepper/pepper.yaml";
  fs::path folder_;
  std::string out_, err_;
};

TEST_F(CommandLine, EveryCommandHasHelpWithAnExample) {
  for (const char* command :
       {"", "audit", "bench", "verify", "evaluate", "scene", "scene info", "scene preview",
        "scene convert", "drive", "render", "slam", "twin", "merge", "export", "vocabulary",
        "vocabulary train", "vocabulary convert", "vocabulary info"}) {
    EXPECT_EQ(run(std::string(command) + " --help"), 0) << command;
    EXPECT_NE(out_.find("Example"), std::string::npos) << command;
    EXPECT_NE(out_.find("  modelhouse "), std::string::npos) << command;
  }
}

// A recording made by the renderer is its own twin: only the depth unit in the file makes a
// difference.
TEST_F(CommandLine, ATwinOfARenderingIsItself) {
  const std::string room = std::string(MH_SOURCE_DIR) + "/bench/scenarios/room.yaml";
  const std::string recording = (folder_ / "recording").string(), out = (folder_ / "twin").string();
  ASSERT_EQ(run("render " + room + " --motion handheld:0:70 --level ideal --out " + recording), 0)
      << err_;
  ASSERT_EQ(run("twin tum:" + recording + " " + room + " --level ideal --every 35 --out " + out), 0)
      << err_;
  EXPECT_NE(out_.find("2 frames compared"), std::string::npos) << out_;
  EXPECT_TRUE(fs::exists(fs::path(out) / "pairs.png"));
  const auto json = nlohmann::json::parse(read_file(fs::path(out) / "twin.json"));
  EXPECT_EQ(json["frames_with_pose"], 70);
  for (const auto& frame : json["frames"]) {
    EXPECT_EQ(frame["recorded"], frame["rendered"]);
    EXPECT_LE(frame["depth_difference_m"], 0.5 / 5000 + 1e-6);
    EXPECT_EQ(frame["across"]["repeated"], frame["across"]["keypoints"]);
  }
  for (const char* map : {"map_of_recorded", "map_of_rendered"}) {
    EXPECT_EQ(json[map]["completeness"], 1.0) << map;
    EXPECT_EQ(json[map]["other_queries"]["correct"], 1.0) << map;
  }
  expect_refused(
      "twin " + recording + " " + room + " --out " + out + " --scene-from-recording 0 0 0 0 0 0 0",
      "--scene-from-recording");
}

TEST_F(CommandLine, BadUsageIsRefused) {
  expect_refused("dance", "'dance' is not a command of modelhouse");
  expect_refused("bench", "suite");
  expect_refused("bench x.yaml --jobs 0", "--jobs");
}

TEST_F(CommandLine, WithoutArgumentsItPrintsTheHelp) {
  for (const char* command : {"", "scene", "vocabulary"}) {
    EXPECT_EQ(run(std::string(command) + " --help"), 0);
    const std::string help = out_;
    EXPECT_EQ(run(command), 2) << command << ": nothing was done";
    EXPECT_EQ(out_, help);
    EXPECT_EQ(err_, "");
  }
}

TEST_F(CommandLine, ASlipIsToldWhatItMayHaveMeant) {
  for (const auto& [line, reported] : std::initializer_list<std::pair<const char*, const char*>>{
           {"benhc model_house", "did you mean 'bench'? There are: bench, merge"},
           {"scene inof x", "'inof' is not a command of modelhouse scene; did you mean 'info'?"},
           {"bench model_house --jbos 2",
            "modelhouse bench takes no --jbos; did you mean '--jobs'?"},
           {"drive model_house --robto pepper", "takes no --robto; did you mean '--robot'?"},
           {"bench model_hose", "did you mean 'model_house'? There are: "},
           {"export x --format cvs", "'cvs' is not one of csv, json, latex; did you mean 'csv'?"},
           {"evaluate a b --align se2", "did you mean 'se3'?"},
           {"drive model_hose auto",
            "no scene of that name is shipped; did you mean 'model_house'?"},
           {"drive model_house auto --robot peper", "did you mean 'pepper'?"},
           {"drive model_house handhled:0",
            "'handhled:0' is not a motion; did you mean 'handheld'?"},
           {"render model_house auto --level handhold --out o", "did you mean 'handheld'?"},
           {"slam x --vocabulary vocabluary --out o", "did you mean 'vocabulary'?"},
           {"scene make bathrom", "'bathrom' is not a category; did you mean 'bathroom'?"},
           {"reference furnitrue", "did you mean 'furniture'?"},
           {"completion tcsh", "'tcsh' is not one of bash, zsh, fish"}}) {
    expect_refused(line, reported);
    EXPECT_EQ(out_, "") << line;
  }
  std::string house = content(house_);
  house.replace(house.find("kind: sofa"), 10, "kind: soaf");
  expect_refused("scene info " + write("house.yaml", house).string(),
                 "unknown kind of furniture 'soaf'; did you mean 'sofa'?");
  expect_refused("bench " + suite_with("systems", "[semantik]").string(),
                 "'semantik' is not one of semantic, plain; did you mean 'semantic'?");
}

TEST_F(CommandLine, DefaultsStandInTheHelp) {
  for (const auto& [command, part] :
       std::initializer_list<std::pair<const char*, const char*>>{{"bench", "=14400"},
                                                                  {"bench", "out/<suite>-first-N"},
                                                                  {"scene preview", "=2"},
                                                                  {"drive", "=pepper"},
                                                                  {"render", "=exact"},
                                                                  {"slam", "=vocabulary"},
                                                                  {"slam", "=all"},
                                                                  {"evaluate", "=se3"},
                                                                  {"scene statistics", "=handheld"},
                                                                  {"vocabulary train", "=5"}}) {
    ASSERT_EQ(run(std::string(command) + " --help"), 0);
    EXPECT_NE(out_.find(part), std::string::npos) << command << "\n" << out_;
  }
}

/// All names of options and commands that a command's help lists.
std::vector<std::string> names_in_help(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help);
  for (std::string line, section; std::getline(lines, line);) {
    if (!line.starts_with(' ')) section = line;
    std::istringstream words(line);
    std::string word;
    if (!line.starts_with("  ") || line.starts_with("   ") || !(words >> word)) continue;
    if (section == "Subcommands:") names.push_back(word);
    if (section != "Options:") continue;
    std::istringstream forms(word);
    for (std::string name; std::getline(forms, name, ',');) names.push_back(name);
  }
  return names;
}

TEST_F(CommandLine, CompletionAndManualListEveryCommandAndOption) {
  ASSERT_EQ(run("manual"), 0);
  std::string manual = out_;
  for (auto at = manual.find("\\-"); at != std::string::npos; at = manual.find("\\-"))
    manual.erase(at, 1);
  std::map<std::string, std::string> scripts;
  for (const char* shell : {"bash", "zsh", "fish"}) {
    ASSERT_EQ(run(std::string("completion ") + shell), 0);
    scripts[shell] = out_;
  }
  std::size_t options = 0, commands = 0;
  std::vector<std::string> paths = {""};
  for (std::size_t i = 0; i < paths.size(); ++i) {
    ASSERT_EQ(run(paths[i] + " --help"), 0);
    for (const std::string& name : names_in_help(out_)) {
      const bool option = name.starts_with("-");
      ++(option ? options : commands);
      if (!option) paths.push_back(paths[i].empty() ? name : paths[i] + " " + name);
      EXPECT_NE(manual.find(option ? name : "modelhouse " + paths.back()), std::string::npos)
          << paths[i] << ": " << name;
      for (const auto& [shell, script] : scripts) {
        const std::string form = shell == "fish" && option
                                     ? (name.starts_with("--") ? " -l " + name.substr(2) + " "
                                                               : " -s " + name.substr(1) + " ")
                                     : name;
        EXPECT_NE(script.find(form), std::string::npos)
            << shell << ", " << paths[i] << ": " << name;
      }
    }
  }
  EXPECT_GT(options, 100U);
  EXPECT_GT(commands, 20U);
}

TEST_F(CommandLine, BashCompletesCommandsOptionsAndNames) {
  ASSERT_EQ(run("completion bash"), 0);
  const fs::path script = write("completion.bash", out_);
  const auto completed = [&](const std::string& words) {
    const fs::path said = folder_ / "said";
    const std::string command = "bash -c 'source " + script.string() + "; COMP_WORDS=(" + words +
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _modelhouse; "
                                "echo \"${COMPREPLY[@]}\"' >" +
                                said.string();
    EXPECT_EQ(std::system(command.c_str()), 0) << words;
    return content(said);
  };
  EXPECT_EQ(completed("modelhouse ben"), "bench\n");
  EXPECT_EQ(completed("modelhouse scene in"), "info\n");
  EXPECT_EQ(completed("modelhouse bench --jo"), "--jobs\n");
  EXPECT_EQ(completed("modelhouse bench model_house --jo"), "--jobs\n");
  EXPECT_EQ(completed("modelhouse drive model_house --robot pe"), "pepper\n");
  EXPECT_EQ(completed("modelhouse export out --format l"), "latex\n");
  EXPECT_EQ(completed("modelhouse check c"), "ci\n");
}

TEST_F(CommandLine, ReferencePagesAreWhatTheCodeSays) {
  for (const char* what : {"furniture", "materials", "classes", "robot", "slam", "sensors",
                           "protocol", "detector", "suite"}) {
    ASSERT_EQ(run(std::string("reference ") + what), 0);
    EXPECT_GT(std::count(out_.begin(), out_.end(), '\n'), 15) << what;
    EXPECT_EQ(out_,
              content(fs::path(MH_SOURCE_DIR) / "docs/reference" / (what + std::string(".md"))))
        << "make it anew: modelhouse reference " << what << " > docs/reference/" << what << ".md";
  }
}

TEST_F(CommandLine, PrintedSettingsAreReadBackEqual) {
  ASSERT_EQ(run("sensors --print-settings"), 0);
  EXPECT_EQ(parse_sensor_config(out_, "printed"), SensorConfig{});
  EXPECT_NE(out_.find("  offset_ms: 0"), std::string::npos) << out_;
  ASSERT_EQ(run("sensors --print-settings --level handheld"), 0);
  EXPECT_EQ(parse_sensor_config(out_, "printed"),
            load_sensor_config(fs::path(MH_SOURCE_DIR) / "sim/sensors/levels/handheld.yaml"));
  expect_refused("sensors --level handheld plot --out x", "--level");
  expect_refused("plot x --table 1 --measure held_out.success --out y.png", "--measure");
  expect_refused("plot x --table 1 --width 5 --out y.png", "--width");

  ASSERT_EQ(run("bench --print-settings"), 0);
  YamlReader suite = YamlReader::parse(out_, "printed");
  ProtocolConfig config{.test_interval = 7, .reset = DropReset::kMap, .max_effort = 2};
  SettingsReader reader(suite);
  reader.section("protocol");
  fields(config, reader);
  reader.finish();
  suite.finish();
  EXPECT_EQ(config, ProtocolConfig{});
}

TEST_F(CommandLine, NumbersAreFiniteAndSeedsDoNotWrap) {
  for (const char* value : {"nan", "inf", "-inf", "1e999", "1.5x"})
    expect_refused(std::string("slam x --vocabulary v --out o --xi=") + value,
                   std::string("--xi: '") + value + "' is not a finite number");
  expect_refused("slam x --vocabulary v --out o --xi 0.5", "--xi");
  expect_refused("evaluate a b --max-difference nan", "--max-difference");
  expect_refused("evaluate a b --rate nan", "--rate");
  expect_refused("bench x.yaml --time-limit nan", "--time-limit");
  expect_refused("bench x.yaml --memory-limit inf", "--memory-limit");
  expect_refused("vocabulary info v --overlap nan", "--overlap");
  for (const char* command : {"drive a b --robot c", "render a b --robot c --out d", "scene make x",
                              "slam x --vocabulary v --out o", "vocabulary train --out o"})
    for (const char* seed : {"-1", "18446744073709551616"})
      expect_refused(std::string(command) + " --seed " + seed,
                     std::string("'") + seed + "' is not an integer from 0 to 2^64 - 1");
}

TEST_F(CommandLine, LostOutputIsTold) {
  const std::string command = std::string(MH_EXECUTABLE) + " reference classes 2>" +
                              (folder_ / "said").string() + " >/dev/full";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
  const std::string said = content(folder_ / "said");
  EXPECT_NE(said.find("modelhouse: error: "), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST_F(CommandLine, BenchFindsWhatCannotBeWorkedWithBeforeTheWork) {
  const auto refused = [&](const std::string& key, const std::string& value,
                           const std::string& part) {
    expect_refused("bench " + suite_with(key, value).string() + " --frames 5 --out " +
                       (folder_ / "out").string(),
                   part);
    EXPECT_EQ(err_.find(" runs, "), std::string::npos) << "it began: " << err_;
    EXPECT_FALSE(fs::exists(folder_ / "out/results.sqlite"));
    EXPECT_FALSE(fs::exists(folder_ / "out/table.txt"));
  };
  std::string small = content(house_);
  const std::string extent = "extent_m: [0, 0, 9.3, 6.7]";
  ASSERT_NE(small.find(extent), std::string::npos);
  small.replace(small.find(extent), extent.size(), "extent_m: [0, 0, 5.3, 6.7]");
  refused("scene", write("small.yaml", small).string(), "small.yaml:");
  // The tour starts inside the outer wall.
  const fs::path tour = write(
      "walled.yaml",
      "name: walled\nstart: {position: [-3, -3], heading_deg: 0}\nwaypoints: [{to: [1, 1]}]\n");
  refused("mapping_tour", tour.string(), "walled.yaml");
  for (const char* command : {"no_such_program_of_mine --x", "./nowhere/vo", "exec suite.yaml/x"})
    refused("systems",
            std::string("[{name: vo, protocol: conversation, command: '") + command + "'}]",
            "cannot be started");
  EXPECT_NE(err_.find("suite.yaml:"), std::string::npos) << "of which line? " << err_;
  refused(
      "systems",
      "[{name: vo, protocol: conversation, command: '" + write("plain.txt", "x").string() + "'}]",
      "it may not be executed");
}

TEST_F(CommandLine, AnAuditTakesOurOwnSystemsInSimulatedScenes) {
  const std::string out = (folder_ / "audit").string();
  const std::string theirs = "[semantic, {name: theirs, protocol: conversation, command: cat}]";
  expect_refused("audit " + suite_with("systems", theirs).string() + " --out " + out,
                 "'theirs' gives no match traces");
  fs::create_directories(folder_ / "desk");
  write("desk/rgb.txt", "# none\n");
  const fs::path recorded = write(
      "recorded.yaml", "environments: [{category: desk, sequence: 'tum:desk', settings: " +
                           std::string(MH_SOURCE_DIR) +
                           "/assets/cameras/tum_freiburg1.yaml}]\nvocabulary: " + MH_SOURCE_DIR +
                           "/assets/vocabulary.mhvoc\nsystems: [plain]\nlabels: [none]\n");
  expect_refused("audit " + recorded.string() + " --out " + out, "is a recording");
  EXPECT_FALSE(fs::exists(out)) << "refused, and yet it left a folder";
}

TEST_F(CommandLine, MissingSceneFile) {
  expect_refused("scene info " + (folder_ / "nowhere.yaml").string(), "nowhere.yaml");
  expect_refused("scene convert nowhere.ply --out " + (folder_ / "a.glb").string(), "nowhere.ply");
  const fs::path suite = suite_with("scene", "nowhere.yaml");
  expect_refused("bench " + suite.string() + " --out " + (folder_ / "out").string(),
                 "suite.yaml:7: environments[0].scene: ");
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(CommandLine, BadSuites) {
  const auto refused = [&](const std::string& key, const std::string& value,
                           const std::string& part) {
    expect_refused(
        "bench " + suite_with(key, value).string() + " --out " + (folder_ / "out").string(), part);
  };
  refused("trials", "many", "trials: 'many' is not an integer");
  refused("seed", "0\nspeed: 3", "unknown key 'speed'");
  refused("levels", "[]", "levels: is empty");
  refused("name", "[unclosed", "is not valid YAML");
  refused("slam", "{semantics: {alpha: 1.2}}\nx:", "slam.semantics.alpha: 1.2");
  EXPECT_EQ(files_left(), 0u);
}

TEST_F(CommandLine, AVocabularyCutShort) {
  const std::string whole = content(std::string(MH_SOURCE_DIR) + "/assets/vocabulary.mhvoc");
  ASSERT_GT(whole.size(), 1000u);
  const fs::path cut = write("cut.mhvoc", whole.substr(0, whole.size() / 2));
  expect_refused("vocabulary info " + cut.string(), "cut.mhvoc");
  expect_refused("bench " + suite_with("vocabulary", cut.string()).string() + " --out " +
                     (folder_ / "out").string(),
                 "cut.mhvoc");
  EXPECT_EQ(files_left(), 1u);  // cut.mhvoc itself
}

TEST_F(CommandLine, AVocabularyInText) {
  std::string node = "0 1";
  for (int byte = 0; byte < 32; ++byte) node += " 7";
  const std::string text = write("words.txt", "10 6 0 0\n" + node + " 1.25\n").string();
  const std::string own = (folder_ / "words.mhvoc").string();
  EXPECT_EQ(run("vocabulary convert " + text + " --out " + own), 0) << err_;
  EXPECT_NE(out_.find("1 word, ready in"), std::string::npos) << out_;
  EXPECT_EQ(run("vocabulary info " + own), 0) << err_;
  EXPECT_NE(out_.find("mean 1.250"), std::string::npos) << out_;
  EXPECT_NE(out_.find("images: not known"), std::string::npos) << out_;
  const std::string back = (folder_ / "back.txt").string();
  EXPECT_EQ(run("vocabulary convert " + own + " --out " + back), 0) << err_;
  EXPECT_EQ(read_file(back), "10 6 0 0\n" + node + " 1.25");
  const std::string bad = write("bad.txt", "10 6 0 0\n" + node + " 1.25 3\n").string();
  expect_refused("vocabulary info " + bad, "bad.txt:2: line continues where it should end: '3'");
  expect_refused("vocabulary info " + text + " --frames here --settings s.yaml", "s.yaml");
  expect_refused("vocabulary train --images " + (folder_ / "none.txt").string() + " --out " + own,
                 "none.txt");
}

TEST_F(CommandLine, AnOutputFolderThatCannotBeWrittenIsFoundBeforeTheWork) {
  const fs::path file = write("file", "x");
  const std::string below = (file / "out").string();
  expect_refused("bench " + suite_with("trials", "1").string() + " --out " + below, below);
  EXPECT_EQ(err_.find("scene"), std::string::npos) << "work had begun: " << err_;
  expect_refused("render " + house_ + " t.yaml --robot " + robot_ + " --out " + below, below);
  expect_refused("scene preview " + house_ + " --out " + below + "/a.png", below);
  expect_refused("render " + house_ + " t.yaml --robot " + robot_ + " --out ''", "an empty name");
  expect_refused("vocabulary train --out " + below + "/a.mhvoc", below);
  EXPECT_EQ(content(file), "x");
}

TEST_F(CommandLine, ImagesAndSequencesGoWhereTheyCanBeRead) {
  expect_refused("scene preview " + house_ + " --out " + folder_.string(), folder_.string());
  expect_refused("scene make bathroom --scan-look", "--out");
  const std::string render = "render " + house_ + " t.yaml --robot " + robot_ + " --out ";
  expect_refused(render + folder_.string() + " --frames 0", "--frames");
  expect_refused(render + folder_.string() + " --frames -1", "--frames");
  write("rgb.txt", "");
  expect_refused(render + folder_.string(), "already holds a sequence");
}

TEST_F(CommandLine, ARecordingInScannetsFormatEndsAtAHundredPerCent) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string command = "render " + mesh.string() + " --motion handheld:0 --robot " + robot_ +
                              " --frames 2 --format scannet --json --out " +
                              (folder_ / "s").string();
  ASSERT_EQ(run(command), 0) << err_;
  EXPECT_TRUE(err_.ends_with("100 %\n")) << err_;
  EXPECT_EQ(nlohmann::json::parse(out_)["frames"], 2) << out_;
  // A second run, with unrelated files of the user next to its output.
  const std::string sens = content(folder_ / "s/s.sens");
  ASSERT_GT(sens.size(), 1000u);
  for (const char* name : {"s/.s.4194305.tmp.sens", "s/s.sens.old", "s/.office.txt"})
    write(name, "mine");
  ASSERT_EQ(run(command), 0) << err_;
  for (const char* name : {"s/.s.4194305.tmp.sens", "s/s.sens.old", "s/.office.txt"})
    EXPECT_EQ(content(folder_ / name), "mine") << name;
  EXPECT_EQ(content(folder_ / "s/s.sens"), sens);
}

TEST_F(CommandLine, ARenderingThatWroteNothingDoesNotBindTheNext) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string out = (folder_ / "out").string();
  const std::string render = "render " + mesh.string() +
                             " --motion handheld:0 --frames 2 --robot " + robot_ + " --out " + out;
  ASSERT_EQ(run(render + " --seed 1"), 0) << err_;
  expect_refused(render + " --seed 2", "with other settings");
  // What Ctrl-C before the first frame leaves behind.
  for (const char* part : {"rgb", "rgb.txt", "depth", "label", "instance"})
    fs::remove_all(folder_ / "out" / part);
  EXPECT_EQ(run(render + " --seed 2"), 0) << err_;
  fs::create_directories(folder_ / "foreign");
  write("foreign/a.mcap", "mine");
  expect_refused("render " + mesh.string() + " --motion handheld:0 --frames 1 --robot " + robot_ +
                     " --format mcap --out " + (folder_ / "foreign").string(),
                 "already holds a sequence (a.mcap)");
  fs::create_directories(folder_ / "theirs");
  for (const char* name : {"theirs/render.json", "theirs/groundtruth.txt"}) write(name, "mine");
  expect_refused("render " + mesh.string() + " --motion handheld:0 --frames 1 --robot " + robot_ +
                     " --out " + (folder_ / "theirs").string(),
                 "render.json: already exists and was not written by `modelhouse render`");
  for (const char* name : {"theirs/render.json", "theirs/groundtruth.txt"})
    EXPECT_EQ(content(folder_ / name), "mine") << name;
}

TEST_F(CommandLine, PosesOfAFileAreRenderedExactlyWhereTheyAre) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  // Cameras that look down from 2 m above the floor; one of them is beyond the floor's edge.
  const fs::path poses = write("poses.tum",
                               "1305031229.5287 1 1 2 1 0 0 0\n1305031229.7 2.25 1.5 2 1 0 0 0\n"
                               "1305031230 -7 1.5 2 1 0 0 0\n");
  const std::string render = "render " + mesh.string() + " --robot " + robot_ + " --poses " +
                             poses.string() + " --out " + (folder_ / "out").string();
  ASSERT_EQ(run(render), 0) << err_;
  EXPECT_NE(err_.find("3 poses of " + poses.string() + ", exactly as they are: of the camera"),
            std::string::npos)
      << err_;
  EXPECT_NE(err_.find("3 of 3 poses are outside the scene"), std::string::npos)
      << err_ << "2 m above all there is";
  EXPECT_NE(err_.find("every camera looks straight up or down"), std::string::npos) << err_;
  std::istringstream truth(content(folder_ / "out/groundtruth.txt"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(truth, line);)
    if (!line.starts_with("#")) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_TRUE(lines[0].starts_with("1305031229.528700000 1 1 2 ")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("1305031229.700000000 2.25 1.5 2 ")) << lines[1];
  expect_refused(render + " --motion auto:0", "takes the place of a motion");
  expect_refused("render " + mesh.string() + " --poses-of robot --motion auto --out x", "--poses");
  expect_refused("render " + mesh.string() + " --poses none.tum --out " + (folder_ / "x").string(),
                 "none.tum");
  // A replay changes the poses and reports that it does.
  const fs::path walk =
      write("walk.tum", "0 40 0 1 0.5 -0.5 0.5 -0.5\n1 40.5 0 1 0.5 -0.5 0.5 -0.5\n");
  ASSERT_EQ(run("render " + mesh.string() + " --robot " + robot_ + " --motion replay:" +
                walk.string() + " --frames 1 --out " + (folder_ / "replayed").string()),
            0)
      << err_;
  EXPECT_NE(err_.find("its poses are moved"), std::string::npos) << err_;
  EXPECT_NE(err_.find("--poses renders at a file's poses as they are"), std::string::npos) << err_;
}

TEST_F(CommandLine, TheManualGivesFlagsNoValueAndNamesOfFilesAsOneChoice) {
  ASSERT_EQ(run("manual"), 0);
  for (const char* entry :
       {".TP\n\\fB\\-\\-json\\fR\n", ".TP\n\\fB\\-\\-help, \\-h\\fR\n",
        ".TP\n\\fB\\-\\-no\\-cache\\fR\n", "\\fB\\-\\-frames\\fR \\fIVALUE\\fR\n",
        "\\fB\\-\\-robot\\fR \\fIFILE|pepper|turtlebot3\\fR\n"})
    EXPECT_NE(out_.find(entry), std::string::npos) << entry;
}

TEST_F(CommandLine, TheLightThatOneCommandBakedServesTheOthers) {
  const std::string room = std::string(MH_SOURCE_DIR) + "/bench/scenarios/room.yaml";
  const std::string at = (folder_ / "cache").string();
  const char* before = std::getenv("XDG_CACHE_HOME");
  const std::string kept = before == nullptr ? "" : before;
  setenv("XDG_CACHE_HOME", at.c_str(), 1);
  const auto lights = [&] {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(at))
      if (entry.is_regular_file() && entry.path().string().find("/light/") != std::string::npos)
        ++count;
    return count;
  };
  const auto convert = [&](const char* name) {
    EXPECT_EQ(run("scene convert " + room + " --out " + (folder_ / name).string()), 0) << err_;
    return err_.find("light: ") != std::string::npos;  // progress of the baking
  };
  EXPECT_TRUE(convert("a.glb"));
  EXPECT_EQ(lights(), 1U);
  EXPECT_FALSE(convert("b.glb")) << "baked again";
  EXPECT_EQ(content(folder_ / "a.glb"), content(folder_ / "b.glb"));
  EXPECT_EQ(run("render " + room + " --motion handheld:0 --frames 1 --robot " + robot_ + " --out " +
                (folder_ / "frames").string()),
            0)
      << err_;
  EXPECT_EQ(err_.find("light: "), std::string::npos) << err_;
  EXPECT_EQ(lights(), 1U);
  kept.empty() ? unsetenv("XDG_CACHE_HOME") : setenv("XDG_CACHE_HOME", kept.c_str(), 1);
}

TEST_F(CommandLine, AFileBeyondTheLimitIsAnErrorNotASilentEnd) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string command =
      "bash -c 'ulimit -f 100; " + std::string(MH_EXECUTABLE) + " render " + mesh.string() +
      " --motion handheld:0 --frames 3 --format mcap --robot " + robot_ + " --out " +
      (folder_ / "out").string() + " 2>" + (folder_ / "said").string() + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 3);
  EXPECT_NE(content(folder_ / "said").find("out.mcap: cannot be written: File too large"),
            std::string::npos)
      << content(folder_ / "said");
}

TEST_F(CommandLine, NobodysFilesAreOverwritten) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string m = mesh.string(), f = folder_.string() + "/";
  const auto refuses_beside = [&](const std::string& command, const std::string& name) {
    const std::string out = "out_" + std::to_string(files_left());
    fs::create_directories((folder_ / out / name).parent_path());
    write(out + "/" + name, "mine");
    write(out + "/" + name + ".bak", "mine");
    expect_refused(command + " --out " + f + out,
                   out + "/" + name.substr(0, name.find('/')) + ": already exists");
    EXPECT_EQ(content(folder_ / out / name), "mine");
    EXPECT_EQ(content(folder_ / out / (name + ".bak")), "mine");
    EXPECT_FALSE(fs::exists(folder_ / out / ".modelhouse"));
  };
  const std::string tour = std::string(MH_SOURCE_DIR) + "/scenes/model_house/tours/query.yaml";
  refuses_beside("drive " + house_ + " " + tour + " --robot " + robot_, "camera.tum");
  refuses_beside("drive " + house_ + " " + tour + " --sensors --robot " + robot_, "imu.csv");
  const std::string render = "render " + m + " --motion handheld:0 --frames 1 --robot " + robot_;
  refuses_beside(render, "camera.yaml");
  refuses_beside(render, "groundtruth.txt");
  refuses_beside(render + " --format scannet", "scannetv2-labels.combined.tsv");
  refuses_beside("sensors sheet " + m, "depth.png");
  const std::string suite =
      "bench " + std::string(MH_SOURCE_DIR) + "/bench/suites/ci.yaml --frames 5 --trials 1";
  refuses_beside(suite, "table.txt");
  refuses_beside(suite, "results.json");
  refuses_beside(suite, "blank_corridor-plain-pepper-0/truth.tum");
  // A run of only a few frames has its own folder.
  fs::create_directories(folder_ / "out/model_house-first-5");
  write("out/model_house-first-5/table.txt", "mine");
  const fs::path here = fs::current_path();
  fs::current_path(folder_);
  expect_refused("bench model_house --frames 5",
                 "out/model_house-first-5/table.txt: already exists");
  fs::current_path(here);
  // A ScanNet scene that the conversion would replace.
  write("scene0000_00.txt", "mine");
  fs::create_directory(folder_ / "scene0000_00");
  write("scene0000_00/scene0000_00_vh_clean_2.ply", "mine");
  expect_refused("scene convert " + m + " --out " + f + "scene0000_00", "already exists");
  EXPECT_EQ(content(folder_ / "scene0000_00/scene0000_00_vh_clean_2.ply"), "mine");
  // The command must not overwrite its own input.
  ASSERT_EQ(run("scene convert " + m + " --out " + f + "m.glb"), 0) << err_;
  const std::string glb = content(folder_ / "m.glb");
  expect_refused("scene convert " + f + "m.glb --out " + f + "./m.glb", "is read by this command");
  EXPECT_EQ(content(folder_ / "m.glb"), glb);
  // Nor may it overwrite the files that a scene names: a placed mesh, a texture, the folder of a
  // scan.
  const std::string placed = write("placed.yaml", "objects: [{file: m.glb, name: m}]").string();
  expect_refused("scene convert " + placed + " --out " + f + "m.glb", "is read by this command");
  EXPECT_EQ(content(folder_ / "m.glb"), glb);
  ASSERT_EQ(run("scene preview " + m + " --out " + f + "wall.png"), 0) << err_;
  const std::string wall = content(folder_ / "wall.png");
  write("flat.mtl", "newmtl a\nmap_Kd wall.png\n");
  const std::string flat = write("flat.obj",
                                 "mtllib flat.mtl\nusemtl a\nv 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\n"
                                 "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
                               .string();
  expect_refused("scene preview " + flat + " --out " + f + "wall.png", "is read by this command");
  EXPECT_EQ(content(folder_ / "wall.png"), wall);
  ASSERT_EQ(run("scene convert " + m + " --out " + f + "scan"), 0) << err_;
  write("scan/scan.txt", content(folder_ / "scan/scan.txt") + "\n");
  const std::string edited = content(folder_ / "scan/scan.txt");
  expect_refused("scene convert " + f + "scan --out " + f + "scan", "is read by this command");
  EXPECT_EQ(content(folder_ / "scan/scan.txt"), edited);
  write("scan.labels.json", "mine");
  expect_refused("scene convert " + m + " --out " + f + "scan.ply",
                 "scan.labels.json: already exists");
  EXPECT_FALSE(fs::exists(folder_ / "scan.ply"));
  EXPECT_EQ(content(folder_ / "scan.labels.json"), "mine");
  ASSERT_EQ(run("scene convert " + m + " --out " + f + "own.ply"), 0) << err_;
  ASSERT_EQ(run("scene convert " + m + " --out " + f + "own.ply"), 0) << err_;
  // A command overwrites its own earlier output, and leaves other files beside it alone.
  const std::string again = "scene convert " + m + " --out " + f + "converted";
  ASSERT_EQ(run(again), 0) << err_;
  write("converted/notes.txt", "mine");
  ASSERT_EQ(run(again), 0) << err_;
  EXPECT_EQ(content(folder_ / "converted/notes.txt"), "mine");
  // The marker of a different command does not count, and neither does a file of that name that is
  // not a marker.
  expect_refused("render " + m + " --motion handheld:0 --frames 1 --format scannet --robot " +
                     robot_ + " --out " + f + "converted",
                 "already exists");
  write("converted/.modelhouse", "mine");
  expect_refused(again, "was not written by modelhouse");
}

TEST_F(CommandLine, ASceneBecomesAScannetFolderAndIsReadBack) {
  const fs::path mesh =
      write("m.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\no chair_1\nf 1 2 3\no floor\nf 3 2 1\n");
  const std::string out = (folder_ / "scene0000_00").string();
  ASSERT_EQ(run("scene convert " + mesh.string() + " --out " + out), 0) << err_;
  ASSERT_EQ(run("scene info --json " + out), 0) << err_;
  const auto info = nlohmann::json::parse(out_);
  EXPECT_EQ(info["name"], "scene0000_00");
  EXPECT_EQ(info["triangles"], 2);
  EXPECT_EQ(info["classes"]["chair"], 1);
  EXPECT_EQ(info["rooms"].size(), 1U);
  fs::remove(folder_ / "scene0000_00" / "scene0000_00.aggregation.json");
  ASSERT_EQ(run("scene info " + out), 0) << err_;
  EXPECT_NE(err_.find("warning: "), std::string::npos) << err_;
  expect_refused("scene convert " + mesh.string() + " --format ply --out " + out, "must end in");
  expect_refused("scene convert " + mesh.string() + " --out a.obj", "must end in .ply or .glb");
  const std::string slam = " --vocabulary " + std::string(MH_SOURCE_DIR) +
                           "/assets/vocabulary.mhvoc --out " + (folder_ / "out").string();
  expect_refused("slam scannet:" + (folder_ / "nowhere").string() + slam, "nowhere");
  expect_refused("slam scannet:" + out + slam, "not a ScanNet recording");
  expect_refused("slam scannet:" + write("a.sens", "text").string() + slam, "a.sens");
}

/// A number as the table of statistics prints it.
std::string printed(double v) {
  return std::abs(v) >= 1000 ? fmt::format("{:.0f}", v) : fmt::format("{:.3g}", v);
}

// Five frames over two scenes are split into two and three, and the table agrees with the JSON.
TEST_F(CommandLine, StatisticsOfScenesShareTheFramesAndPrintWhatTheyMeasured) {
  const fs::path mesh = write("m.obj",
                              "v 0 0 0\nv 9 0 0\nv 9 5 0\nv 0 5 0\nv 0 0 2\nv 9 0 2\n"
                              "o floor\nf 1 2 3 4\no wall\nf 1 2 6 5\n");
  const std::string root = MH_SOURCE_DIR;
  const std::string command = "scene statistics " + mesh.string() + " " + mesh.string() +
                              " --frames 5 --robot " + robot_ + " --level " + root +
                              "/sim/sensors/levels/handheld.yaml --reference " + root +
                              "/assets/real_frames.yaml";
  ASSERT_EQ(run(command + " --json"), 0) << err_;
  const auto json = nlohmann::ordered_json::parse(out_);
  ASSERT_EQ(json["places"].size(), 2u);
  EXPECT_EQ(json["places"][0]["frames"], 2);
  EXPECT_EQ(json["places"][1]["frames"], 3);
  EXPECT_EQ(json["places"][0]["scene"], mesh.string());
  ASSERT_EQ(run(command), 0) << err_;
  EXPECT_EQ(out_.rfind("5 frames of 2 places; percentiles 5 / 25 / 50 / 75 / 95\n", 0), 0u) << out_;
  std::istringstream lines(out_);
  std::string line;
  for (const auto& [key, quantity] : json["quantities"].items()) {
    EXPECT_TRUE(json["places"][0].contains(key)) << key;
    while (std::getline(lines, line) && line.rfind("  generated ", 0) != 0) {
    }
    for (const char* row : {"percentiles", "real"}) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      double last = -1e300;
      for (const double value : quantity[row]) {
        words >> word;
        EXPECT_EQ(word, printed(value)) << key << ": " << line;
        EXPECT_GE(value, last) << key;
        last = value;
      }
      std::getline(lines, line);  // the row of the real frames is next
    }
  }
}

TEST_F(CommandLine, SheetsOfSensorsAreFourImagesWhoseNamesArePrinted) {
  const fs::path mesh = write("m.obj",
                              "v 0 0 0\nv 9 0 0\nv 9 5 0\nv 0 5 0\nv 0 0 2\nv 9 0 2\n"
                              "o floor\nf 1 2 3 4\no wall\nf 1 2 6 5\n");
  const fs::path out = folder_ / "sheets";
  ASSERT_EQ(run("sensors sheet " + mesh.string() + " --out " + out.string()), 0) << err_;
  std::string names;
  std::vector<std::string> images;
  for (const char* name : {"color.png", "depth.png", "frames.png", "labels.png"}) {
    names += (out / name).string() + "\n";
    images.push_back(content(out / name));
    EXPECT_EQ(images.back().substr(1, 3), "PNG") << name;
    EXPECT_GT(images.back().size(), 10000u) << name;
  }
  EXPECT_EQ(out_, names);
  std::sort(images.begin(), images.end());
  EXPECT_EQ(std::unique(images.begin(), images.end()), images.end()) << "each its own";
}

TEST_F(CommandLine, ATourThatCannotBeDriven) {
  const fs::path tour = write("tour.yaml",
                              "name: through_the_wall\nstart: {position: [2, 2], heading_deg: 0}\n"
                              "waypoints:\n- to: [200, 2]\n");
  expect_refused("drive " + house_ + " " + tour.string() + " --robot " + robot_ + " --out " +
                     (folder_ / "out").string(),
                 "tour.yaml");
  EXPECT_EQ(files_left(), 1u);  // only tour.yaml itself
}

TEST_F(CommandLine, APersonInTheWayStopsADriveAndIsSeenBySensors) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 9 0 0\nv 9 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const fs::path script = write("forward.yaml",
                                "name: forward\nstart: {position: [1, 2], heading_deg: 0}\n"
                                "commands: [{for_s: 12, forward_m_per_s: 0.4}]\n");
  const fs::path pedestrian =
      write("pedestrian.yaml", "path: [[4, 2], [4, 2.05]]\nspeed_m_per_s: 0.01\n");
  const fs::path out = folder_ / "out";
  const auto drive = [&](const std::string& more) {
    EXPECT_EQ(run("drive " + mesh.string() + " --motion commands:" + script.string() + " --robot " +
                  robot_ + " --json" + more),
              0)
        << err_;
    return nlohmann::json::parse(out_)["length_m"].get<double>();
  };
  EXPECT_GT(drive(""), 4.0);
  EXPECT_NEAR(drive(" --pedestrian " + pedestrian.string() + " --sensors --out " + out.string()),
              3 - 0.26 - 0.22 - 0.40, 0.01);
  const std::string sonars = content(out / "sonars.csv");
  const std::string last = sonars.substr(sonars.rfind('\n', sonars.size() - 2) + 1);
  const double front_m = std::stod(last.substr(last.find(',') + 1));
  EXPECT_NEAR(front_m, 0.26 + 0.40 - 0.07, 0.04) << last;
  const std::string render = "render " + mesh.string() + " --motion commands:" + script.string() +
                             " --robot " + robot_ + " --every 100 --out ";
  ASSERT_EQ(run(render + (folder_ / "alone").string()), 0) << err_;
  ASSERT_EQ(run(render + (folder_ / "met").string() + " --pedestrian " + pedestrian.string()), 0)
      << err_;
  EXPECT_NE(content(folder_ / "alone/groundtruth.txt"), content(folder_ / "met/groundtruth.txt"));
}

TEST_F(CommandLine, ATourFasterThanTheRobotIsTold) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 9 0 0\nv 9 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  for (const auto& [speed, reported] : {std::pair("3", true), std::pair("0.3", false)}) {
    const fs::path tour = write("t.yaml", std::string("name: t\nspeed_m_per_s: ") + speed +
                                              "\nstart: {position: [1, 2], heading_deg: 0}\n"
                                              "waypoints: [{to: [3, 2]}]\n");
    ASSERT_EQ(run("drive " + mesh.string() + " " + tour.string() + " --robot " + robot_), 0)
        << err_;
    EXPECT_EQ(err_.find("t.yaml: speed_m_per_s 3 is more than robot 'pepper' can do: 0.55") !=
                  std::string::npos,
              reported)
        << err_;
  }
}

TEST_F(CommandLine, WhatIsCarriedByHandHasNoRobotsSensors) {
  const fs::path mesh = write("m.obj", "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n");
  const std::string drive = "drive " + mesh.string() + " --motion handheld:0 --robot " + robot_;
  const std::string out = " --out " + (folder_ / "out").string();
  expect_refused(drive + out + " --sensors", "--sensors: motion 'handheld:0'");
  expect_refused(drive + out + " --pedestrian w.yaml", "--pedestrian: motion 'handheld:0'");
  EXPECT_EQ(files_left(), 1U);  // only the mesh
  ASSERT_EQ(run(drive + " --json"), 0) << err_;
  EXPECT_TRUE(nlohmann::json::parse(out_)["peaks"].is_null()) << out_;
  ASSERT_EQ(run(drive), 0) << err_;
  EXPECT_NE(out_.find(" m moved\n"), std::string::npos) << out_;
}

TEST_F(CommandLine, AnUndeterminedErrorIsNotZero) {
  const fs::path line = write("line.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  const std::string command = "evaluate " + line.string() + " " + line.string();
  EXPECT_EQ(run(command + " --json"), 0) << err_;
  EXPECT_NE(out_.find("\"ape_translation_m\": null"), std::string::npos) << out_;
  EXPECT_EQ(run(command), 0) << err_;
  const auto row = out_.find("absolute, position");
  ASSERT_NE(row, std::string::npos) << out_;
  EXPECT_EQ(out_.substr(row, out_.find('\n', row) - row).find("0.0"), std::string::npos) << out_;
}

TEST_F(CommandLine, EvaluatesATrajectoryAgainstItself) {
  const fs::path poses = write("poses.tum",
                               "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 1 1 0 0 0 0 1\n"
                               "0.3 1 1 1 0 0 0 1\n");
  EXPECT_EQ(run("evaluate " + poses.string() + " " + poses.string() + " --json"), 0) << err_;
  EXPECT_NE(out_.find("\"pairs\": 4"), std::string::npos) << out_;
  const fs::path other = write("other.tum", "50 0 0 0 0 0 0 1\n");
  expect_refused("evaluate " + poses.string() + " " + other.string(), "no pose is within");
  expect_refused("evaluate " + poses.string() + " " + write("bad.tum", "0 0 0\n").string(),
                 "bad.tum:1");
}

TEST_F(CommandLine, EvaluateShiftsStampsAndTellsBothSpansOfTime) {
  const std::string poses = "0.5 0 0 0 0 0 0 1\n0.6 1 0 0 0 0 0 1\n0.7 1 1 0 0 0 0 1\n";
  const fs::path estimate = write("zero.tum", poses);
  const fs::path truth = write("epoch.tum",
                               "1305031100.5 0 0 0 0 0 0 1\n1305031100.6 1 0 0 0 0 0 1\n"
                               "1305031100.7 1 1 0 0 0 0 1\n");
  const std::string command = "evaluate " + truth.string() + " " + estimate.string();
  expect_refused(command,
                 "its stamps are from 0.500 to 0.700 s, those of the truth from 1305031100.500 to "
                 "1305031100.700 s (--offset adds to its stamps)");
  ASSERT_EQ(run(command + " --json --max-difference 0 --offset 1305031100"), 0) << err_;
  EXPECT_EQ(nlohmann::json::parse(out_)["pairs"], 3) << "exact to the nanosecond";
  ASSERT_EQ(run("evaluate " + estimate.string() + " " + truth.string() +
                " --json --max-difference 0 --offset -1305031100"),
            0)
      << err_;
  EXPECT_EQ(nlohmann::json::parse(out_)["pairs"], 3);
  expect_refused(command + " --offset 1s", "--offset: '1s' is not a time in seconds");
  expect_refused(command + " --offset 9.2e9", "--offset: gives stamps that are not");
  expect_refused("evaluate --format kitti --offset 1 a b",
                 "--offset: KITTI's poses have no stamps");
}

TEST_F(CommandLine, EvaluateLeavesOutWhatIsLostAndSaysSo) {
  const fs::path truth = write("lost.tum",
                               "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"
                               "3 1 1 0 0 0 0 1\n4 1 1 1 0 0 0 1\n5 nan nan nan 0 0 0 1\n");
  const fs::path estimate = write("ids.txt",
                                  "#timestamp x y z qx qy qz qw id\n1 0 0 0 0 0 0 1 1\n"
                                  "2 1 0 0 0 0 0 1 2\n3 1 1 0 0 0 0 1 3\n5 1 1 1 0 0 0 1 4\n");
  ASSERT_EQ(run("evaluate --json " + truth.string() + " " + estimate.string()), 0) << err_;
  EXPECT_EQ(nlohmann::json::parse(out_)["pairs"], 3);
  EXPECT_NE(err_.find("evaluate: warning: " + truth.string() +
                      ": 2 of 6 poses are left out: 1 is not finite, 1 repeats a stamp; the first "
                      "in line 3: stamp: 2 does not come after 2.000000000"),
            std::string::npos)
      << err_;
}

TEST_F(CommandLine, EvaluateKeepsItsDigitsInUtm) {
  std::string local, utm, estimate;
  for (int i = 0; i < 60; ++i) {
    const double a = 0.1 * i, x = std::cos(a), y = std::sin(2 * a), z = 0.01 * i;
    local += fmt::format("{} {:.4f} {:.4f} {:.4f} 0 0 0 1\n", i, x, y, z);
    utm +=
        fmt::format("{} {:.4f} {:.4f} {:.4f} 0 0 0 1\n", i, 458076.1 + x, 5429380.2 + y, 163.9 + z);
    estimate += fmt::format("{} {:.4f} {:.4f} {:.4f} 0 0 0 1\n", i, x + 0.01 * std::sin(9.0 * i),
                            y + 0.01 * std::cos(7.0 * i), z);
  }
  const fs::path e = write("e.tum", estimate);
  std::array<double, 2> ate{};
  for (const bool far : {false, true}) {
    const fs::path truth = write(far ? "utm.tum" : "local.tum", far ? utm : local);
    ASSERT_EQ(run("evaluate --json " + truth.string() + " " + e.string()), 0) << err_;
    ate[far ? 1 : 0] = nlohmann::json::parse(out_)["ape_translation_m"]["rmse"];
  }
  EXPECT_GT(ate[0], 0.005);
  // Near 5e6 m, coordinates have a resolution of 1e-9 m.
  EXPECT_NEAR(ate[1], ate[0], 1e-8);
}

TEST_F(CommandLine, MapCostReadsPngAndKeepsTheTurn) {
  Grid2d<std::uint8_t> gray(4, 3, 254);
  gray(1, 0) = 0;
  write("g.png", encode_png(gray));
  const fs::path yaml = write("g.yaml",
                              "image: g.png\nmode: scale\nresolution: 0.5\norigin: [1, 2, 0.3]\n"
                              "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const std::string out = (folder_ / "cost").string();
  ASSERT_EQ(run("map cost " + yaml.string() + " --out " + out + " --inflation 0.3"), 0) << err_;
  EXPECT_NE(out_.find("4 x 3 cells of 0.5 m"), std::string::npos) << out_;
  EXPECT_NE(read_file(out + ".yaml").find("origin: [1, 2, 0.3]\n"), std::string::npos);
  EXPECT_NE(read_file(out + "_published.yaml").find("origin: [1, 2, 0.3]\n"), std::string::npos);
  const std::string pgm = read_file(out + ".pgm");
  const std::string head = "P5\n4 3\n255\n";
  ASSERT_EQ(pgm.substr(0, head.size()), head);
  ASSERT_EQ(pgm.size(), head.size() + 12);
  EXPECT_EQ(static_cast<unsigned char>(pgm[head.size() + 1]), 254)
      << "the obstacle, upper row, second column";
}

TEST_F(CommandLine, EvaluatesKittiFilesByLine) {
  const auto line = [](const std::string& x, const std::string& y) {
    return "1 0 0 " + x + " 0 1 0 " + y + " 0 0 1 0\n";
  };
  const fs::path truth = write("t.kitti", line("0", "0") + line("1", "0") + line("1", "2"));
  // Computed by hand: aligned at the origin, the errors are 0, 0.3 and 0.4 m; rmse sqrt(0.25 / 3).
  const fs::path estimate = write("e.kitti", line("5", "5") + line("6.3", "5") + line("6.4", "7"));
  const std::string files = truth.string() + " " + estimate.string();
  ASSERT_EQ(run("evaluate --format kitti --align origin --rate 2 --delta 1s --json " + files), 0)
      << err_;
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["pairs"], 3);
  EXPECT_NEAR(json["ape_translation_m"]["rmse"], std::sqrt(0.25 / 3), 1e-12);
  EXPECT_NEAR(json["ape_unaligned_m"]["min"], std::sqrt(50.0), 1e-12);
  // Two steps of half a second make only one pair that is 1 s apart; it is 0.4 m off.
  EXPECT_EQ(json["rpe"][0]["translation_m"]["count"], 1);
  EXPECT_NEAR(json["rpe"][0]["translation_m"]["mean"], 0.4, 1e-12);
  expect_refused("evaluate --format kitti " + truth.string() + " " +
                     write("short.kitti", line("0", "0")).string(),
                 "short.kitti: 1 pose, " + truth.string() + " has 3");
  expect_refused("evaluate --format kitti " + truth.string() + " " +
                     write("bad.kitti", line("0", "0") + "1 2 3\n").string(),
                 "bad.kitti:2: pose: 3 values");
  expect_refused("evaluate --delta 1.5f " + files, "--delta: '1.5f'");
  expect_refused("evaluate --delta 3 " + files, "--delta: '3'");
  expect_refused("evaluate --format euroc " + files, "--format");
}

// All figures computed by evo, through the executable as users run it.
TEST_F(CommandLine, EvaluateGivesEvosOwnFigures) {
  const fs::path data = fs::path(MH_SOURCE_DIR) / ".." / "shared/data";
  const fs::path reference = data / "evo_reference/reference.json";
  if (!fs::exists(reference)) GTEST_SKIP() << "no " << reference;
  const auto evo = nlohmann::json::parse(content(reference));
  const std::string files = (data / "tum_fr1_rpy/groundtruth.txt").string() + " " +
                            (data / "evo_reference/estimate.txt").string();
  std::size_t compared = 0;
  const auto expect_equal = [&](const nlohmann::json& ours, const std::string& name) {
    for (const auto& [field, expected] : evo.at(name).items()) {
      // 1e-15 allows for a rounding error of ours where evo has an exact zero.
      const double value = expected;
      EXPECT_NEAR(ours.at(field).get<double>(), value, 1e-9 * std::abs(value) + 1e-15)
          << name << ' ' << field;
    }
    ++compared;
  };
  for (const std::string align : {"se3", "sim3", "none", "origin"}) {
    ASSERT_EQ(run("evaluate --json --all-pairs --delta 1f 30f 0.2m --align " + align + " " + files),
              0)
        << err_;
    const auto ours = nlohmann::json::parse(out_);
    EXPECT_EQ(ours["pairs"], evo["pairs"]);
    expect_equal(ours["ape_translation_m"], "ape_trans_" + align);
    if (align != "se3") continue;
    expect_equal(ours["ape_rotation_deg"], "ape_rot_deg_se3");
    expect_equal(ours["rpe"][0]["translation_m"], "rpe_trans_1frame");
    expect_equal(ours["rpe"][0]["rotation_deg"], "rpe_rot_deg_1frame");
    expect_equal(ours["rpe"][1]["translation_m"], "rpe_trans_30frames_all_pairs");
    expect_equal(ours["rpe"][2]["translation_m"], "rpe_trans_0.2m_all_pairs");
  }
  EXPECT_EQ(compared + 1, evo.size());  // every quantity except `pairs`
}

TEST_F(CommandLine, CheckRefusesABaselineThatIsNotOfItsSuite) {
  const std::string check =
      "check " + std::string(MH_SOURCE_DIR) + "/bench/suites/ci.yaml --baseline ";
  expect_refused(check + (folder_ / "none.json").string(), "none.json: ");
  EXPECT_NE(err_.find("--update makes one"), std::string::npos) << err_;
  expect_refused(check + write("damaged.json", "{").string(), "is not a baseline");
  expect_refused(check + write("newer.json", R"({"format": "modelhouse-baseline-9"})").string(),
                 "modelhouse-baseline-9");
  const std::string head = R"({"format": "modelhouse-baseline-1", "suite_digest": "0", )"
                           R"("origin": {}, "runs": [], "suite": )";
  expect_refused(check + write("other.json", head + "\"table1\"}").string(), "'table1'");
  expect_refused(check + write("older.json", head + "\"ci\"}").string(), "--update");
  expect_refused("check " + std::string(MH_SOURCE_DIR) + "/bench/suites/model_house.yaml",
                 "tolerances");
}

TEST_F(CommandLine, CheckReplacesNoFileOfAnothers) {
  const std::string check = "check " + std::string(MH_SOURCE_DIR) + "/bench/suites/ci.yaml ";
  const fs::path mine = write("mine.json", R"({"format": "of another"})"),
                 xml = write("mine.xml", "<?xml version=\"1.0\"?>\n<testsuites/>\n");
  expect_refused(check + "--update --baseline " + mine.string(),
                 "mine.json: already exists and was not written by `modelhouse check --update`");
  expect_refused(check + "--junit " + xml.string(),
                 "mine.xml: already exists and was not written by `modelhouse check --junit`");
  EXPECT_EQ(content(mine), R"({"format": "of another"})");
  EXPECT_EQ(content(xml), "<?xml version=\"1.0\"?>\n<testsuites/>\n");
}

TEST_F(CommandLine, AMapWithAnEmptyGridSaysSo) {
  // Eight frames from the robot's camera height see nothing below 0.15 m.
  const std::string map =
      "map build scene:generated:bathroom:0 --tour auto:0 --level ideal "
      "--frames 8 --out " +
      (folder_ / "map").string();
  ASSERT_EQ(run(map + " --height 0.15"), 0) << err_;
  EXPECT_NE(err_.find("the grid is empty: nothing was seen from 0.1 to 0.15 m"), std::string::npos)
      << err_;
  ASSERT_EQ(run(map), 0) << err_;
  EXPECT_EQ(err_.find("empty"), std::string::npos) << err_;
}

TEST_F(CommandLine, PosesOfAMapMayHaveOtherStampsThanTheFrames) {
  const std::string tour = (folder_ / "tour").string(), out = (folder_ / "map").string();
  ASSERT_EQ(run("render generated:bedroom:0 --motion handheld:0:60 --level ideal --frames 6 "
                "--out " +
                tour),
            0)
      << err_;
  std::istringstream truth(content(tour + "/groundtruth.txt"));
  std::string shifted;
  for (std::string line; std::getline(truth, line);)
    if (double stamp_s = 0; line[0] != '#' && std::sscanf(line.c_str(), "%lf", &stamp_s) == 1)
      shifted += fmt::format("{:.6f}{}\n", stamp_s + 0.01, line.substr(line.find(' ')));
  for (const auto& [poses, frames] : {std::pair(tour + "/groundtruth.txt", "6 keyframes, "),
                                      {write("shifted.txt", shifted).string(), "5 keyframes, "}}) {
    ASSERT_EQ(run("map build tum:" + tour + " --poses " + poses + " --out " + out), 0) << err_;
    EXPECT_TRUE(out_.starts_with(frames)) << out_;
  }
  expect_refused("map build tum:" + tour + " --poses " +
                     write("late.txt", "99 0 0 0 0 0 0 1\n").string() + " --out " + out,
                 "has no frame at the time of a pose of ");
}

TEST_F(CommandLine, LasersOfAMapScanAtItsKeyframesAlone) {
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  const std::string scene = " scene:generated:bathroom:0 --tour auto:0 --level ideal";
  ASSERT_EQ(run("slam" + scene + " --frames 60 --out " + path("slam")), 0) << err_;
  std::istringstream estimate(content(path("slam") + "/estimate.tum"));
  std::string line, first;
  for (int poses = 0; poses < 3 && std::getline(estimate, line); first += line + "\n")
    if (line[0] != '#') ++poses;
  const std::string build = "map build" + scene + " --lasers --poses ";
  ASSERT_EQ(run(build + path("slam") + "/estimate.tum --frames 3 --out " + path("frames")), 0)
      << err_;
  ASSERT_EQ(run(build + write("first.tum", first).string() + " --out " + path("first")), 0) << err_;
  EXPECT_EQ(content(path("frames") + "/grid.pgm"), content(path("first") + "/grid.pgm"));
  ASSERT_EQ(run(build + path("slam") + "/estimate.tum --out " + path("all")), 0) << err_;
  EXPECT_NE(content(path("all") + "/grid.pgm"), content(path("first") + "/grid.pgm"));
  expect_refused("map build" + scene + " --every 2 --out " + path("none"), "--every");
  expect_refused("map plan " + path("all") + "/map.ot --from 1 1 --to 1 1 --out ''", "--out");
}

TEST_F(CommandLine, AMapOfAnotherSequenceIsRefused) {
  const auto path = [&](const char* name) { return (folder_ / name).string(); };
  for (const char* room : {"bedroom", "office"}) {
    ASSERT_EQ(run("render generated:" + std::string(room) +
                  ":0 --motion handheld:0:60 --level pepper --frames 20 --out " + path(room)),
              0)
        << err_;
  }
  ASSERT_EQ(run("slam tum:" + path("bedroom") + " --out " + path("slam") + " --save-map " +
                path("bedroom.mhmap")),
            0)
      << err_;
  const std::string build = " --map " + path("bedroom.mhmap") + " --out " + path("map");
  EXPECT_EQ(run("map build tum:" + path("bedroom") + build), 0) << err_;
  expect_refused("map build tum:" + path("office") + build, "is the map of another sequence");
}

TEST_F(CommandLine, FilesOfOthersAreNotReplacedByObjectsAndPaths) {
  const std::string map = (folder_ / "map").string(), file = (folder_ / "file").string();
  ASSERT_EQ(
      run("map build scene:generated:bathroom:0 --tour auto:0 --level ideal --frames 8 --out " +
          map),
      0)
      << err_;
  const std::string objects = "map objects " + map + "/map.ot --out ";
  write("file", "a thesis");
  expect_refused(objects + file, "already exists and was not written by `modelhouse map`");
  expect_refused("map plan " + map + "/map.ot --from 1 1 --to 1 1 --out " + file,
                 "already exists and was not written by `modelhouse map plan`");
  EXPECT_EQ(content(file), "a thesis");
  ASSERT_EQ(run(objects + map + "/more.json"), 0) << err_;
  ASSERT_EQ(run(objects + map + "/more.json"), 0) << err_;
  EXPECT_EQ(content(map + "/more.json"), content(map + "/objects.json"));
  expect_refused("map objects " + map + "/map.ot ''", "is empty");
  expect_refused("map objects " + map + "/map.ot dexk --out " + map + "/new/none.json", "dexk");
  EXPECT_FALSE(std::filesystem::exists(map + "/new"));
  EXPECT_FALSE(fs::exists(map + "/none.json"));
  expect_refused("map grid " + map + "/map.ot --out .", "names no file");

  // A grid whose image would be overwritten by another output file.
  std::string grid = content(map + "/grid.yaml");
  write("map/again.yaml", grid.substr(grid.find('\n') + 1));
  const std::string image = content(map + "/grid.pgm");
  expect_refused("map cost " + map + "/again.yaml --out " + map + "/grid",
                 "grid.pgm: is read by this command");
  EXPECT_EQ(content(map + "/grid.pgm"), image);
}

TEST_F(CommandLine, WithoutAFloorTheOctreeAloneIsWritten) {
  const std::string tour = (folder_ / "tour").string(), out = (folder_ / "map").string();
  // A robot in front of a wall.
  ASSERT_EQ(
      run("render generated:bathroom:0 --motion auto:0 --level ideal --frames 3 --out " + tour), 0)
      << err_;
  ASSERT_EQ(
      run("map build scene:generated:bathroom:0 --tour auto:0 --level ideal --frames 8 --out " +
          out),
      0)
      << err_;
  EXPECT_TRUE(fs::exists(out + "/grid.yaml"));
  ASSERT_EQ(run("map build tum:" + tour + " --poses " + tour + "/groundtruth.txt --out " + out), 0)
      << err_;
  EXPECT_NE(err_.find("no floor was found under the camera's path"), std::string::npos) << err_;
  EXPECT_TRUE(fs::exists(out + "/map.ot"));
  EXPECT_FALSE(fs::exists(out + "/grid.pgm"));
  EXPECT_EQ(out_.find("grid"), std::string::npos) << out_;
}

TEST_F(CommandLine, AMapOfARaisedFloorHasItsGridAboveThatFloor) {
  const std::string room = (folder_ / "room.ply").string(), out = (folder_ / "map").string();
  ASSERT_EQ(run("scene convert generated:bathroom:0 --out " + room), 0) << err_;
  const fs::path raised = write("raised.yaml",
                                "name: raised\nfloor_z_m: 2\n"
                                "objects:\n- {file: room.ply, position_m: [0, 0, 2]}\n");
  ASSERT_EQ(run("map build scene:" + raised.string() +
                " --tour auto:0 --level ideal --score --frames 60 --out " + out),
            0)
      << err_;
  const auto score = nlohmann::json::parse(content(out + "/score.json")).at("map");
  EXPECT_GT(score.at("grid_iou_seen").at("value"), 0.95);
  EXPECT_GT(score.at("grid_iou_seen").at("of"), 50);
}

}  // namespace
}  // namespace mh
