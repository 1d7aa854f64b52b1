// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/protocol/digest.hpp"
#include "bench/vocabulary_training.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string file;
  VocabularyTraining training;
};

void train(const Options& options) {
  const std::filesystem::path out = options.file;
  make_output_folder(out.has_parent_path() ? out.parent_path() : std::filesystem::path("."));
  Progress progress("vocabulary");
  const Vocabulary vocabulary = train_vocabulary(options.training, [&](int done, int total) {
    progress.share(static_cast<double>(done) / total);
  });
  vocabulary.save(out);
  fmt::print("{}: {} words, digest {}\n", out.string(), vocabulary.size(),
             hex(vocabulary.digest()));
}

void info(const Options& options) {
  const Vocabulary vocabulary = Vocabulary::load(options.file);
  std::vector<float> idf;
  for (WordId word = 0; word < vocabulary.size(); ++word) idf.push_back(vocabulary.idf(word));
  std::sort(idf.begin(), idf.end());
  fmt::print("{}\n  words   {}\n  digest  {}\n", options.file, vocabulary.size(),
             hex(vocabulary.digest()));
  if (!idf.empty())
    fmt::print("  idf     {:.3f} to {:.3f}, median {:.3f}\n", idf.front(), idf.back(),
               idf[idf.size() / 2]);
}

}  // namespace

void add_vocabulary(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("vocabulary", "Trains and shows visual vocabularies.");
  command->require_subcommand(1);
  command->footer("Example:\n  modelhouse vocabulary info assets/vocabulary.mhvoc");

  CLI::App* t = command->add_subcommand(
      "train", "Trains on rendered rooms and materials that no evaluation uses.");
  VocabularyTraining& training = options->training;
  t->add_option("--out", options->file, "Vocabulary file to write")->required();
  t->add_option("--rooms", training.rooms, "Training rooms")->check(CLI::Range(1, 100000));
  t->add_option("--views", training.views, "Pictures per room")->check(CLI::Range(1, 100000));
  t->add_option("--seed", training.seed, "Seed of rooms, views and tree");
  t->add_option("--threads", training.threads, "Rooms side by side; changes no bit")
      ->check(CLI::Range(1, 1024));
  t->footer("Example:\n  modelhouse vocabulary train --out assets/vocabulary.mhvoc");
  t->callback([options] { train(*options); });

  CLI::App* i = command->add_subcommand("info", "Prints size, weights and digest.");
  i->add_option("file", options->file, "Vocabulary file")->required();
  i->footer("Example:\n  modelhouse vocabulary info assets/vocabulary.mhvoc");
  i->callback([options] { info(*options); });
}

}  // namespace mh::cli
