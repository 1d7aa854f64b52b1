// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/heads.hpp"
#include "slam/detect/fit_image.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <opencv2/core.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace mh {
namespace {

constexpr InputSize kInput{64, 32};  // 8 x 4, 4 x 2 and 2 x 1 cells: 42

struct Made {
  std::vector<int> shape;
  std::vector<float> values;
  explicit Made(std::vector<int> s) : shape(std::move(s)) {
    std::size_t all = 1;
    for (const int n : shape) all *= static_cast<std::size_t>(n);
    values.resize(all, 0.0F);
  }
  Tensor tensor() const { return {shape, values}; }
};

TEST(RecognizeHead, GoesByTheOutputsShape) {
  const auto of = [](const Made& made, bool darknet = false) {
    const Tensor tensor = made.tensor();
    return recognize_head({&tensor, 1}, kInput, darknet);
  };
  EXPECT_EQ(of(Made({1, 42, 8})), Head::kYolox);
  EXPECT_EQ(of(Made({1, 126, 8})), Head::kYolov5);
  EXPECT_EQ(of(Made({1, 7, 42})), Head::kYolov8);
  EXPECT_EQ(of(Made({1, 21, 32, 64})), Head::kSegmentation);
  EXPECT_EQ(of(Made({96, 8}), true), Head::kDarknet);
  EXPECT_EQ(of(Made({1, 1000})), Head::kAuto);
  EXPECT_EQ(of(Made({1, 41, 8})), Head::kAuto);
}

// Outputs of detectors must not be taken for segmentation: the 22 in Yolo-FastestV2's 22 x 22 x 95
// is not a number of classes, nor is the 255 in YOLOv4's raw scales.
TEST(RecognizeHead, TakesNoDetectorsScalesForSegmentation) {
  const auto of = [](const std::vector<Made>& made) {
    std::vector<Tensor> tensors;
    for (const Made& output : made) tensors.push_back(output.tensor());
    return recognize_head(tensors, kInput, false);
  };
  EXPECT_EQ(of({Made({1, 2, 4, 95}), Made({1, 1, 2, 95})}), Head::kAuto);
  EXPECT_EQ(of({Made({1, 255, 4, 8}), Made({1, 255, 2, 4})}), Head::kAuto);
  EXPECT_EQ(of({Made({1, 21, 4, 8}), Made({1, 19, 4, 8})}), Head::kSegmentation);
  EXPECT_EQ(of({Made({1, 21, 5, 9})}), Head::kSegmentation) << "up to a cell";
}

TEST(RecognizeHead, TellsDecodedBoxesByTheirPlaces) {
  Made made({1, 42, 8});
  int row = 0;
  for (const int stride : {8, 16, 32})
    for (int y = 0; y < kInput.height / stride; ++y)
      for (int x = 0; x < kInput.width / stride; ++x, ++row) {
        made.values[static_cast<std::size_t>(8 * row)] =
            (static_cast<float>(x) + 0.4F) * static_cast<float>(stride);
        made.values[static_cast<std::size_t>(8 * row) + 1] =
            (static_cast<float>(y) + 0.6F) * static_cast<float>(stride);
      }
  const Tensor tensor = made.tensor();
  EXPECT_EQ(recognize_head({&tensor, 1}, kInput, false), Head::kYoloxDecoded);
}

// 84 cells with 84 values: 79 classes and objectness by row, or 80 classes by column.
TEST(RecognizeHead, TellsBoxesInColumnsOfASquareByTheirPlaces) {
  constexpr InputSize kSquare{64, 64};
  Made rows({1, 84, 84}), columns({1, 84, 84});
  std::size_t box = 0;
  for (const int stride : {8, 16, 32})
    for (int y = 0; y < 64 / stride; ++y)
      for (int x = 0; x < 64 / stride; ++x, ++box) {
        columns.values[box] = (static_cast<float>(x) + 0.4F) * static_cast<float>(stride);
        columns.values[84 + box] = (static_cast<float>(y) + 0.6F) * static_cast<float>(stride);
        rows.values[84 * box] = columns.values[box];
        rows.values[84 * box + 1] = columns.values[84 + box];
      }
  const Tensor by_row = rows.tensor(), by_column = columns.tensor();
  EXPECT_EQ(recognize_head({&by_row, 1}, kSquare, false), Head::kYoloxDecoded);
  EXPECT_EQ(recognize_head({&by_column, 1}, kSquare, false), Head::kYolov8);
  EXPECT_EQ(class_count(Head::kYolov8, {&by_column, 1}, kSquare), 80);
  // There may be more classes than cells.
  const Tensor tall{{1, 84, 21}, {columns.values.data(), 84 * 21}};
  EXPECT_EQ(class_count(Head::kYolov8, {&tall, 1}, {32, 32}), 80);
}

TEST(Decode, YoloxAddsTheCellAndTakesTheExponent) {
  Made made({1, 42, 7});
  float* row = made.values.data() + (32 + 4 + 1) * 7;  // stride 16: second row, second cell
  const std::vector<float> values = {0.25F, -0.5F, std::log(2.0F), std::log(3.0F), 0.8F,
                                     0.1F,  0.5F};
  std::copy(values.begin(), values.end(), row);
  const Tensor tensor = made.tensor();
  const auto found = decode(Head::kYolox, {&tensor, 1}, kInput, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].x), 20);  // (0.25 + 1) 16
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].y), 8);
  EXPECT_NEAR(found[0].width, 32, 1e-4);
  EXPECT_NEAR(found[0].height, 48, 1e-4);
  EXPECT_EQ(found[0].best, 1);
  EXPECT_FLOAT_EQ(found[0].scores[1], 0.4F);
  EXPECT_TRUE(decode(Head::kYolox, {&tensor, 1}, kInput, 0.41).empty());
}

