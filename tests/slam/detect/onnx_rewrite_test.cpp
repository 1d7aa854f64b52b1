// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/onnx_rewrite.hpp"

#include <gtest/gtest.h>

#include <opencv2/dnn.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "slam/detect/onnx_call.hpp"
#include "slam/detect/protobuf.hpp"
#include "tests/slam/detect/made_networks.hpp"

namespace mh {
namespace {

using test::constant_node;
using test::floats;
using test::integer;
using test::integers;
using test::list;
using test::node;

constexpr int kChannels = 3, kRows = 2, kColumns = 4;

/// The result of a graph from "image" (1 x 3 x 2 x 4, with the values 1 to 24) to "output" when
/// OpenCV runs the rewritten graph.
std::vector<float> result(const std::string& graph, int opset = 17, bool open = false) {
  const std::vector<std::int64_t> sides =
      open ? std::vector<std::int64_t>{0, 3, 0, 0} : std::vector<std::int64_t>{1, 3, 2, 4};
  const std::string model = test::model(
      graph + test::value(11, "image", sides) + test::value(12, "output", {1, 3, 2, 4}), opset);
  const auto rewritten = rewrite_onnx(model, {kColumns, kRows});
  if (!rewritten) return {};
  cv::dnn::Net net = cv::dnn::readNetFromONNX(rewritten->data(), rewritten->size());
  const std::vector<int> shape = {1, kChannels, kRows, kColumns};
  cv::Mat image(shape, CV_32F);
  for (int i = 0; i < 24; ++i) image.ptr<float>()[i] = static_cast<float>(i + 1);
  net.setInput(image);
  const cv::Mat out = net.forward();
  return {out.ptr<float>(), out.ptr<float>() + out.total()};
}

/// The function `of` applied to each value v at channel c, row y, column x.
std::vector<float> each(const std::function<double(double v, int c, int y, int x)>& of) {
  std::vector<float> values;
  for (int i = 0; i < 24; ++i)
    values.push_back(static_cast<float>(of(i + 1, i / 8, i / 4 % 2, i % 4)));
  return values;
}

void expect_near(const std::vector<float>& found, const std::vector<float>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-5 * std::abs(expected[i]) + 1e-6) << i;
}

TEST(RewriteOnnx, RepeatsConstantsToTheShapeThatTheyAreBroadcastTo) {
  const std::string row = floats("c", {1, kColumns}, {1, 2, 4, 8}),
                    column = floats("c", {kRows, 1}, {3, 5});
  expect_near(result(row + node("Mul", {"image", "c"}, {"output"})),
              each([](double v, int, int, int x) { return v * (1 << x); }));
  expect_near(result(row + node("Div", {"image", "c"}, {"output"})),
              each([](double v, int, int, int x) { return v / (1 << x); }));
  expect_near(result(row + node("Div", {"c", "image"}, {"output"})),
              each([](double v, int, int, int x) { return (1 << x) / v; }));
  expect_near(result(column + node("Mul", {"image", "c"}, {"output"})),
              each([](double v, int, int y, int) { return v * (y == 0 ? 3 : 5); }));
  expect_near(result(column + node("Sub", {"c", "image"}, {"output"})),
              each([](double v, int, int y, int) { return (y == 0 ? 3 : 5) - v; }));
  expect_near(result(column + node("Add", {"image", "c"}, {"output"})),
              each([](double v, int, int y, int) { return v + (y == 0 ? 3 : 5); }));
}

TEST(RewriteOnnx, LeavesValuesPerChannelToOpencv) {
  const std::string c = floats("c", {kChannels, 1, 1}, {1, 10, 100});
  const auto scale = [](int channel) { return channel == 0 ? 1 : channel == 1 ? 10 : 100; };
  expect_near(result(c + node("Mul", {"image", "c"}, {"output"})),
              each([&](double v, int k, int, int) { return v * scale(k); }));
  expect_near(result(c + node("Div", {"c", "image"}, {"output"})),
              each([&](double v, int k, int, int) { return scale(k) / v; }));
  expect_near(result(c + node("Sub", {"c", "image"}, {"output"})),
              each([&](double v, int k, int, int) { return scale(k) - v; }));
}

TEST(RewriteOnnx, TakesSizesOfSplitFromItsInput) {
  const std::string joined = node("Concat", {"b", "a"}, {"output"}, integer("axis", -3));
  const auto turned = [](double, int c, int y, int x) {
    return ((c + 1) % 3) * 8 + y * 4 + x + 1;  // channels 1, 2, 0
  };
  expect_near(result(integers("s", {1, 2}) +
                     node("Split", {"image", "s"}, {"a", "b"}, integer("axis", -3)) + joined),
              each(turned));
  // From opset 18 on, the last part of a split may be smaller.
  expect_near(
      result(node("Split", {"image"}, {"b", "a"}, integer("axis", 1) + integer("num_outputs", 2)) +
                 node("Concat", {"a", "b"}, {"output"}, integer("axis", 1)),
             18),
      each([](double, int c, int y, int x) { return ((c + 2) % 3) * 8 + y * 4 + x + 1; }));
}

TEST(RewriteOnnx, TakesAxesFromInputs) {
  expect_near(result(integers("axes", {0, -1}) + node("Unsqueeze", {"image", "axes"}, {"wide"}) +
                     node("Squeeze", {"wide", "axes"}, {"output"})),
              each([](double v, int, int, int) { return v; }));
  expect_near(result(integers("axes", {-3}) +
                     node("ReduceSum", {"image", "axes"}, {"output"}, integer("keepdims", 0))),
              {27, 30, 33, 36, 39, 42, 45, 48});
  expect_near(result(integers("axes", {1}) + node("ReduceMax", {"image", "axes"}, {"output"}), 18),
              {17, 18, 19, 20, 21, 22, 23, 24});
}

TEST(RewriteOnnx, CutsAnyAxes) {
  const std::int64_t end = std::numeric_limits<std::int64_t>::max();
  expect_near(result(integers("s", {-3}) + integers("e", {end}) + integers("a", {-1}) +
                     node("Slice", {"image", "s", "e", "a"}, {"output"})),
              {2, 3, 4, 6, 7, 8, 10, 11, 12, 14, 15, 16, 18, 19, 20, 22, 23, 24});
  expect_near(
      result(integers("s", {1, 1}) + integers("e", {end, end}) + integers("a", {1, 3}) +
             integers("by", {1, 2}) + node("Slice", {"image", "s", "e", "a", "by"}, {"output"})),
      {10, 12, 14, 16, 18, 20, 22, 24});
  expect_near(result(integers("s", {1, 1}) + integers("e", {2, 3}) + integers("a", {2, 3}) +
                     node("Slice", {"image", "s", "e", "a"}, {"output"})),
              {6, 7, 14, 15, 22, 23});  // by steps of one, if none are given
  expect_near(
      result(integers("i", {-2}) + node("Gather", {"image", "i"}, {"output"}, integer("axis", 3))),
      {3, 7, 11, 15, 19, 23});
  expect_near(
      result(test::whole("i", 1) + node("Gather", {"image", "i"}, {"output"}, integer("axis", 1))),
      {9, 10, 11, 12, 13, 14, 15, 16});
}

TEST(RewriteOnnx, TakesLimitsOfClipFromInputs) {
  expect_near(result(floats("low", {}, {3}) + floats("high", {}, {20.5F}) +
                     node("Clip", {"image", "low", "high"}, {"output"})),
              each([](double v, int, int, int) { return std::clamp(v, 3.0, 20.5); }));
  expect_near(result(floats("high", {}, {20.5F}) + node("Clip", {"image", "", "high"}, {"output"})),
              each([](double v, int, int, int) { return std::min(v, 20.5); }));
}

/// Centers of cells as networks with dynamic axes compute them, from the image's shape.
TEST(RewriteOnnx, ComputesWhatDependsOnSizesAlone) {
  const std::string graph =
      node("Shape", {"image"}, {"shape"}) + constant_node("last", {}, {-1}) +
      constant_node("none", {}, {0}) + constant_node("one", {}, {1}) +
      node("Gather", {"shape", "last"}, {"columns"}) +
      node("Range", {"none", "columns", "one"}, {"counted"}) +
      node("Cast", {"counted"}, {"numbers"}, integer("to", 1)) + floats("half", {}, {0.5F}) +
      node("Add", {"numbers", "half"}, {"centers"}) + constant_node("first_two", {2}, {1, 2}) +
      node("Gather", {"shape", "first_two"}, {"middle"}) + constant_node("to_one", {1}, {1}) +
      constant_node("open", {1}, {-1}) +
      node("Concat", {"to_one", "middle", "open"}, {"target"}, integer("axis", 0));
  const std::string repeat =
      node("Reshape", {"image", "target"}, {"same"}) + node("Add", {"same", "centers"}, {"output"});
  for (const bool open : {false, true})
    expect_near(result(graph + repeat, 17, open),
                each([](double v, int, int, int x) { return v + x + 0.5; }));
}

// The second part of a constant that is split begins where the first ends.
TEST(RewriteOnnx, SplitsConstants) {
  const std::string parts =
      floats("all", {8}, {1, 2, 4, 8, 10, 20, 30, 40}) + integers("sizes", {4, 4}) +
      node("Split", {"all", "sizes"}, {"first", "second"}, integer("axis", 0)) +
      node("Mul", {"image", "first"}, {"scaled"}) + node("Add", {"scaled", "second"}, {"output"});
  expect_near(result(parts),
              each([](double v, int, int, int x) { return v * (1 << x) + 10 * (x + 1); }));
}

TEST(RewriteOnnx, ReadsHalfPrecision) {
  // 1, -2, 0.5, 2^-24 and 65504 in the format of IEEE 754.
  expect_near(result(test::halves("w", {1, 3, 1, 1}, {0x3c00, 0xc000, 0x3800}) +
                     node("Conv", {"image", "w"}, {"output"}, list("kernel_shape", {1, 1}))),
              {-8.5F, -9, -9.5F, -10, -10.5F, -11, -11.5F, -12});
  expect_near(result(test::halves("c", {4}, {0x0001, 0x7bff, 0x0000, 0x3c00}) +
                     node("Add", {"image", "c"}, {"output"})),
              each([](double v, int, int, int x) {
                return v + (x == 0 ? std::ldexp(1, -24) : x == 1 ? 65504 : x == 2 ? 0 : 1);
              }));
}

TEST(RewriteOnnx, TakesWholeModelsAlone) {
  EXPECT_FALSE(rewrite_onnx("this is not a network", {8, 8}));
  EXPECT_FALSE(rewrite_onnx("", {8, 8}));
  const std::string whole = test::onnx_yolov8_export(64, 64, {});
  ASSERT_TRUE(rewrite_onnx(whole, {64, 64}));
  for (std::size_t size = 0; size < whole.size(); size += 97)
    EXPECT_FALSE(rewrite_onnx(whole.substr(0, size), {64, 64})) << size;
}

/// Any byte may be wrong; sanitizers check that this is safe.
TEST(RewriteOnnx, SurvivesDamage) {
  const std::string whole = test::onnx_yolov8_export(32, 32, {.open_sides = true});
  int read = 0;
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    // Long runs of zeros are weights of kernels, not structure.
    if (at > 8 && whole.compare(at - 8, 16, std::string(16, '\0')) == 0) continue;
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    if (rewrite_onnx(damaged, {32, 32})) ++read;
  }
  EXPECT_GT(read, 100);
}

