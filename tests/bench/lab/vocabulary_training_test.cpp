// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/vocabulary_training.hpp"

#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "bench/lab/vocabulary_score.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {
namespace fs = std::filesystem;

VocabularyTraining small() {
  VocabularyTraining config;
  config.rooms = 2;
  config.views = 2;
  config.light_samples = 16;
  config.tree.depth = 2;
  return config;
}

TEST(TrainVocabulary, IsTheSameAtAnyThreadCountAndOtherForOtherSeeds) {
  VocabularyTraining config = small();
  config.threads = 1;
  int calls = 0;
  const Vocabulary one = train_vocabulary(config, [&](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 2);
  });
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(one.size(), 100U);
  config.threads = 2;
  EXPECT_EQ(train_vocabulary(config).digest(), one.digest());
  config.seed = 2;
  EXPECT_NE(train_vocabulary(config).digest(), one.digest());
}

TEST(TrainVocabulary, FailuresInARoomReachTheCaller) {
  const auto stop = [](int, int) { throw std::runtime_error("stop"); };
  EXPECT_THROW(train_vocabulary(small(), stop), std::runtime_error);
}

TEST(TrainVocabulary, RefusesNonsense) {
  for (int VocabularyTraining::*field : {&VocabularyTraining::rooms, &VocabularyTraining::views,
                                         &VocabularyTraining::light_samples}) {
    VocabularyTraining config = small();
    config.*field = 0;
    EXPECT_THROW(train_vocabulary(config), InputError);
  }
}

class ImageList : public testing::Test {
 protected:
  ImageList() : folder_(fs::path(testing::TempDir()) / fmt::format("image_list_{}", getpid())) {
    fs::remove_all(folder_);
    make_output_folder(folder_ / "images");
    for (int i = 0; i < 3; ++i) {
      cv::Mat image(240, 320, CV_8UC3);
      for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x) {
          const auto block = static_cast<std::uint64_t>(y / 8 * 40 + x / 8);
          const auto gray = static_cast<std::uint8_t>(RandomStream(i).below(block, 256));
          image.at<cv::Vec3b>(y, x) = {gray, gray, gray};
        }
      cv::imwrite((folder_ / "images" / fmt::format("{}.png", i)).string(), image);
    }
  }
  ~ImageList() override { fs::remove_all(folder_); }

  std::vector<fs::path> listed(const std::string& text) const {
    write_atomically(folder_ / "list.txt", text);
    return load_image_list(folder_ / "list.txt");
  }
  std::string fault_of(const std::string& text) const {
    try {
      VocabularyTraining config = small();
      config.images = listed(text);
      train_vocabulary(config);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(ImageList, IsTrainedOnAtAnyThreadCount) {
  VocabularyTraining config = small();
  config.images = listed("# three\nimages/0.png\n\n  images/1.png  # one\r\nimages/2.png");
  ASSERT_EQ(config.images.size(), 3U);
  config.threads = 1;
  const Vocabulary one = train_vocabulary(config);
  EXPECT_EQ(one.training_images(), 3U);
  EXPECT_GT(one.training_descriptors(), 500U);
  config.threads = 3;
  EXPECT_EQ(train_vocabulary(config).digest(), one.digest());
  std::swap(config.images[0], config.images[2]);
  EXPECT_NE(train_vocabulary(config).digest(), one.digest());  // the order is part of the input
}

TEST_F(ImageList, FaultsAreNamed) {
  const std::string list = (folder_ / "list.txt").string();
  EXPECT_EQ(fault_of("images/0.png\nimages/9.png\n"), list + ":2: no such image: images/9.png");
  EXPECT_EQ(fault_of("# nothing\n"), list + ": names no image");
  write_atomically(folder_ / "text.png", "no image");
  EXPECT_EQ(fault_of("text.png"),
            (folder_ / "text.png").string() + ": is not an image, or is damaged");
}

// A plane 2 m in front of the camera, seen from two places.
TEST(Overlap, IsTheShareThatTheOtherImageShows) {
  const Camera camera;
  PlacedView a;
  a.depth_m = Grid2d<float>(80, 60, 2.0F);
  PlacedView b = a;
  EXPECT_DOUBLE_EQ(overlap(a, b, camera), 1.0);
  // The second view is half an image to the side: 320 px at 2 m.
  b.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {320 * 2.0 / camera.fx_px, 0, 0});
  EXPECT_NEAR(overlap(a, b, camera), 0.5, 0.02);
  b.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {0, 0, 5});  // behind the plane
  EXPECT_DOUBLE_EQ(overlap(a, b, camera), 0.0);
  b.world_from_camera = a.world_from_camera;
  b.depth_m = Grid2d<float>(80, 60, 1.0F);  // something is in front of the plane
  EXPECT_DOUBLE_EQ(overlap(a, b, camera), 0.0);
  EXPECT_DOUBLE_EQ(overlap(b, a, camera), 1.0);
  a.depth_m = Grid2d<float>(80, 60, 0.0F);
  EXPECT_DOUBLE_EQ(overlap(a, b, camera), 0.0);
}

