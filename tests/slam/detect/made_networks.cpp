// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/detect/made_networks.hpp"

#include <array>
#include <cstring>

#include <fmt/format.h>

namespace mh::test {

namespace {

// Protocol Buffers, as far as needed for onnx.proto.
std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7) bytes += static_cast<char>(value | 0x80);
  return bytes + static_cast<char>(value);
}
std::string number(int tag, std::int64_t value) {
  return varint(static_cast<std::uint64_t>(tag) << 3) + varint(static_cast<std::uint64_t>(value));
}
std::string bytes(int tag, const std::string& content) {
  return varint(static_cast<std::uint64_t>(tag) << 3 | 2) + varint(content.size()) + content;
}

template <class T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string tensor(const std::string& name, const std::vector<std::int64_t>& dims, int type,
                   const std::string& content) {
  std::string t;
  for (const std::int64_t dim : dims) t += number(1, dim);
  return t + number(2, type) + bytes(8, name) + bytes(9, content);
}

}  // namespace

std::string floats(const std::string& name, const std::vector<std::int64_t>& dims,
                   const std::vector<float>& values) {
  return bytes(5, tensor(name, dims, 1, raw(values)));
}
std::string integers(const std::string& name, const std::vector<std::int64_t>& values) {
  return bytes(5, tensor(name, {static_cast<std::int64_t>(values.size())}, 7, raw(values)));
}

std::string list(const std::string& name, const std::vector<std::int64_t>& values) {
  std::string a = bytes(1, name);
  for (const std::int64_t v : values) a += number(8, v);
  return bytes(5, a + number(20, 7));
}
std::string integer(const std::string& name, std::int64_t value) {
  return bytes(5, bytes(1, name) + number(3, value) + number(20, 2));
}

std::string node(const std::string& op, const std::vector<std::string>& in,
                 const std::vector<std::string>& out, const std::string& attributes) {
  std::string n;
  for (const std::string& name : in) n += bytes(1, name);
  for (const std::string& name : out) n += bytes(2, name);
  return bytes(1, n + bytes(3, out[0]) + bytes(4, op) + attributes);
}

std::string value(int tag, const std::string& name, const std::vector<std::int64_t>& dims) {
  std::string shape;
  for (const std::int64_t dim : dims)
    shape += bytes(1, dim > 0 ? number(1, dim) : bytes(2, "open"));
  return bytes(tag, bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, shape))));
}

std::string model(const std::string& graph, int opset) {
  return number(1, 7) + bytes(7, bytes(2, "made") + graph) + bytes(8, number(2, opset));
}

std::string metadata(const std::string& key, const std::string& content) {
  return bytes(14, bytes(1, key) + bytes(2, content));
}

std::string halves(const std::string& name, const std::vector<std::int64_t>& dims,
                   const std::vector<std::uint16_t>& bits) {
  return bytes(5, tensor(name, dims, 10, raw(bits)));
}

std::string whole(const std::string& name, std::int64_t number) {
  return bytes(5, tensor(name, {}, 7, raw(std::vector{number})));
}

std::string constant_node(const std::string& name, const std::vector<std::int64_t>& dims,
                          const std::vector<std::int64_t>& values) {
  return node(
      "Constant", {}, {name},
      bytes(5, bytes(1, "value") + bytes(5, tensor("", dims, 7, raw(values))) + number(20, 4)));
}

std::string onnx_segmentation(int width, int height, const std::vector<float>& weights) {
  const auto classes = static_cast<std::int64_t>(weights.size() / 3);
  return model(node("Conv", {"image", "weights"}, {"classes"}, list("kernel_shape", {1, 1})) +
               bytes(2, "made") + floats("weights", {classes, 3, 1, 1}, weights) +
               value(11, "image", {1, 3, height, width}) +
               value(12, "classes", {1, classes, height, width}));
}