TEST(RecognizeHead, LeavesBoxesWithMasksAlone) {
  const Made boxes({1, 39, 42}), masks({1, 32, 8, 16});
  const std::vector<Tensor> both = {boxes.tensor(), masks.tensor()};
  EXPECT_TRUE(gives_boxes_and_masks(both, kInput));
  EXPECT_EQ(recognize_head(both, kInput, false), Head::kAuto);
  EXPECT_FALSE(gives_boxes_and_masks({both.data(), 1}, kInput));
  EXPECT_FALSE(gives_boxes_and_masks({both.data() + 1, 1}, kInput));
}

TEST(Decode, ScoresOfYolov5AreObjectnessTimesProbability) {
  Made made({1, 126, 7});
  const std::vector<float> values = {10, 12, 4, 6, 0.5F, 0.25F, 0.75F};
  std::copy(values.begin(), values.end(), made.values.begin() + 7 * 3);
  const Tensor tensor = made.tensor();
  const auto found = decode(Head::kYolov5, {&tensor, 1}, kInput, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FLOAT_EQ(found[0].scores[0], 0.125F);
  EXPECT_FLOAT_EQ(found[0].scores[1], 0.375F);
  EXPECT_EQ(found[0].x, 10);
  EXPECT_EQ(found[0].height, 6);
  EXPECT_TRUE(decode(Head::kYolov5, {&tensor, 1}, kInput, 0.4).empty());
}

TEST(Decode, Yolov8IsTransposedAndHasNoObjectness) {
  Made made({1, 7, 42});
  const std::vector<float> values = {10, 12, 4, 6, 0.2F, 0.9F, 0.1F};
  for (std::size_t k = 0; k < values.size(); ++k) made.values[k * 42 + 5] = values[k];
  const Tensor tensor = made.tensor();
  const auto found = decode(Head::kYolov8, {&tensor, 1}, kInput, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].x, 10);
  EXPECT_EQ(found[0].height, 6);
  EXPECT_EQ(found[0].best, 1);
  EXPECT_FLOAT_EQ(found[0].scores[1], 0.9F);
}

TEST(Decode, DarknetsBoxesAreSharesOfTheInputOfAllScales) {
  Made coarse({6, 7}), fine({24, 7});
  const std::vector<float> values = {0.5F, 0.25F, 0.125F, 0.5F, 0.9F, 0.6F, 0};
  std::copy(values.begin(), values.end(), coarse.values.begin());
  std::copy(values.begin(), values.end(), fine.values.begin() + 7 * 23);
  const std::vector<Tensor> outputs = {coarse.tensor(), fine.tensor()};
  const auto found = decode(Head::kDarknet, outputs, kInput, 0.5);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].x, 32);
  EXPECT_EQ(found[1].y, 8);
  EXPECT_EQ(found[1].width, 8);
  EXPECT_EQ(found[1].height, 16);
}

