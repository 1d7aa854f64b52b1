// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "slam/detect/detector.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class BoxFiles : public testing::Test {
 protected:
  std::unique_ptr<Detector> open(const std::string& name, const std::string& content) {
    const fs::path file = folder_.path() / name;
    fs::create_directories(file.parent_path());
    write_atomically(file, content);
    return open_detector(
        detector_from_file(name.find('/') == name.npos ? file : file.parent_path()));
  }
  std::string refusal(const std::string& name, const std::string& content) {
    try {
      open(name, content);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_{fs::temp_directory_path()};
  const Grid2d<Rgb8> image_{100, 50};
};

void expect_chair(const Detected& found) {
  ASSERT_EQ(found.boxes.size(), 1U);
  EXPECT_NEAR(found.boxes[0].left, 10, 1e-4);
  EXPECT_NEAR(found.boxes[0].top, 20, 1e-4);
  EXPECT_NEAR(found.boxes[0].right, 40, 1e-4);
  EXPECT_NEAR(found.boxes[0].bottom, 40, 1e-4);
  EXPECT_FLOAT_EQ(found.boxes[0].score, 0.8F);
  EXPECT_EQ(found.boxes[0].classes.most_probable(), *class_by_name("chair"));
}

TEST_F(BoxFiles, AnImagesFolderIsNoPartOfItsName) {
  const auto boxes = open(
      "a.json",
      R"([{"image_id": "rgb/3.png", "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8}])");
  expect_chair(boxes->detect(image_, 3, 0));
}

TEST_F(BoxFiles, OfCocoAreFoundByIndexOrStamp) {
  const auto by_index = open(
      "a.json", R"([{"image_id": 3, "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8}])");
  expect_chair(by_index->detect(image_, 3, 0));
  EXPECT_TRUE(by_index->detect(image_, 2, 0).boxes.empty());
  const auto by_stamp = open(
      "a.json",
      R"([{"image_id": "1305031229.528748.png", "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8}])");
  expect_chair(by_stamp->detect(image_, 0, 1305031229528748000));
  EXPECT_TRUE(by_stamp->detect(image_, 0, 1305031229628748000).boxes.empty());
}

TEST_F(BoxFiles, OfYoloAreSharesOfTheImage) {
  const auto boxes = open("yolo/000003.txt", "56 0.25 0.6 0.3 0.4 0.8\n");
  expect_chair(boxes->detect(image_, 3, 0));
  EXPECT_TRUE(boxes->description().starts_with("YOLO text: 1 box of ")) << boxes->description();
}

TEST_F(BoxFiles, OfMotCountFromOne) {
  const auto boxes = open("a.csv", "4,-1,11,21,30,20,0.8,57,1\n");
  expect_chair(boxes->detect(image_, 3, 0));
}

TEST_F(BoxFiles, MayHaveTheLineEndsOfOldMacs) {
  const auto boxes =
      open("a.csv", "# of an old Mac\r4,-1,11,21,30,20,0.8,57,1\r5,-1,11,21,30,20,0.8,57,1\r");
  expect_chair(boxes->detect(image_, 3, 0));
  expect_chair(boxes->detect(image_, 4, 0));
}

TEST_F(BoxFiles, AreFoundByStampsOfTodayInNanoseconds) {
  const auto boxes = open("a.json",
                          "[{\"image_id\": 1305031229528748000, \"category_id\": 62, \"bbox\": "
                          "[10, 20, 30, 20], \"score\": 0.8}]");
  expect_chair(boxes->detect(image_, 7, 1305031229528748000));
}

TEST_F(BoxFiles, OfStampsInNanosecondsThatBeginAtZeroAreFoundByStamp) {
  const auto boxes = open("a.json",
                          R"([{"image_id": 0, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 0.8},
          {"image_id": 33333333, "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8},
          {"image_id": 133333333, "category_id": 1, "bbox": [1, 2, 3, 4], "score": 0.8}])");
  expect_chair(boxes->detect(image_, 1, 33'333'333));
  EXPECT_EQ(boxes->check_frames(std::vector<Stamp>{0, 33'333'333, 133'333'333}), "");
}

TEST_F(BoxFiles, OfYoloAreOfTheClassesThatStandAmongThem) {
  fs::create_directories(folder_.path() / "yolo");
  write_atomically(folder_.path() / "yolo/classes.txt", "sofa\nchair\n");
  const auto boxes = open("yolo/000003.txt", "1 0.25 0.6 0.3 0.4 0.8\n");
  expect_chair(boxes->detect(image_, 3, 0));
  EXPECT_EQ(boxes->names().size(), 2U);
}

TEST_F(BoxFiles, OfClassesThatAreNoneOfOursSaySo) {
  fs::create_directories(folder_.path() / "strange");
  write_atomically(folder_.path() / "strange/classes.txt", "dragon\n");
  const auto boxes = open("strange/0.txt", "0 0.25 0.6 0.3 0.4 0.8\n");
  EXPECT_NE(boxes->check_frames(std::vector<Stamp>{0}).find("none of its 1 class has the name"),
            std::string::npos);
}

