// SPDX-License-Identifier: Apache-2.0
// The executable as a user meets it: bad input gives one clear line, exit code 2 and no file.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

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

  /// The run failed as bad input should: code 2, one line that says so and holds `part`.
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

  /// Files below the folder, the suite apart.
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
       {"", "bench", "verify", "evaluate", "scene", "scene info", "scene preview", "scene convert",
        "drive", "render", "slam", "vocabulary", "vocabulary train", "vocabulary convert",
        "vocabulary info"}) {
    EXPECT_EQ(run(std::string(command) + " --help"), 0) << command;
    EXPECT_NE(out_.find("Example"), std::string::npos) << command;
    EXPECT_NE(out_.find("  modelhouse "), std::string::npos) << command;
  }
}

TEST_F(CommandLine, BadUsageIsRefused) {
  expect_refused("", "A subcommand is required");
  expect_refused("dance", "'dance' is no subcommand");
  expect_refused("bench", "suite");
  expect_refused("bench x.yaml --jobs 0", "--jobs");
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
  refused("trials", "many", "trials: 'many' is not a whole number");
  refused("seed", "0\nspeed: 3", "unknown key 'speed'");
  refused("levels", "[]", "levels: is empty");
  refused("name", "[unclosed", "is no valid YAML");
  refused("slam", "{alpha: 1.2}\nx:", "slam.alpha: 1.2");
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
  EXPECT_NE(out_.find("1 words, ready in"), std::string::npos) << out_;
  EXPECT_EQ(run("vocabulary info " + own), 0) << err_;
  EXPECT_NE(out_.find("mean 1.250"), std::string::npos) << out_;
  EXPECT_NE(out_.find("pictures: not known"), std::string::npos) << out_;
  const std::string bad = write("bad.txt", "10 6 0 0\n" + node + " 1.25 3\n").string();
  expect_refused("vocabulary info " + bad, "bad.txt:2: line goes on where it should end: '3'");
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
  expect_refused("vocabulary train --out " + below + "/a.mhvoc", below);
  EXPECT_EQ(content(file), "x");
}

TEST_F(CommandLine, PicturesAndSequencesGoWhereTheyCanBeRead) {
  expect_refused("scene preview " + house_ + " --out " + folder_.string(), folder_.string());
  const std::string render = "render " + house_ + " t.yaml --robot " + robot_ + " --out ";
  expect_refused(render + folder_.string() + " --frames 0", "--frames");
  expect_refused(render + folder_.string() + " --frames -1", "--frames");
  write("rgb.txt", "");
  expect_refused(render + folder_.string(), "holds a sequence already");
}

TEST_F(CommandLine, ATourThatCannotBeDriven) {
  const fs::path tour = write("tour.yaml",
                              "name: through_the_wall\nstart: {position: [2, 2], heading_deg: 0}\n"
                              "waypoints:\n- to: [200, 2]\n");
  expect_refused("drive " + house_ + " " + tour.string() + " --robot " + robot_ + " --out " +
                     (folder_ / "out").string(),
                 "tour.yaml");
  EXPECT_EQ(files_left(), 1u);  // tour.yaml itself
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

}  // namespace