TEST(Decode, AScoreBeyondOneIsNone) {
  Made made({1, 7, 42});
  const std::vector<float> values = {10, 12, 4, 6, 3.5F, 0, 0};
  for (std::size_t k = 0; k < values.size(); ++k) made.values[k * 42 + 5] = values[k];
  const Tensor tensor = made.tensor();
  EXPECT_THROW(decode(Head::kYolov8, {&tensor, 1}, kInput, 0.3), InputError);
}

TEST(Decode, ValuesThatAreNotFiniteMakeNoBox) {
  Made made({1, 42, 7});
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<float> values = {0, 0, 0, 0, 1, 1, 0};
    std::copy(values.begin(), values.end(),
              made.values.begin() + static_cast<std::ptrdiff_t>(7 * i));
  }
  made.values[0] = std::numeric_limits<float>::quiet_NaN();
  made.values[7 + 2] = 1000;  // the exponential of this is infinite
  const Tensor tensor = made.tensor();
  EXPECT_EQ(decode(Head::kYolox, {&tensor, 1}, kInput, 0.3).size(), 1U);
}

TEST(Decode, OfEqualScoresTheFirstClassWins) {
  Made made({1, 126, 7});
  const std::vector<float> values = {10, 12, 4, 6, 1, 0.75F, 0.75F};
  std::copy(values.begin(), values.end(), made.values.begin());
  const Tensor tensor = made.tensor();
  const auto found = decode(Head::kYolov5, {&tensor, 1}, kInput, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].best, 0);
}

TEST(Decode, BoxesMayBeNarrowerThanAPixelButHaveASize) {
  Made made({1, 126, 7});
  const auto put = [&](std::ptrdiff_t i, float width, float height) {
    const std::vector<float> values = {10, 12, width, height, 0.5F, 0.25F, 0.75F};
    std::copy(values.begin(), values.end(), made.values.begin() + 7 * i);
  };
  put(0, 0.5F, 0.75F), put(1, 0, 4), put(2, 4, 0);
  const Tensor tensor = made.tensor();
  const auto found = decode(Head::kYolov5, {&tensor, 1}, kInput, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].width), 0.5F);
}

Candidate candidate(double left, double right, int best, float score) {
  Candidate c{.x = (left + right) / 2,
              .y = 10,
              .width = right - left,
              .height = 10,
              .best = best,
              .scores = std::vector<float>(80, 0.0F)};
  c.scores[static_cast<std::size_t>(best)] = score;
  return c;
}

constexpr int kCocoChair = 56, kCat = 15;

TEST(SelectBoxes, SuppressesWithinAClassAndBreaksTiesByOrder) {
  DetectorSettings settings;
  settings.nms = 0.5;
  const auto select = [&](const std::vector<Candidate>& all) {
    return select_boxes(all, Placement{}, 100, 100, coco80(), settings);
  };
  // An overlap of 10 out of 30 is 1/3: kept; 15 out of 25 is 0.6: removed.
  EXPECT_EQ(
      select({candidate(0, 20, kCocoChair, 0.9F), candidate(10, 30, kCocoChair, 0.8F)}).size(), 2U);
  EXPECT_EQ(select({candidate(0, 20, kCocoChair, 0.9F), candidate(5, 25, kCocoChair, 0.8F)}).size(),
            1U);
  EXPECT_EQ(select({candidate(0, 20, kCocoChair, 0.9F), candidate(5, 25, kCat, 0.8F)}).size(), 2U);
  const auto tied =
      select({candidate(0, 20, kCocoChair, 0.9F), candidate(5, 25, kCocoChair, 0.9F)});
  ASSERT_EQ(tied.size(), 1U);
  EXPECT_EQ(tied[0].left, 0);
  settings.max_detections = 1;
  const auto best =
      select({candidate(0, 20, kCocoChair, 0.4F), candidate(50, 70, kCocoChair, 0.9F)});
  ASSERT_EQ(best.size(), 1U);
  EXPECT_EQ(best[0].left, 50);
}

TEST(SelectBoxes, CutsWhatIsOutsideTheImage) {
  const auto found =
      select_boxes({candidate(-10, 20, kCocoChair, 0.9F), candidate(200, 220, kCocoChair, 0.9F)},
                   Placement{}, 100, 100, coco80(), {});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].left, 0);
  EXPECT_EQ(found[0].right, 20);
}