// Views of three places, two views each, with descriptors that depend only on the place.
TEST(ScoreVocabulary, FindsViewsOfOnePlaceByTheirWords) {
  const Camera camera;
  std::vector<PlacedView> views;
  std::vector<std::vector<Descriptor>> images;
  for (int i = 0; i < 6; ++i) {
    PlacedView view;
    view.stamp_ns = i * Stamp{10'000'000'000};
    const int place = i % 3;
    view.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {100.0 * place, 0.01 * i, 0});
    view.depth_m = Grid2d<float>(80, 60, 2.0F);
    for (std::uint64_t k = 0; k < 50; ++k) {
      const RandomStream r = RandomStream(place).fork(k);
      view.features.descriptors.push_back({r.bits(0), r.bits(1), r.bits(2), r.bits(3)});
      view.features.keypoints.push_back({.label = static_cast<ClassId>(k % 2)});
    }
    images.push_back(view.features.descriptors);
    views.push_back(view);
  }
  const Vocabulary vocabulary = Vocabulary::train(images, {});
  const VocabularyScore score = score_vocabulary(vocabulary, views, {}, camera, {});
  EXPECT_EQ(score.views, 6);
  EXPECT_EQ(score.queries, 6);
  EXPECT_DOUBLE_EQ(score.precision, 1.0);
  EXPECT_DOUBLE_EQ(score.average_precision, 1.0);
  EXPECT_DOUBLE_EQ(score.chance, 1.0 / 5.0);
  // Half of the keypoints have a label: 25 labels against 50 words of weight ln 3, as each word
  // occurs in 2 of 6 views.
  ASSERT_TRUE(score.label_mass);
  EXPECT_NEAR(*score.label_mass, 25 / (25 + 50 * std::log(3.0)), 1e-6);
  // If neighbors must be 35 s apart, no query has a true neighbor.
  VocabularyScoreConfig long_ago;
  long_ago.min_gap_s = 35;
  EXPECT_THROW(score_vocabulary(vocabulary, views, {}, camera, long_ago), InputError);
  // Words of a different place mislead the retrieval.
  std::swap(views[0].features, views[1].features);
  EXPECT_LT(score_vocabulary(vocabulary, views, {}, camera, {}).precision, 0.5);
}

// The file that ships with the project is complete, and its words are used evenly enough to
// distinguish images: few occur in more than half of them (weight below ln 2).
TEST(Assets, VocabularyHoldsWordsThatTell) {
  const Vocabulary vocabulary = Vocabulary::load(MH_SOURCE_DIR "/assets/vocabulary.mhvoc");
  EXPECT_GT(vocabulary.size(), 95000U);
  EXPECT_GT(vocabulary.training_descriptors(), 20 * vocabulary.size());
  std::size_t common = 0;
  for (WordId w = 0; w < vocabulary.size(); ++w) common += vocabulary.idf(w) < 0.693F;
  EXPECT_LT(common, vocabulary.size() / 100);
}

}  // namespace
}  // namespace mh
