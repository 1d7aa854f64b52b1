// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/replay/views.hpp"

#include <array>

#include <gtest/gtest.h>

#include "bench/report/packed.hpp"
#include "scenes/image_file.hpp"
#include "tests/bench/audit/box_room_run.hpp"

namespace mh::testing_support {
namespace {

using Json = nlohmann::ordered_json;

/// Decodes base64 (RFC 4648).
std::string bytes_of(const std::string& text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::uint32_t digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                                : c >= 'a' && c <= 'z' ? c - 'a' + 26
                                : c >= '0' && c <= '9' ? c - '0' + 52
                                : c == '+'             ? 62
                                                       : 63;
    group = group << 6 | digit;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xffU);
  }
  return bytes;
}

double pixel(const std::string& bytes, std::size_t at) {
  const auto low = static_cast<std::uint8_t>(bytes[at]);
  const auto high = static_cast<std::uint8_t>(bytes[at + 1]);
  return (low + 256 * high) / 10.0;
}

TEST(Base64, IsThatOfTheRfc) {
  for (const auto& [bytes, text] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}}) {
    EXPECT_EQ(base64(std::string_view(bytes)), text);
    EXPECT_EQ(bytes_of(text), bytes);
  }
  EXPECT_EQ(base64(std::vector<std::uint8_t>{0xff, 0xfe, 0xfd}), "//79");
}

class Views : public testing::Test {
 protected:
  static SensorConfig noisy() {
    SensorConfig sensors = exact_sensors();
    sensors.color_noise.enabled = true;
    return sensors;
  }
  World in_ = world(tour(10, 70, {0.15, -0.1, 0.05}), nullptr, noisy());
  Audited a_ = audited(spec(), in_);
  Json json_ = views_json(a_.run, in_, a_.frozen);
};

TEST_F(Views, OfAKeyframeAreItsImageAndItsFeatures) {
  std::size_t place = 0;
  for (const Keyframe& keyframe : a_.frozen.map.keyframes()) {
    if (keyframe.erased) continue;
    const Json& view = json_.at("keyframes").at(place++);
    EXPECT_EQ(in_.mapping->stamp_ns(view.at("frame").get<std::size_t>()), keyframe.stamp_ns);
    const auto image = decode_color(bytes_of(view.at("jpeg").get<std::string>()));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width(), json_.at("width_px").get<int>());
    EXPECT_EQ(image->height(), json_.at("height_px").get<int>());
    const std::string points = bytes_of(view.at("keypoints").get<std::string>());
    ASSERT_EQ(points.size(), 6 * keyframe.features.size());
    const double scale = static_cast<double>(image->width()) / in_.mapping->camera().width_px;
    for (std::size_t i = 0; i < keyframe.features.size(); ++i) {
      const Keypoint& keypoint = keyframe.features.keypoints[i];
      EXPECT_NEAR(pixel(points, 6 * i), (keypoint.u_px + 0.5) * scale - 0.5, 0.06);
      EXPECT_NEAR(pixel(points, 6 * i + 2), (keypoint.v_px + 0.5) * scale - 0.5, 0.06);
      EXPECT_EQ(static_cast<std::uint8_t>(points[6 * i + 4]), keypoint.label);
      EXPECT_EQ(points[6 * i + 5] != 0, keyframe.landmarks[i].valid());
    }
  }
  EXPECT_EQ(json_.at("keyframes").size(), place);
  EXPECT_GT(place, 3U);
}

TEST_F(Views, OfAQueryShowTheMatchesThatTheAuditCounts) {
  std::size_t at = 0;
  for (const QuerySet set : kQuerySets)
    for (std::size_t i = 0; i < queries(a_.run.points[0], set).size(); ++i) {
      const QueryScore& score = queries(a_.run.points[0], set)[i];
      const QueryAudit& audit = queries(a_.audit.points[0], set)[i];
      const Json& view = json_.at("queries").at(at++);
      EXPECT_EQ(view.at("set"), name(set));
      EXPECT_EQ(view.at("frame"), score.answer.index);
      EXPECT_EQ(view.at("stage"), name(audit.stage));
      EXPECT_EQ(view.at("candidates").size(), static_cast<std::size_t>(audit.candidates));
      std::int64_t right = 0, wrong = 0;
      for (const Json& candidate : view.at("candidates")) {
        EXPECT_LT(candidate.at("keyframe").get<std::size_t>(), json_.at("keyframes").size());
        const std::string pairs = bytes_of(candidate.at("pairs").get<std::string>());
        ASSERT_EQ(pairs.size() % 9, 0U);
        for (std::size_t p = 0; p < pairs.size(); p += 9) {
          right += pairs[p + 8] & 1;
          wrong += pairs[p + 8] >> 1 & 1;
        }
      }
      const StageMatches& words = audit.matches[static_cast<std::size_t>(MatchStage::kWords)];
      EXPECT_EQ(right, words.with_xi.kept_right()) << name(set) << " " << score.answer.index;
      EXPECT_EQ(wrong, words.with_xi.kept_wrong()) << name(set) << " " << score.answer.index;
      EXPECT_GT(right, 0);
    }
  EXPECT_EQ(json_.at("queries").size(), at);
  EXPECT_EQ(at, 14U);
}

}  // namespace
}  // namespace mh::testing_support