TEST(OurClasses, SumThoseOfOneNameAndLeaveOutTheRest) {
  std::vector<float> scores(80, 0.0F);
  scores[24] = 0.5F, scores[26] = 0.2F, scores[56] = 0.1F,
  scores[15] = 0.3F;  // two kinds of bags, a chair, a cat
  const ClassDistribution bag = our_classes(scores, 24, coco80());
  ASSERT_EQ(bag.entries.size(), 2U);
  EXPECT_EQ(bag.most_probable(), *class_by_name("bag"));
  EXPECT_FLOAT_EQ(bag.entries[1].second, 0.7F);
  EXPECT_FLOAT_EQ(bag.entries[0].second, 0.1F);
  EXPECT_TRUE(our_classes(scores, 15, coco80()).entries.empty());
  scores[56] = 0.9F;
  const ClassDistribution both = our_classes(scores, 56, coco80());
  EXPECT_FLOAT_EQ(both.entries[0].second + both.entries[1].second, 1);
}

TEST(PlaceImage, ScalesIntoCornerOrCenterAndBack) {
  const Placement corner = place_image(640, 480, {416, 416}, Letterbox::kCorner);
  EXPECT_EQ(corner.width, 416);
  EXPECT_EQ(corner.height, 312);
  EXPECT_EQ(corner.top, 0);
  const Placement center = place_image(640, 480, {416, 416}, Letterbox::kCenter);
  EXPECT_EQ(center.top, 52);
  EXPECT_DOUBLE_EQ(center.image_y(52 + 156), 240);
  const Placement stretched = place_image(640, 480, {416, 416}, Letterbox::kStretch);
  EXPECT_EQ(stretched.height, 416);
  EXPECT_DOUBLE_EQ(stretched.image_y(208), 240);
}

// 333 rows scaled by 416 / 500 = 0.832 are 277.056 rows; 335 are 278.72.
TEST(PlaceImage, RoundsInTheCenterAndCutsInTheCorner) {
  const auto place = [](int height, Letterbox letterbox) {
    return place_image(500, height, {416, 416}, letterbox);
  };
  EXPECT_EQ(place(333, Letterbox::kCorner).height, 277);
  EXPECT_EQ(place(333, Letterbox::kCenter).height, 277);
  EXPECT_EQ(place(333, Letterbox::kCenter).top, 69);  // half of the 139 rows that remain
  EXPECT_EQ(place(335, Letterbox::kCorner).height, 278);
  EXPECT_EQ(place(335, Letterbox::kCenter).height, 279);
  EXPECT_EQ(place(335, Letterbox::kCenter).top, 68);  // half of the 137 rows that remain
  EXPECT_EQ(place_image(1000, 1, {416, 416}, Letterbox::kCorner).height, 1);
}

TEST(NetworkInput, IsNormalizedAsTheNetworkWasTrained) {
  const Grid2d<Rgb8> color(2, 2, {100, 150, 200});
  const InputSize size{2, 2};
  const auto planes = [&](Normalize normalize, Channels channels) {
    DetectorSettings settings;
    settings.normalize = normalize, settings.channels = channels;
    settings.letterbox = Letterbox::kStretch;
    const cv::Mat blob =
        network_input(color, size, place_image(2, 2, size, Letterbox::kStretch), settings);
    return std::array{*blob.ptr<float>(0, 0), *blob.ptr<float>(0, 1), *blob.ptr<float>(0, 2)};
  };
  EXPECT_EQ(planes(Normalize::kNone, Channels::kBgr), (std::array{200.0F, 150.0F, 100.0F}));
  EXPECT_NEAR(planes(Normalize::kUnit, Channels::kRgb)[0], 100 / 255.0, 1e-6);
  // Mean and deviation of ImageNet, as torchvision documents them.
  const auto imagenet = planes(Normalize::kImagenet, Channels::kRgb);
  EXPECT_NEAR(imagenet[0], (100 / 255.0 - 0.485) / 0.229, 1e-5);
  EXPECT_NEAR(imagenet[1], (150 / 255.0 - 0.456) / 0.224, 1e-5);
  EXPECT_NEAR(imagenet[2], (200 / 255.0 - 0.406) / 0.225, 1e-5);
}

