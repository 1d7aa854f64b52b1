// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/lab/vocabulary_score.hpp"
#include "bench/lab/vocabulary_training.hpp"
#include "bench/suite/recorded_camera.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::cli {
namespace {

struct VocabularyArguments {
  std::string file, list, out;
  std::string frames, queries, settings;  ///< for `info`
  VocabularyTraining training;
  VocabularyScoreConfig score;
};

/// Loads a vocabulary and prints how long that took.
Vocabulary load_timed(const std::string& file) {
  const auto start = std::chrono::steady_clock::now();
  Vocabulary vocabulary = Vocabulary::load(file);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  fmt::print("{}: {}, ready in {:.1f} ms\n", file, counted(vocabulary.size(), "word"),
             took.count());
  return vocabulary;
}

void train(VocabularyArguments& options) {
  const std::filesystem::path out = options.out;
  require_writable(out, {options.list});
  if (!options.list.empty()) options.training.images = load_image_list(options.list);
  Progress progress("vocabulary");
  const Vocabulary vocabulary = train_vocabulary(options.training, [&](int done, int total) {
    progress.share(static_cast<double>(done) / total);
  });
  progress.end();
  vocabulary.save(out);
  fmt::print("{}: {}, content digest {}\n", out.string(), counted(vocabulary.size(), "word"),
             hex(vocabulary.digest()));
}

void convert(VocabularyArguments options) {
  require_writable(options.out, {options.file});
  resolve(options.file, Shipped::kVocabulary);
  const Vocabulary vocabulary = load_timed(options.file);
  if (std::filesystem::path(options.out).extension() == ".txt")
    vocabulary.save_dbow2(options.out);
  else
    vocabulary.save(options.out);
  load_timed(options.out);
}

std::string or_unknown(std::uint64_t count) {
  return count == 0 ? "not known" : fmt::format("{}", count);
}

/// The folder of "tum:FOLDER".
std::filesystem::path folder_of(const std::string& source) {
  constexpr std::string_view kTum = "tum:";
  if (!source.starts_with(kTum)) throw InputError(fmt::format("'{}' must be tum:FOLDER", source));
  return source.substr(kTum.size());
}

/// Prints how well the words retrieve images with known poses.
void print_score(const Vocabulary& vocabulary, const VocabularyArguments& options) {
  const RecordedCamera camera = load_recorded_camera(options.settings);
  std::vector<std::string> notes;
  const auto views = load_placed_views(folder_of(options.frames), camera, options.score, notes);
  std::vector<PlacedView> queries;
  if (!options.queries.empty())
    queries = load_placed_views(folder_of(options.queries), camera, options.score, notes);
  for (const std::string& note : notes) fmt::print(stderr, "vocabulary: {}\n", note);
  const VocabularyScore score =
      score_vocabulary(vocabulary, views, queries, camera.camera, options.score);
  fmt::print("  frames  {}, {}, {:.0f} different words in each\n", counted(score.views, "view"),
             counted(score.queries, "query", "queries"), score.words_per_view);
  if (score.label_mass)
    fmt::print("  labels  hold {:.1f} % of a frame's mass at gamma = 1\n", 100 * *score.label_mass);
  fmt::print(
      "  finds   {:.1f} % of the most alike views overlap by {:.0f} % or more (by chance "
      "{:.1f} %); mean average precision {:.3f}\n",
      100 * score.precision, 100 * options.score.min_overlap, 100 * score.chance,
      score.average_precision);
}

void info(VocabularyArguments options) {
  resolve(options.file, Shipped::kVocabulary);
  resolve(options.settings, Shipped::kSettings);
  const Vocabulary vocabulary = load_timed(options.file);
  std::vector<double> idf;
  for (WordId word = 0; word < vocabulary.size(); ++word) idf.push_back(vocabulary.idf(word));
  std::sort(idf.begin(), idf.end());
  const double mean =
      std::accumulate(idf.begin(), idf.end(), 0.0) / static_cast<double>(idf.size());
  fmt::print("  tree    {} nodes, branching {}, depth {}\n", vocabulary.node_count(),
             vocabulary.branching(), vocabulary.depth());
  fmt::print("  idf     {:.3f} to {:.3f}, mean {:.3f}, median {:.3f}\n", idf.front(), idf.back(),
             mean, idf[idf.size() / 2]);
  fmt::print("  from    images: {}, descriptors: {}\n", or_unknown(vocabulary.training_images()),
             or_unknown(vocabulary.training_descriptors()));
  fmt::print("  content digest  {}\n", hex(vocabulary.digest()));
  if (!options.frames.empty()) print_score(vocabulary, options);
}

}  // namespace

