// SPDX-License-Identifier: Apache-2.0
#include "tests/slam/detect/made_networks.hpp"

#include <cstring>

#include <fmt/format.h>

namespace mh::test {
namespace {

// Protocol Buffers, as far as onnx.proto needs them.
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

std::string node(const std::string& op, const std::vector<std::string>& in, const std::string& out,
                 const std::string& attributes = "") {
  std::string n;
  for (const std::string& name : in) n += bytes(1, name);
  return bytes(1, n + bytes(2, out) + bytes(3, out) + bytes(4, op) + attributes);
}

std::string value(int tag, const std::string& name, const std::vector<std::int64_t>& dims) {
  std::string shape;
  for (const std::int64_t dim : dims) shape += bytes(1, number(1, dim));
  return bytes(tag, bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, shape))));
}

std::string model(const std::string& graph) {
  return number(1, 7) + bytes(7, graph) + bytes(8, number(2, 11));
}

}  // namespace

std::string onnx_segmentation(int width, int height, const std::vector<float>& weights) {
  const auto classes = static_cast<std::int64_t>(weights.size() / 3);
  return model(node("Conv", {"image", "weights"}, "classes", list("kernel_shape", {1, 1})) +
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
    // The fifth value: of blue, green, red the last plane, at the cell's center.
    const auto center = static_cast<std::size_t>((stride / 2) * stride + stride / 2);
    kernel[4 * 3 * area + 2 * area + center] = 1.0F / 255;
    for (int anchor = 0; anchor < head.boxes_per_cell; ++anchor) {
      const std::string name = fmt::format("{}_{}", stride, anchor);
      weights += floats("w" + name, {per_box, 3, stride, stride}, kernel) +
                 floats("b" + name, {per_box}, bias) + integers("s" + name, {1, per_box, -1});
      nodes += node("Conv", {"image", "w" + name, "b" + name}, "c" + name,
                    list("kernel_shape", {stride, stride}) + list("strides", {stride, stride})) +
               node("Reshape", {"c" + name, "s" + name}, "r" + name);
      parts.push_back("r" + name);
      boxes += std::int64_t{width / stride} * (height / stride);
    }
  }
  nodes += node("Concat", parts, head.yolov8 ? "output" : "all", integer("axis", 2));
  if (!head.yolov8) nodes += node("Transpose", {"all"}, "output", list("perm", {0, 2, 1}));
  return model(nodes + bytes(2, "made") + weights + value(11, "image", {1, 3, height, width}) +
               (head.yolov8 ? value(12, "output", {1, per_box, boxes})
                            : value(12, "output", {1, boxes, per_box})));
}

std::string onnx_unknown_operator() {
  return model(node("Levitate", {"image"}, "output") + bytes(2, "made") +
               value(11, "image", {1, 3, 32, 32}) + value(12, "output", {1, 3, 32, 32}));
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
    bias[5] = 10, bias[6] = -10;  // if any, the first class
  }
  // The objectness of the first anchor: mean red (0 to 1), the first plane, times 40.
  for (int p = 0; p < kPixels; ++p) kernel[(4 * 3 + 0) * kPixels + p] = 40.0F / kPixels;
  values.insert(values.end(), kernel.begin(), kernel.end());
  const std::vector<std::int32_t> head = {0, 2, 0, 0, 0};
  return raw(head) + raw(values);
}

}  // namespace mh::test
