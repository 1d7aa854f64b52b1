// SPDX-License-Identifier: Apache-2.0
#include "slam/io/json_text.hpp"

#include <gtest/gtest.h>

namespace mh {
namespace {

using Json = nlohmann::json;

std::string nested(int levels, const std::string& open, const std::string& close) {
  std::string text;
  for (int i = 0; i < levels; ++i) text += open;
  text += "1";
  for (int i = 0; i < levels; ++i) text += close;
  return text;
}

std::string fault_of(const std::string& text) {
  try {
    parse_json<Json>(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(JsonText, IsReadToACertainDepth) {
  const std::string lists = nested(kDeepestJson, "[", "]");
  EXPECT_EQ(parse_json<Json>(lists).dump(), lists);
  EXPECT_EQ(fault_of("[" + lists + "]"), "is nested more than 200 levels deep");
  EXPECT_EQ(fault_of(nested(1'000'000, "{\"a\":", "}")), "is nested more than 200 levels deep");
  EXPECT_TRUE(parse_json_or_discard<nlohmann::ordered_json>("[" + lists + "]").is_discarded());
  EXPECT_TRUE(parse_json_or_discard<Json>(lists).is_array());
  // Side by side or inside a string, brackets do not count as nested.
  std::string many = "[";
  for (int i = 0; i < 1000; ++i) many += "[{}],";
  EXPECT_EQ(fault_of(many + "[]]"), "no error");
  EXPECT_EQ(fault_of("[\"\\\"" + std::string(1000, '[') + "\"]"), "no error");
}

TEST(JsonText, FaultsAreToldInOurOwnWords) {
  EXPECT_EQ(fault_of("{\n  oops"), "2:3: is not JSON");
  EXPECT_EQ(fault_of(""), "1:1: is not JSON");
  EXPECT_EQ(fault_of("[1e999]"), "holds a number beyond the range of a double");
  const auto fault = [](const auto& use) -> std::string {
    try {
      use(parse_json<Json>(R"({"id": "chair", "list": [1]})"));
    } catch (const Json::exception& error) {
      return json_fault(error);
    }
    return "no error";
  };
  EXPECT_EQ(fault([](const Json& json) { json.at("name"); }), "has no 'name'");
  EXPECT_EQ(fault([](const Json& json) { json.at("id").get<int>(); }),
            "holds string where number is expected");
  EXPECT_EQ(fault([](const Json& json) { json.at("id").at("x"); }),
            "holds string where an object or a list is expected");
  EXPECT_EQ(fault([](const Json& json) { json.at("list").at(7); }), "has no entry 7");
}

}  // namespace
}  // namespace mh