// A pooled tensor has one value per channel, and a constant of that shape is combined with it as it
// is.
TEST(RewriteOnnx, KnowsTheShapeOfWhatIsPooled) {
  const std::string c = floats("c", {kChannels, 1, 1}, {2, 3, 5});
  expect_near(
      result(c + node("GlobalAveragePool", {"image"}, {"mean"}) +
             node("Mul", {"mean", "c"}, {"scaled"}) + node("Add", {"image", "scaled"}, {"output"})),
      each([](double v, int channel, int, int) {
        const double factors[] = {2, 3, 5};
        return v + (8 * channel + 4.5) * factors[channel];
      }));
}

// Tensors that cannot be concatenated give no shape, no matter which axis differs.
TEST(OnnxShapes, JoinWhatDiffersAlongOneAxisAlone) {
  const auto joined = [](const OnnxShape& b) {
    const OnnxShape a = {1, 3, 4};
    OnnxNode concat;
    concat.op = "Concat";
    concat.inputs = {"a", "b"}, concat.outputs = {"c"};
    concat.set("axis", std::int64_t{1});
    return output_shapes({concat, 17, {&a, &b}, {nullptr, nullptr}}).at(0);
  };
  EXPECT_EQ(joined({1, 2, 4}), (OnnxShape{1, 5, 4}));
  EXPECT_FALSE(joined({2, 2, 4}));
  EXPECT_FALSE(joined({1, 2, 5}));
  EXPECT_FALSE(joined({1, 2}));
}