void add_vocabulary(CLI::App& app) {
  auto options = std::make_shared<VocabularyArguments>();
  CLI::App* command =
      app.add_subcommand("vocabulary", "Trains, converts and inspects visual vocabularies.");
  command->require_subcommand(1);
  command->footer("Example:\n  modelhouse vocabulary info vocabulary");

  CLI::App* t = command->add_subcommand(
      "train", "Trains on rendered rooms and materials that no evaluation uses, or on images.");
  VocabularyTraining& training = options->training;
  t->add_option("--out", options->out, "Vocabulary file to write")->required();
  t->add_option("--rooms", training.rooms, "Training rooms")->check(CLI::Range(1, 100000));
  t->add_option("--views", training.views, "Images per room")->check(CLI::Range(1, 100000));
  t->add_option("--images", options->list,
                "List of image files, one per line, to train on instead of rooms");
  t->add_option("--branching", training.tree.branching, "Children per node")
      ->check(CLI::Range(2, 255));
  t->add_option("--depth", training.tree.depth, "Levels below the root")->check(CLI::Range(1, 10));
  t->add_option("--seed", training.seed, "Seed of rooms, views and tree")->check(seed_number());
  t->add_option("--threads", training.threads,
                "Rooms processed in parallel; does not change any bit")
      ->check(CLI::Range(1, 1024));
  t->footer("Example:\n  modelhouse vocabulary train --out assets/vocabulary.mhvoc");
  t->callback([options] { train(*options); });

  CLI::App* c = command->add_subcommand(
      "convert",
      "Converts between DBoW2's text format (ORBvoc.txt) and our own, in either direction.");
  c->add_option("file", options->file, "Vocabulary file, or the name of the shipped one")
      ->required();
  c->add_option("--out", options->out,
                "Vocabulary file to write: NAME.txt in DBoW2's text format, any other in ours")
      ->required();
  c->footer(
      "Examples:\n  modelhouse vocabulary convert ORBvoc.txt --out ORBvoc.mhvoc\n"
      "  modelhouse vocabulary convert vocabulary --out out/vocabulary.txt");
  c->callback([options] { convert(*options); });

  CLI::App* i = command->add_subcommand("info", "Prints size, weights, origin and digest.");
  i->add_option("file", options->file, "Vocabulary file, or the name of the shipped one")
      ->required();
  auto* const frames =
      i->add_option("--frames", options->frames,
                    "tum:FOLDER with poses: measures how well words find views of a place");
  i->add_option("--queries", options->queries,
                "tum:FOLDER to take queries from, instead of the frames")
      ->needs(frames);
  auto* const settings =
      i->add_option("--settings", options->settings, "Calibration (YAML, ORB-SLAM's keys)");
  frames->needs(settings);
  i->add_option("--every", options->score.every, "Every n-th frame only")
      ->check(CLI::Range(1, 1000000));
  i->add_option("--overlap", options->score.min_overlap, "Share of a view that its neighbors see")
      ->check(number_between(0.01, 1.0));
  i->footer(
      "Example:\n  modelhouse vocabulary info vocabulary --frames tum:out/sequence "
      "--settings out/sequence/camera.yaml");
  i->callback([options] { info(*options); });
}

}  // namespace mh::cli