TEST_F(BoxFiles, MayHoldNoBox) {
  for (const auto& boxes : {open("a.json", "[]"), open("a.csv", "")}) {
    EXPECT_TRUE(boxes->detect(image_, 0, 0).boxes.empty());
    EXPECT_NE(boxes->check_frames(std::vector<Stamp>{0}).find("holds no box"), std::string::npos);
  }
}

TEST_F(BoxFiles, OutsideTheImageAreCutAndCounted) {
  const auto boxes =
      open("a.csv", "1,-1,-20,1,50,20,0.8,57\n1,-1,500,1,50,20,0.8,57\n1,-1,1,1,9,9,0.8,57\n");
  const Detected found = boxes->detect(image_, 0, 0);
  EXPECT_EQ(found.boxes.size(), 2U);
  EXPECT_EQ(found.clipped, 2);
  for (const DetectedBox& box : found.boxes) EXPECT_GE(box.left, 0);
}

TEST_F(BoxFiles, OfOneFrameUnderTwoNamesAreAllFound) {
  const auto boxes =
      open("a.json",
           R"([{"image_id": 3, "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8},
          {"image_id": "2.5", "category_id": 62, "bbox": [60, 10, 20, 20], "score": 0.7}])");
  EXPECT_EQ(boxes->detect(image_, 3, 2'500'000'000).boxes.size(), 2U);
}

TEST_F(BoxFiles, MustBeOfFramesOfTheSequence) {
  const auto by_index =
      open("a.csv", "1,-1,1,1,9,9,0.8,57\n4,-1,1,1,9,9,0.8,57\n9,-1,1,1,9,9,0.8,57\n");
  const std::vector<Stamp> ten(10), five(5), none;
  EXPECT_EQ(by_index->check_frames(ten), "");
  EXPECT_NE(by_index->check_frames(five).find(
                "1 of its 3 frames are not among the sequence's 5, the first is '9'"),
            std::string::npos);
  EXPECT_THROW(by_index->check_frames(none), InputError);
  const auto by_stamp =
      open("a.json",
           R"([{"image_id": "12.5", "category_id": 62, "bbox": [10, 20, 30, 20], "score": 0.8}])");
  EXPECT_EQ(by_stamp->check_frames(std::vector<Stamp>{12'500'400'000}), "");
  EXPECT_THROW(by_stamp->check_frames(std::vector<Stamp>{13'500'000'000}), InputError);
}

TEST_F(BoxFiles, NameTheirFaultAndItsPlace) {
  const auto says = [&](const std::string& name, const std::string& content, const char* part) {
    const std::string text = refusal(name, content);
    EXPECT_NE(text.find(part), text.npos) << text;
  };
  says("a.csv", "1,-1,1,1,50,20,0.8,57\n1,-1,nan,1,50,20,0.8,57\n", "a.csv:2: left is nan");
  says("a.csv", "1,-1,1,1,0,20,0.8,57\n", "a.csv:1: a box of 0 x 20 has no area");
  says("a.csv", "1,-1,1,1,50,20,0.8,81\n",
       "class 81 is not one of the 80 named classes, which count from 1");
  says("a.csv", "1,-1,0x40,1,50,20,0.8,57\n", "'0x40' is not a number");
  says("a.csv", std::string("1,-1,4\0,1,50,20,0.8,57\n", 24), "is not a number");
  says("a.csv", "1,-1,1,1,50\n", "5 numbers, not frame");
  says("a.csv", "one,-1,1,1,50,20,0.8,57\n", "'one' is not a number; each line is frame, id");
  says("yolo/0.txt", "56 0.25 0.6 0.3 0.4 1.8\n", "0.txt:1: score 1.8 is outside [0, 1]");
  says("yolo/0.txt", "56 320 240 100 80\n",
       "0.txt:1: box 320 240 100 80 is not given as fractions of the image size");
  says("other/first.txt", "56 0.25 0.6 0.3 0.4\n", "'first' is neither an index nor a stamp");
  says("a.json", "[{\"image_id\": 0, \"category_id\": 12, \"bbox\": [1,1,1,1], \"score\": 1}]",
       "entry 0: category_id 12 is not one of COCO's");
  says("a.json", "[{\"image_id\": 0, \"bbox\": [1,1,1,1], \"score\": 1}]",
       "entry 0: has no 'category_id'");
  says("a.json", "[{\"image_id\": 0, \"category_id\": 1, \"bbox\": [1,1,null,1], \"score\": 1}]",
       "bbox must be four numbers");
  says("a.json", "[{\"image_id\"", "a.json:1: is not JSON");
  says("a.json", "[{\"image_id\": 0, \"category_id\": 1, \"bbox\": [1,1,1,1], \"score\": 1e999}]",
       "a.json: holds a number beyond the range of a double");
  says("a.json", R"({"images": [], "annotations": []})", "holds COCO annotations");
  says("a.json", "{}", "is not a list of COCO's results");
}

}  // namespace
}  // namespace mh
