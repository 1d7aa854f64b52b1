// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "slam/detect/detected_sequence.hpp"
#include "slam/detect/detector.hpp"
#include "slam/detect/onnx_input.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"
#include "tests/slam/core/made_sequence.hpp"
#include "tests/slam/detect/made_networks.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// The error message of a detector that must not open.
std::string refusal(const DetectorSpec& spec) {
  try {
    open_detector(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

#define EXPECT_SAYS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

class Networks : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& content) {
    write_atomically(folder_.path() / name, content);
    return folder_.path() / name;
  }
  /// A network with two classes, chair and table.
  DetectorSpec two_classes(const std::string& name, const std::string& content) {
    return {.network = write(name, content),
            .config = {},
            .classes = write("two.names", "chair\ntable\n\n"),
            .boxes = {},
            .settings = {}};
  }
  /// Black, with a red square of 3 x 3 px around each of these pixels.
  static Grid2d<Rgb8> red_at(int width, int height, const std::vector<std::pair<int, int>>& at) {
    Grid2d<Rgb8> image(width, height);
    for (const auto& [cx, cy] : at)
      for (int y = cy - 1; y <= cy + 1; ++y)
        for (int x = cx - 1; x <= cx + 1; ++x) image(x, y) = {255, 0, 0};
    return image;
  }

  TemporaryFolder folder_{fs::temp_directory_path()};
};

TEST_F(Networks, YoloxFindsTheCellThatIsRed) {
  const auto detector = open_detector(two_classes("a.onnx", test::onnx_detection(64, 32, {})));
  EXPECT_EQ(detector->description(), "yolox, 2 classes, input 64 x 32");
  // The image is twice the size of the input: its pixel (88, 40) becomes (44, 20), the center of
  // the cell (5, 2) of 8 px.
  const Detected found = detector->detect(red_at(128, 64, {{88, 40}}), 0, 0);
  ASSERT_EQ(found.boxes.size(), 1U);
  const DetectedBox& box = found.boxes[0];
  EXPECT_NEAR(box.left, 2 * (5.5 * 8 - 4), 1e-4);
  EXPECT_NEAR(box.right, 2 * (5.5 * 8 + 4), 1e-4);
  EXPECT_NEAR(box.top, 2 * (2.5 * 8 - 4), 1e-4);
  EXPECT_NEAR(box.score, 1, 1e-3);
  EXPECT_EQ(box.classes.most_probable(), *class_by_name("chair"));
}

TEST_F(Networks, YoloxIsBgrAndOthersAreRgb) {
  // With values scaled to 0 to 1, the head's factor of 1 / 255 leaves 1 / 255 of a score.
  DetectorSpec spec =
      two_classes("a.onnx", test::onnx_detection(64, 32, {.box = {32, 16, 10, 8}, .yolov8 = true}));
  spec.settings.normalize = Normalize::kNone;
  const auto v8 = open_detector(spec);
  EXPECT_EQ(v8->description(), "yolov8, 2 classes, input 64 x 32");
  const Grid2d<Rgb8> red = red_at(64, 32, {{44, 20}});
  EXPECT_TRUE(v8->detect(red, 0, 0).boxes.empty());  // here the third plane is blue
  Grid2d<Rgb8> blue = red;
  for (Rgb8& pixel : blue) std::swap(pixel.r, pixel.b);
  const Detected found = v8->detect(blue, 0, 0);
  ASSERT_EQ(found.boxes.size(), 1U);
  EXPECT_EQ(found.boxes[0].left, 27);
  EXPECT_EQ(found.boxes[0].bottom, 20);
}

TEST_F(Networks, Yolov5HasThreeBoxesInACell) {
  DetectorSpec spec = two_classes(
      "a.onnx", test::onnx_detection(
                    64, 32, {.box = {32, 16, 10, 8}, .classes = {0, 1}, .boxes_per_cell = 3}));
  spec.settings.normalize = Normalize::kNone;
  spec.settings.channels = Channels::kBgr;
  const auto detector = open_detector(spec);
  EXPECT_EQ(detector->description(), "yolov5, 2 classes, input 64 x 32");
  const Detected found = detector->detect(red_at(64, 32, {{44, 20}}), 0, 0);
  ASSERT_EQ(found.boxes.size(), 1U);  // the other two boxes are equal to it
  EXPECT_EQ(found.boxes[0].classes.most_probable(), *class_by_name("table"));
  EXPECT_NEAR(found.boxes[0].score, 1, 1e-6);
}

/// Expects what onnx_yolov8_export() finds if the pixel (44, 20) is red: the center of the cell (5,
/// 2) of 8 px.
void expect_the_red_cell(const Detector& detector, const Grid2d<Rgb8>& image) {
  const Detected found = detector.detect(image, 0, 0);
  ASSERT_EQ(found.boxes.size(), 1U);
  const DetectedBox& box = found.boxes[0];
  EXPECT_NEAR(box.left, (5.5 - 1) * 8, 1e-3);
  EXPECT_NEAR(box.top, (2.5 - 2) * 8, 1e-3);
  EXPECT_NEAR(box.right, (5.5 + 2) * 8, 1e-3);
  EXPECT_NEAR(box.bottom, (2.5 + 4) * 8, 1e-3);
  EXPECT_NEAR(box.score, 1 / (1 + std::exp(-10.0)), 1e-5);
  EXPECT_EQ(box.classes.most_probable(), *class_by_name("chair"));
}

TEST_F(Networks, Yolov8RunsAsUltralyticsExportsIt) {
  for (const test::MadeExport& as :
       {test::MadeExport{.opset = 12}, {.opset = 17}, {.opset = 17, .open_sides = true}}) {
    DetectorSpec spec = two_classes("v8.onnx", test::onnx_yolov8_export(64, 96, as));
    if (as.open_sides) spec.settings.width_px = 64, spec.settings.height_px = 96;
    const auto detector = open_detector(spec);
    EXPECT_EQ(detector->description(), "yolov8, 2 classes, input 64 x 96");
    expect_the_red_cell(*detector, red_at(64, 96, {{44, 20}}));
  }
}

TEST_F(Networks, TakeTheClassesAndTheSizeThatTheirMetadataState) {
  const std::string names = test::metadata("names", "{0: 'chair', 1: \"driver's seat\"}") +
                            test::metadata("imgsz", "[96, 64]") + test::metadata("task", "detect");
  DetectorSpec spec = two_classes(
      "v8.onnx", test::onnx_yolov8_export(64, 96, {.open_sides = true, .metadata = names}));
  spec.classes.clear();
  const auto detector = open_detector(spec);
  EXPECT_EQ(detector->description(), "yolov8, 2 classes, input 64 x 96");
  EXPECT_EQ(detector->names().names, (std::vector<std::string>{"chair", "driver's seat"}));
  expect_the_red_cell(*detector, red_at(64, 96, {{44, 20}}));
  const std::uint64_t digest = detector->digest();
  spec.classes = write("other.names", "chair\nbed\n");
  EXPECT_EQ(open_detector(spec)->names().names[1], "bed");
  EXPECT_NE(open_detector(spec)->digest(), digest);
}

TEST_F(Networks, WhoseMetadataSayThatTheyAreNotReadAreRefused) {
  const auto says = [&](const std::string& metadata) {
    DetectorSpec spec = two_classes("v8.onnx", test::onnx_yolov8_export(64, 96, {}) + metadata);
    spec.classes.clear();
    return refusal(spec);
  };
  for (const char* task : {"segment", "pose", "obb", "classify"})
    EXPECT_SAYS(says(test::metadata("task", task)),
                std::string("v8.onnx: is for the task '") + task + "'");
  EXPECT_SAYS(says(test::metadata("names", "{0: 'chair'}")),
              "has 2 classes, and its metadata names 1");
  EXPECT_SAYS(says(test::metadata("names", "chair, table")),
              "its metadata's `names` is not a list of classes: 'chair, table'");
}

TEST_F(Networks, ThatOpencvLacksAnOperatorForSayWhatToExport) {
  const auto of = [&](const std::string& op) {
    return refusal(two_classes("a.onnx", test::model(test::node(op, {"image"}, {"output"}) +
                                                     test::value(11, "image", {1, 3, 32, 32}) +
                                                     test::value(12, "output", {1, 3, 32, 32}))));
  };
  EXPECT_SAYS(of("NonMaxSuppression"),
              "it selects its boxes itself ([NonMaxSuppression]): export it without (nms=False");
  EXPECT_SAYS(of("Levitate"), "`yolo export format=onnx opset=12 simplify=True`");
}

TEST_F(Networks, SegmentationGivesPixelsTheirClass) {
  DetectorSpec spec = two_classes(
      "a.onnx", test::onnx_segmentation(64, 32, {0.2F, 0, 0, 0, 0, 0.2F}));  // red, blue
  spec.settings.normalize = Normalize::kNone;
  const auto detector = open_detector(spec);
  EXPECT_EQ(detector->description(), "segmentation, 2 classes, input 64 x 32");
  Grid2d<Rgb8> image(64, 32, {255, 0, 0});
  for (int y = 0; y < 32; ++y)
    for (int x = 40; x < 64; ++x) image(x, y) = {0, 0, 255};
  const SemanticImage pixels = detector->detect(image, 0, 0).pixels;
  EXPECT_EQ(pixels.at(10, 10).most_probable(), *class_by_name("chair"));
  EXPECT_EQ(pixels.at(60, 10).most_probable(), *class_by_name("table"));
  EXPECT_EQ(pixels.at(39, 10).most_probable(), *class_by_name("chair"));
}

TEST_F(Networks, DarknetFindsTheCellThatIsRed) {
  DetectorSpec spec = two_classes("a.weights", test::darknet_weights());
  spec.config = write("a.cfg", test::darknet_config(64, 32));
  const auto detector = open_detector(spec);
  EXPECT_EQ(detector->description(), "darknet, 2 classes, input 64 x 32");
  Grid2d<Rgb8> image(64, 32);
  for (int y = 16; y < 24; ++y)
    for (int x = 40; x < 48; ++x) image(x, y) = {255, 0, 0};
  const Detected found = detector->detect(image, 0, 0);
  ASSERT_EQ(found.boxes.size(), 1U);
  EXPECT_NEAR(found.boxes[0].left, 40, 1e-3);  // 8 px wide, around the center of the cell
  EXPECT_NEAR(found.boxes[0].right, 48, 1e-3);
  EXPECT_NEAR(found.boxes[0].top, 16, 1e-3);
  EXPECT_EQ(found.boxes[0].classes.most_probable(), *class_by_name("chair"));
}

TEST_F(Networks, GiveTheSameBitsAgain) {
  const DetectorSpec spec = two_classes("a.onnx", test::onnx_detection(64, 32, {}));
  const auto first = open_detector(spec), second = open_detector(spec);
  const Grid2d<Rgb8> image = red_at(100, 70, {{88, 40}, {20, 20}, {50, 60}});
  EXPECT_EQ(first->detect(image, 0, 0), second->detect(image, 1, 1));
  EXPECT_EQ(first->detect(image, 0, 0), first->detect(image, 0, 0));
  EXPECT_EQ(first->digest(), second->digest());
}

TEST_F(Networks, DigestFollowsWhatDecidesTheBoxes) {
  const DetectorSpec spec = two_classes("a.onnx", test::onnx_detection(64, 32, {}));
  const std::uint64_t digest = open_detector(spec)->digest();
  DetectorSpec other = spec;
  other.settings.confidence = 0.5;
  EXPECT_NE(open_detector(other)->digest(), digest);
  other = spec;
  other.settings.fill = BoxFill::kForeground;
  EXPECT_EQ(open_detector(other)->digest(), digest);
  write("a.onnx", test::onnx_detection(64, 32, {.classes = {0.9F, 0}}));
  EXPECT_NE(open_detector(spec)->digest(), digest);
}

TEST_F(Networks, ReportWhatTheyRead) {
  DetectorSpec spec = two_classes("a.weights", test::darknet_weights());
  spec.config = write("a.cfg", test::darknet_config(64, 32));
  const ReadScope scope;
  open_detector(spec);
  std::vector<std::string> read;
  for (const FileObservation& o : scope.record().observations)
    if (o.kind == FileObservation::Kind::kRead) read.push_back(o.path.filename().string());
  for (const char* name : {"a.weights", "a.cfg", "two.names"})
    EXPECT_NE(std::ranges::find(read, name), read.end()) << name;
}

TEST_F(Networks, AreRefusedInOneLine) {
  DetectorSpec spec = two_classes("a.onnx", "this is not a network");
  EXPECT_SAYS(refusal(spec), "a.onnx: OpenCV");
  spec = two_classes("empty.onnx", "");
  EXPECT_SAYS(refusal(spec), "empty.onnx: is empty");
  spec = two_classes("levitate.onnx", test::onnx_unknown_operator());
  EXPECT_SAYS(refusal(spec), "Levitate");
  spec = two_classes("other.onnx", test::onnx_segmentation(1, 1, {1, 0, 0, 0, 0, 1}));
  EXPECT_SAYS(refusal(spec), "its output (1 x 2 x 1 x 1)");
  spec.settings.head = Head::kYolov5;
  EXPECT_SAYS(refusal(spec), "its output (1 x 2 x 1 x 1) is not that of head 'yolov5'");
  EXPECT_EQ(refusal(spec).find("auto"), std::string::npos) << refusal(spec);
  spec = two_classes("three.onnx", test::onnx_detection(64, 32, {.classes = {1, 0, 0}}));
  EXPECT_SAYS(refusal(spec), "two.names: names 2 classes, and ");
  spec.classes.clear();
  EXPECT_SAYS(refusal(spec), "three.onnx: has 3 classes, not COCO's 80");
  spec = two_classes("fixed.onnx", test::onnx_detection(64, 32, {}));
  spec.settings.width_px = 96;
  EXPECT_SAYS(refusal(spec), "its input is fixed to 64 x 32");
  spec = two_classes("wide.onnx", test::onnx_segmentation(40000, 8, {1, 0, 0, 0, 0, 1}));
  EXPECT_SAYS(refusal(spec), "its input is fixed to 40000 x 8: at most 8192 pixels");
  spec.network = folder_.path() / "missing.onnx";
  EXPECT_SAYS(refusal(spec), "missing.onnx");
  for (const std::string& text : {refusal(spec)}) EXPECT_EQ(text.find('\n'), text.npos);
}

TEST_F(Networks, ThatTakeSeveralImagesAtOnceAreRefused) {
  std::string two = test::onnx_segmentation(8, 8, {1, 0, 0, 0, 0, 1});
  const std::string shape("\x0a\x02\x08\x01\x0a\x02\x08\x03\x0a\x02\x08\x08", 12);  // 1 x 3 x 8
  const auto at = two.find(shape);
  ASSERT_NE(at, std::string::npos);
  two[at + 3] = 2;
  EXPECT_SAYS(refusal(two_classes("two.onnx", two)), "two.onnx: takes 2 images at once");
}

// OpenCV would read past the end of the weights, and give different boxes each time.
TEST_F(Networks, WithFewerWeightsThanTheirShapeStatesAreRefused) {
  const std::string whole = test::onnx_segmentation(8, 8, {1, 0, 0, 0, 0, 1});
  std::string less = whole;
  const std::size_t shape = less.find(std::string("\x08\x02\x08\x03\x08\x01\x08\x01", 8));
  ASSERT_NE(shape, less.npos);
  less[shape + 1] = '\x40';  // 64 x 3 x 1 x 1, although there are only the weights of 2 x 3
  EXPECT_SAYS(refusal(two_classes("less.onnx", less)), "hold 6 values, but their shape needs 192");
}

TEST(OnnxWeights, AreCountedByTheSizeOfTheirType) {
  const auto fault = [](const std::string& weights) {
    return onnx_weights_fault(test::model(weights, 17));
  };
  EXPECT_EQ(fault(test::halves("w", {2}, {0x3c00, 0x3c00})), "");
  EXPECT_EQ(fault(test::floats("w", {2}, {1, 2})), "");
  EXPECT_EQ(fault(test::integers("w", {1, 2})), "");
  EXPECT_SAYS(fault(test::halves("w", {4}, {0x3c00, 0x3c00})),
              "hold 2 values, but their shape needs 4");
}

TEST_F(Networks, WhoseValuesAreNoNumbersAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_SAYS(refusal(two_classes("nan.onnx", test::onnx_segmentation(8, 8, {nan, 0, 0, 0, 0, 1}))),
              "nan.onnx: weights 'weights' hold a value that is not a number");
}

TEST_F(Networks, AreNotReadByAHeadThatTheyCannotHave) {
  DetectorSpec spec = two_classes("yolox.onnx", test::onnx_detection(64, 32, {}));
  for (const Head head : {Head::kYolov5, Head::kDarknet}) {
    spec.settings.head = head;
    EXPECT_SAYS(refusal(spec), "is not that of head '");
  }
}

TEST_F(Networks, CutShortAnywhereNeverCrash) {
  const std::string whole = test::onnx_detection(32, 32, {});
  for (const std::size_t size :
       {1UL, 5UL, 30UL, whole.size() / 2, whole.size() - 20, whole.size() - 1})
    EXPECT_SAYS(refusal(two_classes("cut.onnx", whole.substr(0, size))), "cut.onnx: ");
  const std::string rewritten = test::onnx_yolov8_export(64, 96, {});
  for (const std::size_t size : {rewritten.size() / 3, rewritten.size() - 20, rewritten.size() - 1})
    EXPECT_SAYS(refusal(two_classes("cut.onnx", rewritten.substr(0, size))), "cut.onnx: ");
  const std::string weights = test::darknet_weights();
  DetectorSpec spec = two_classes("cut.weights", "");
  spec.config = write("a.cfg", test::darknet_config(64, 32));
  for (const std::size_t size : {0UL, 8UL, 20UL, 100UL, weights.size() - 4}) {
    write("cut.weights", weights.substr(0, size));
    EXPECT_SAYS(refusal(spec), "cut.weights: ");
  }
  write("cut.weights", weights + "more");
  EXPECT_SAYS(refusal(spec), "it belongs to another network");
  write("cut.weights", weights);
  const std::string config = test::darknet_config(64, 32);
  for (std::size_t size = 0; size + 30 < config.size(); size += 7) {
    write("a.cfg", config.substr(0, size));
    EXPECT_NE(refusal(spec), "") << config.substr(0, size);
  }
}

TEST_F(Networks, OfDarknetAreRefusedByTheConfigurationsLine) {
  DetectorSpec spec = two_classes("a.weights", test::darknet_weights());
  const std::string good = test::darknet_config(64, 32);
  const auto with = [&](const std::string& old, const std::string& instead) {
    std::string text = good;
    text.replace(text.find(old), old.size(), instead);
    spec.config = write("a.cfg", text);
    return refusal(spec);
  };
  spec.config = write("a.cfg", good);
  EXPECT_EQ(refusal(spec), "");
  spec.config = write("a.cfg", "\xef\xbb\xbf" + good);
  EXPECT_EQ(open_detector(spec)->description(), "darknet, 2 classes, input 64 x 32");
  EXPECT_SAYS(with("width=64", "width=9000"), "a.cfg:2: width = 9000: a side is a whole number");
  EXPECT_SAYS(with("width=64", "Width=64"), "a.cfg: section [net] has no width");
  EXPECT_SAYS(with("mask=0,1,2", "mask=0,1,3"), "mask = 0,1,3: there is no anchor 3 among 3");
  EXPECT_SAYS(with("mask=0,1,2", "mask=-3,1,2"), "there is no anchor -3 among 3");
  EXPECT_SAYS(with("[yolo]", "[route]\nlayers=-9\n[yolo]"),
              "layers = -9: no layer before this one");
  EXPECT_SAYS(with("[yolo]", "[shortcut]\nfrom=7\n[yolo]"), "from = 7: no layer before this one");
  EXPECT_SAYS(with("8,8, 16", "-8,8, 16"), "a side of a box is positive");
  EXPECT_SAYS(with("8,8, 16", "nan,8, 16"), "'nan' is not a number");
  EXPECT_SAYS(with("[convolutional]", "[convolute]"), "a.cfg: ");
}

TEST_F(Networks, WithWeightsThatAreNoNumbersAreRefused) {
  DetectorSpec spec = two_classes("a.weights", "");
  spec.config = write("a.cfg", test::darknet_config(64, 32));
  std::string weights = test::darknet_weights();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(weights.data() + weights.size() - sizeof nan, &nan, sizeof nan);
  write("a.weights", weights);
  EXPECT_SAYS(refusal(spec), "is not a finite number");
}

TEST_F(Networks, DetectionsAreKeptByContent) {
  const std::shared_ptr<const Detector> detector =
      open_detector(two_classes("a.onnx", test::onnx_detection(64, 32, {})));
  std::map<std::string, std::string> kept;
  int made = 0;
  const KeepDetections keep = [&](const std::string& key, const auto& make) {
    if (!kept.contains(key)) kept[key] = make(), ++made;
    return kept[key];
  };
  const auto frames = std::make_shared<MadeSequence>(3, [](std::size_t i, RandomStream) {
    RgbdFrame frame;
    frame.stamp_ns = static_cast<Stamp>(i);
    frame.color = red_at(64, 32, {{i == 2 ? 20 : 44, 20}});
    frame.depth_m = Grid2d<float>(64, 32, 1.0F);
    return frame;
  });
  const DetectedSequence with(frames, detector, BoxFill::kBox, keep),
      without(frames, detector, BoxFill::kBox);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(with.frame(i, RandomStream()).semantics, without.frame(i, RandomStream()).semantics);
  EXPECT_EQ(made, 2);  // the first two images are equal
  EXPECT_EQ(with.frame(0, RandomStream()).semantics.at(44, 20).most_probable(),
            *class_by_name("chair"));
}

/// YOLOX-Nano on a real frame, if both files exist (see the README of ../shared/data/detector).
TEST(RealNetwork, TakesTheMonitorForALaptop) {
  const fs::path data = fs::path(MH_SOURCE_DIR) / "../shared/data";
  const fs::path image = data / "tum_fr1_rpy/rgb/1305031229.528748.png";
  if (!fs::exists(data / "detector/yolox_nano.onnx") || !fs::exists(image))
    GTEST_SKIP() << "needs ../shared/data";
  const auto detector = open_detector(detector_from_file(data / "detector/yolox_nano.onnx"));
  EXPECT_EQ(detector->description(), "yolox, 80 classes, input 416 x 416");
  cv::Mat rgb;
  cv::cvtColor(cv::imread(image.string()), rgb, cv::COLOR_BGR2RGB);
  Grid2d<Rgb8> color(rgb.cols, rgb.rows);
  std::memcpy(color.data(), rgb.data, rgb.total() * 3);
  const Detected found = detector->detect(color, 0, 0);
  const auto laptop = std::ranges::find(found.boxes, 63, &DetectedBox::network_class);
  ASSERT_NE(laptop, found.boxes.end());
  EXPECT_NEAR(laptop->score, 0.50, 0.01);
}

}  // namespace
}  // namespace mh