std::string onnx_detection(int width, int height, const MadeHead& head) {
  const int per_box = (head.yolov8 ? 4 : 5) + static_cast<int>(head.classes.size());
  std::string nodes, weights;
  std::vector<std::string> parts;
  std::int64_t boxes = 0;
  for (const int stride : {8, 16, 32}) {
    const auto area = static_cast<std::size_t>(stride * stride);
    std::vector<float> kernel(static_cast<std::size_t>(per_box) * 3 * area, 0.0F), bias = head.box;
    if (!head.yolov8) bias.push_back(0);
    bias.insert(bias.end(), head.classes.begin(), head.classes.end());
    if (head.yolov8) bias[4] = 0;
    // The fifth value is the last of the planes (blue, green, red) at the center of the cell.
    const auto center = static_cast<std::size_t>((stride / 2) * stride + stride / 2);
    kernel[4 * 3 * area + 2 * area + center] = 1.0F / 255;
    for (int anchor = 0; anchor < head.boxes_per_cell; ++anchor) {
      const std::string name = fmt::format("{}_{}", stride, anchor);
      weights += floats("w" + name, {per_box, 3, stride, stride}, kernel) +
                 floats("b" + name, {per_box}, bias) + integers("s" + name, {1, per_box, -1});
      nodes += node("Conv", {"image", "w" + name, "b" + name}, {"c" + name},
                    list("kernel_shape", {stride, stride}) + list("strides", {stride, stride})) +
               node("Reshape", {"c" + name, "s" + name}, {"r" + name});
      parts.push_back("r" + name);
      boxes += std::int64_t{width / stride} * (height / stride);
    }
  }
  nodes += node("Concat", parts, {head.yolov8 ? "output" : "all"}, integer("axis", 2));
  if (!head.yolov8) nodes += node("Transpose", {"all"}, {"output"}, list("perm", {0, 2, 1}));
  return model(nodes + weights + value(11, "image", {1, 3, height, width}) +
               (head.yolov8 ? value(12, "output", {1, per_box, boxes})
                            : value(12, "output", {1, boxes, per_box})));
}

