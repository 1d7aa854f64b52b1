// SPDX-License-Identifier: Apache-2.0
#include "slam/io/yaml.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace mh {
namespace {

std::string error_of(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(YamlReader, NamesFileLinePlaceAndValue) {
  EXPECT_EQ(
      error_of([] { YamlReader::parse("a:\n  b: -3\n", "f.yaml").at("a").number("b", 0, 5); }),
      "f.yaml:2: a.b: -3 is outside [0, 5]");
  EXPECT_EQ(error_of([] { YamlReader::parse("a: x\n", "f.yaml").number("a"); }),
            "f.yaml:1: a: 'x' is not a number");
  EXPECT_EQ(error_of([] { YamlReader::parse("a: .nan\n", "f.yaml").number("a"); }),
            "f.yaml:1: a: '.nan' is not a finite number");
  EXPECT_EQ(error_of([] { YamlReader::parse("a: 1\n", "f.yaml").number("b"); }),
            "f.yaml:1: key 'b' is missing");
}

TEST(YamlReader, UnknownAndDoubledKeysAreErrors) {
  EXPECT_EQ(error_of([] {
              YamlReader reader = YamlReader::parse("a: 1\nc: 2\n", "f.yaml");
              reader.number("a");
              reader.finish();
            }),
            "f.yaml:2: unknown key 'c' (known here: a)");
  EXPECT_EQ(error_of([] {
              YamlReader reader = YamlReader::parse("labels: 1\nsede: 2\n", "f.yaml");
              reader.number("labels");
              reader.number_or("seed", 0);
              reader.finish();
            }),
            "f.yaml:2: unknown key 'sede' (known here: labels, seed); did you mean 'seed'?");
  EXPECT_EQ(error_of([] { YamlReader::parse("sytems: 1\n", "f.yaml").at("systems"); }),
            "f.yaml:1: key 'systems' is missing; is 'sytems' a typo for it?");
  EXPECT_EQ(error_of([] { YamlReader::parse("a: 1\na: 2\n", "f.yaml"); }),
            "f.yaml:2: key 'a' appears twice");
}

TEST(YamlReader, AliasesMayNotHoldThemselvesNorMultiply) {
  EXPECT_EQ(YamlReader::parse("a: &a 3\nb: *a\n", "f.yaml").number("b"), 3);
  for (const char* text : {"a: &a [*a]\n", "a: &a\n  b: *a\n"})
    EXPECT_NE(
        error_of([&] { YamlReader::parse(text, "f.yaml"); }).find("an alias that holds itself"),
        std::string::npos)
        << text;
  std::string laughs = "a: &a [x,x,x,x,x,x,x,x,x]\n";
  for (char name = 'b'; name <= 'i'; ++name) {
    laughs += fmt::format("{0}: &{0} [", name);
    for (int i = 0; i < 9; ++i) laughs += fmt::format("{}*{}", i > 0 ? "," : "", char(name - 1));
    laughs += "]\n";
  }
  EXPECT_NE(
      error_of([&] { YamlReader::parse(laughs, "f.yaml"); }).find("aliases counted each time"),
      std::string::npos);
}

TEST(YamlReader, MissingFileAndBrokenYaml) {
  EXPECT_EQ(error_of([] { YamlReader::load("/nowhere/f.yaml"); }),
            "/nowhere/f.yaml: cannot be read: no such file");
  EXPECT_NE(error_of([] { YamlReader::parse("a: [1, 2\n", "f.yaml"); }).find("is not valid YAML"),
            std::string::npos);
}

}  // namespace
}  // namespace mh