TEST(OnnxShapes, OfPoolsOverAllKeepImagesAndChannels) {
  const OnnxShape in = {2, 3, 5, 7};
  OnnxNode pool;
  pool.op = "GlobalAveragePool";
  pool.inputs = {"a"}, pool.outputs = {"b"};
  EXPECT_EQ(output_shapes({pool, 17, {&in}, {nullptr}}).at(0), (OnnxShape{2, 3, 1, 1}));
}

TEST(OnnxShapes, CutEachAxisByStepsOfOneUnlessOthersAreGiven) {
  const OnnxShape in = {4, 6}, two = {2};
  const OnnxTensor starts{two, false, {1, 2}}, ends{two, false, {4, 6}}, steps{two, false, {2, 3}};
  OnnxNode slice;
  slice.op = "Slice";
  slice.inputs = {"a", "starts", "ends"}, slice.outputs = {"b"};
  EXPECT_EQ(output_shapes({slice, 17, {&in, &two, &two}, {nullptr, &starts, &ends}}).at(0),
            (OnnxShape{3, 4}));
  slice.inputs = {"a", "starts", "ends", "", "steps"};
  EXPECT_EQ(
      output_shapes(
          {slice, 17, {&in, &two, &two, nullptr, &two}, {nullptr, &starts, &ends, nullptr, &steps}})
          .at(0),
      (OnnxShape{2, 2}));
}

// Fields of 8 and of 4 bytes, which newer exporters may add, are skipped as a whole.
TEST(Protobuf, PassesOverFieldsOfFixedSize) {
  const std::string eight(
      "\x09"
      "\x02\x00\x00\x00\x00\x00\x00\x00",
      9),
      four(
          "\x15"
          "\x01\x02\x03\x04",
          5);
  const std::string message = eight + proto_number(3, 7) + four + proto_number(3, 9);
  ProtoMessage walk(message);
  const auto first = walk.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->tag, 1u);
  EXPECT_EQ(first->bytes, std::string_view(eight).substr(1));
  EXPECT_EQ(proto_varints(message, 3), (std::vector<std::uint64_t>{7, 9}));
  EXPECT_EQ(proto_bytes(message, 2), std::string_view(four).substr(1));
}

}  // namespace
}  // namespace mh