std::string onnx_yolov8_export(int width, int height, const MadeExport& as) {
  constexpr std::int64_t kBins = 16, kClasses = 2, kPerCell = 4 * kBins + kClasses;
  constexpr std::array<std::int64_t, 4> kSides = {1, 2, 2,
                                                  4};  // left, top, right, bottom, in cells
  std::string nodes, weights;
  std::vector<std::string> scales;
  std::vector<float> xs, ys, strides;
  for (const int stride : {8, 16, 32}) {
    const auto area = static_cast<std::size_t>(stride * stride);
    std::vector<float> kernel(static_cast<std::size_t>(kPerCell) * 3 * area, 0.0F),
        bias(static_cast<std::size_t>(kPerCell), 0.0F);
    for (std::size_t side = 0; side < 4; ++side)
      bias[side * kBins + static_cast<std::size_t>(kSides[side])] = 60;
    bias[kPerCell - 2] = bias[kPerCell - 1] = -10;
    const auto center = static_cast<std::size_t>((stride / 2) * stride + stride / 2);
    kernel[(kPerCell - 2) * 3 * area + center] = 20;  // red, 0 to 1
    const std::string name = std::to_string(stride);
    weights += floats("w" + name, {kPerCell, 3, stride, stride}, kernel) +
               floats("b" + name, {kPerCell}, bias) + integers("s" + name, {1, kPerCell, -1});
    nodes += node("Conv", {"image", "w" + name, "b" + name}, {"c" + name},
                  list("kernel_shape", {stride, stride}) + list("strides", {stride, stride})) +
             node("Reshape", {"c" + name, "s" + name}, {"r" + name});
    scales.push_back("r" + name);
    for (int y = 0; y < height / stride; ++y)
      for (int x = 0; x < width / stride; ++x) {
        xs.push_back(static_cast<float>(x) + 0.5F);
        ys.push_back(static_cast<float>(y) + 0.5F);
        strides.push_back(static_cast<float>(stride));
      }
  }
  const auto cells = static_cast<std::int64_t>(xs.size());
  xs.insert(xs.end(), ys.begin(), ys.end());
  std::vector<float> bins;
  for (std::int64_t i = 0; i < kBins; ++i) bins.push_back(static_cast<float>(i));
  nodes += node("Concat", scales, {"all"}, integer("axis", 2));
  if (as.opset < 13) {
    nodes += node("Split", {"all"}, {"box", "class"},
                  integer("axis", 1) + list("split", {4 * kBins, kClasses}));
  } else {
    weights += integers("sizes", {4 * kBins, kClasses});
    nodes += node("Split", {"all", "sizes"}, {"box", "class"}, integer("axis", 1));
  }
  weights += integers("by_bin", {1, 4, kBins, -1}) + floats("bins", {1, kBins, 1, 1}, bins) +
             integers("by_side", {1, 4, -1}) + floats("anchors", {1, 2, cells}, xs) +
             floats("strides", {1, cells}, strides) + floats("two", {}, {2});
  nodes += node("Reshape", {"box", "by_bin"}, {"bin"}) +
           node("Transpose", {"bin"}, {"turned"}, list("perm", {0, 2, 1, 3})) +
           node("Softmax", {"turned"}, {"shares"}, integer("axis", 1)) +
           node("Conv", {"shares", "bins"}, {"mean"}, list("kernel_shape", {1, 1})) +
           node("Reshape", {"mean", "by_side"}, {"sides"});
  // PyTorch exports chunk(2, 1) like this: half of the size is computed from the shape.
  nodes += node("Shape", {"sides"}, {"shape"}) + constant_node("one", {}, {1}) +
           constant_node("halves", {}, {2}) + constant_node("axis", {1}, {1}) +
           constant_node("zero", {1}, {0}) + constant_node("times_one", {1}, {1}) +
           constant_node("times_two", {1}, {2}) +
           node("Gather", {"shape", "one"}, {"count"}, integer("axis", 0)) +
           node("Add", {"count", "times_one"}, {"more"}) +
           node("Div", {"more", "halves"}, {"half"}) +
           node("Mul", {"half", "times_one"}, {"first"}) +
           node("Mul", {"half", "times_two"}, {"second"}) +
           node("Slice", {"sides", "zero", "first", "axis"}, {"to_left_top"}) +
           node("Slice", {"sides", "first", "second", "axis"}, {"to_right_bottom"});
  nodes += node("Sub", {"anchors", "to_left_top"}, {"left_top"}) +
           node("Add", {"anchors", "to_right_bottom"}, {"right_bottom"}) +
           node("Add", {"left_top", "right_bottom"}, {"sum"}) +
           node("Div", {"sum", "two"}, {"xy"}) +
           node("Sub", {"right_bottom", "left_top"}, {"size"}) +
           node("Concat", {"xy", "size"}, {"boxes"}, integer("axis", 1)) +
           node("Mul", {"boxes", "strides"}, {"pixels"}) + node("Sigmoid", {"class"}, {"score"}) +
           node("Concat", {"pixels", "score"}, {"output"}, integer("axis", 1));
  const std::vector<std::int64_t> image = as.open_sides
                                              ? std::vector<std::int64_t>{0, 3, 0, 0}
                                              : std::vector<std::int64_t>{1, 3, height, width};
  return model(nodes + weights + value(11, "image", image) +
                   value(12, "output", {image[0], 4 + kClasses, as.open_sides ? 0 : cells}),
               as.opset) +
         as.metadata;
}

std::string onnx_unknown_operator() {
  return model(node("Levitate", {"image"}, {"output"}) + value(11, "image", {1, 3, 32, 32}) +
               value(12, "output", {1, 3, 32, 32}));
}

std::string darknet_config(int width, int height) {
  return fmt::format(
      "[net]\nwidth={}\nheight={}\nchannels=3\n\n"
      "[convolutional]\nfilters=21\nsize=8\nstride=8\npad=0\nactivation=linear\n\n"
      "[yolo]\nmask=0,1,2\nanchors=8,8, 16,16, 24,24\nclasses=2\nnum=3\n",
      width, height);
}

std::string darknet_weights() {
  constexpr int kChannels = 21, kPerBox = 7, kPixels = 64;
  std::vector<float> values(kChannels, 0.0F), kernel(kChannels * 3 * kPixels, 0.0F);
  for (int anchor = 0; anchor < 3; ++anchor) {
    float* bias = values.data() + anchor * kPerBox;
    bias[4] = -20;                // no object
    bias[5] = 10, bias[6] = -10;  // but if there is one, it has the first class
  }
  // The objectness of the first anchor is 40 times the mean of the first plane, red (0 to 1).
  for (int p = 0; p < kPixels; ++p) kernel[(4 * 3 + 0) * kPixels + p] = 40.0F / kPixels;
  values.insert(values.end(), kernel.begin(), kernel.end());
  const std::vector<std::int32_t> head = {0, 2, 0, 0, 0};
  return raw(head) + raw(values);
}

}  // namespace mh::test