TEST(ReadClassNames, TakesWhatPythonPrints) {
  const auto names = [](const char* python) {
    const auto read = read_class_names(python);
    return read ? read->names : std::vector<std::string>{};
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("{0: 'chair', 1: 'potted plant'}"), (Names{"chair", "potted plant"}));
  EXPECT_EQ(names("{1: \"driver's seat\", 0: 'it\\'s'}"), (Names{"it's", "driver's seat"}));
  EXPECT_EQ(names("['chair', 'table']"), (Names{"chair", "table"}));
  EXPECT_EQ(names("{\"0\": \"chair\"}"), (Names{"chair"}));
  EXPECT_EQ(read_class_names("['chair', 'dragon']")->ids, (std::vector<ClassId>{5, kVoid}));
  for (const char* wrong :
       {"", "{}", "[]", "chair", "{0: 'chair'", "{0: 'chair', 2: 'table'}", "{0: 'a', 0: 'b'}",
        "{0: chair}", "['chair' 'table']", "{0: 'chair'} and more", "{-1: 'chair'}", "['chair"})
    EXPECT_FALSE(read_class_names(wrong)) << wrong;
}

TEST(LoadClassNames, TakesLinesJsonAndYamlOfUltralytics) {
  const auto file = std::filesystem::path(testing::TempDir()) /
                    fmt::format("mh_classes_{}", static_cast<int>(getpid()));
  const auto names = [&](const char* ending, const std::string& text) {
    const std::filesystem::path named = file.string() + ending;
    write_atomically(named, text);
    std::vector<std::string> read;
    try {
      read = load_class_names(named).names;
    } catch (const InputError& error) {
      read = {std::string(error.what()).substr(named.string().size())};
    }
    std::filesystem::remove(named);
    return read;
  };
  const std::vector<std::string> expected{"chair", "dining table"};
  EXPECT_EQ(names(".names", "chair\r\ndining table\r\n\r\n"), expected);
  EXPECT_EQ(names(".json", "[\"chair\",\n \"dining table\"]\n"), expected);
  EXPECT_EQ(names(".yaml", "train: ../images\nnc: 2\nnames: ['chair', 'dining table']\n"),
            expected);
  EXPECT_EQ(names(".yml", "path: x\nnames:\n  0: chair\n  1: dining table  # a comment\n"),
            expected);
  EXPECT_EQ(names(".yaml", "names:\n  1: chair\n  2: table\n")[0],
            ":3: names.2: '2' is not an index from 0 to 1");
}

TEST(ClassNames, OfCocoFallOnOurs) {
  EXPECT_EQ(coco80().size(), 80U);
  for (const ClassInfo& info : classes())
    if (info.coco80 >= 0) {
      EXPECT_EQ(coco80().ids[static_cast<std::size_t>(info.coco80)], info.id) << info.name;
    }
  EXPECT_EQ(coco80().ids[kCat], kVoid);
  EXPECT_EQ(coco80_of_category(1), 0);
  EXPECT_EQ(coco80_of_category(62), kCocoChair);
  EXPECT_EQ(coco80_of_category(90), 79);
  EXPECT_EQ(coco80_of_category(12), -1);
  int known = 0;
  for (int id = -5; id < 100; ++id) known += coco80_of_category(id) >= 0 ? 1 : 0;
  EXPECT_EQ(known, 80);
}

TEST(Segmented, TakesProbabilitiesOrValuesAndInterpolates) {
  const ClassNames names{{"chair", "table", "cat"}, {5, 7, kVoid}};
  Made made({1, 3, 2, 2});  // chair on the left, table on the right, as probabilities
  for (const std::size_t cell : {0U, 2U}) made.values[cell] = 0.9F, made.values[4 + cell] = 0.1F;
  for (const std::size_t cell : {1U, 3U}) made.values[cell] = 0.1F, made.values[4 + cell] = 0.9F;
  const InputSize input{8, 8};
  const Placement at = place_image(16, 16, input, Letterbox::kStretch);
  const SemanticImage image = segmented(made.tensor(), at, input, {16, 16}, names, 0.25);
  EXPECT_EQ(image.at(0, 8).most_probable(), 5);
  EXPECT_EQ(image.at(15, 8).most_probable(), 7);
  EXPECT_NEAR(image.at(0, 8).entries[0].second, 0.9, 0.1);
  EXPECT_EQ(image.at(7, 0).most_probable(), 5);
  EXPECT_EQ(image.at(8, 0).most_probable(), 7);
  for (float& value : made.values) value = 100 * value - 40;  // no longer probabilities
  EXPECT_GT(segmented(made.tensor(), at, input, {16, 16}, names, 0.25).at(0, 8).entries[0].second,
            0.95);
  const SemanticImage strict = segmented(made.tensor(), at, input, {16, 16}, names, 1.0);
  EXPECT_TRUE(strict.at(7, 8).entries.empty());
}

}  // namespace
}  // namespace mh
