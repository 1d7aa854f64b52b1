// SPDX-License-Identifier: Apache-2.0
#include "bench/run/frame_log.hpp"

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace mh {
namespace {

/// Three frames, one second apart.
class ThreeFrames : public Sequence {
 public:
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return 3; }
  Stamp stamp_ns(std::size_t i) const override { return static_cast<Stamp>(i) * 1'000'000'000; }
  RgbdFrame frame(std::size_t, RandomStream) const override { return {}; }
  const Trajectory* truth() const override { return nullptr; }

 private:
  Camera camera_;
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found(1);
  for (const char c : line)
    if (c == ',')
      found.emplace_back();
    else
      found.back() += c;
  return found;
}

TEST(FrameLog, ItsNumbersStandUnderTheirHeadings) {
  FrameLog log;
  MappedFrame call;
  SystemReport report;
  report.status = TrackStatus::kRelocalized;
  report.keypoints = 1001;
  report.inliers = 52;
  report.keyframe_added = true;
  report.relocalization = RelocalizationStage::kVerified;
  report.candidates = {
      .keyframes = 90, .c1 = 31, .c2 = 22, .c3 = 13, .final = 4, .label_mass = {}, .gamma = {}};
  log.add(call, report);
  call.index = 2;
  report = {};
  report.keypoints = 7;
  log.add(call, report);
  ProtocolConfig config;
  config.test_interval = 2;
  std::istringstream lines(log.csv(ThreeFrames(), config));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> heading = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), heading.size()) << line;
    rows.emplace_back();
    for (std::size_t c = 0; c < row.size(); ++c) rows.back()[heading[c]] = row[c];
  }
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["status"], name(TrackStatus::kRelocalized));
  const std::map<std::string, std::string> first = {{"keypoints", "1001"},
                                                    {"inliers", "52"},
                                                    {"keyframe", "1"},
                                                    {"loop", "0"},
                                                    {"relocalization", "verified"},
                                                    {"keyframes", "90"},
                                                    {"c1", "31"},
                                                    {"c2", "22"},
                                                    {"c3", "13"},
                                                    {"final", "4"}};
  for (const auto& [column, value] : first) EXPECT_EQ(rows[0][column], value) << column;
  EXPECT_EQ(rows[1]["status"], "held_out");
  EXPECT_EQ(rows[2]["status"], name(TrackStatus::kLost));
  EXPECT_EQ(rows[2]["keypoints"], "7");
  EXPECT_EQ(rows[2]["c1"], "");
}

}  // namespace
}  // namespace mh
