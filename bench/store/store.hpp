// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/protocol/run_result.hpp"
#include "bench/suite/suite.hpp"

namespace SQLite {
class Database;
}

namespace mh {

class TemporaryFolder;

/// What a run cost; differs from one execution to the next.
struct RunCost {
  double wall_s = 0;
  double cpu_s = 0;  ///< user and system time of its process
  // Parts of cpu_s:
  double slam_s = 0;      ///< inside the system under test, if it runs in our process
  double frames_s = 0;    ///< making its frames: scene, light and drives included
  double products_s = 0;  ///< occupancy map, images and files of the run
  double max_rss_mb = 0;
  Circumstances circumstances = {};  ///< without the host, which the store knows
};

enum class RunStatus { kDone, kFailed };

/// Name and key of each run of a suite, in the order of expand().
using PlannedKeys = std::vector<std::pair<std::string, std::string>>;

/// The results of a suite in one SQLite file (docs/store.md). A result is stored in one
/// transaction: it is stored completely or not at all, even if a process dies. Several processes
/// may use one file. Errors state what to do: InputError for a file that is damaged, has a
/// different schema or is not a results file; MachineError for a full disk or a file that another
/// process keeps locked.
class Store {
 public:
  /// Opens or creates the file.
  explicit Store(std::filesystem::path file);
  ~Store();
  Store(Store&&) noexcept;
  /// Opens a file, or the one in a folder, without changing it: it may be in a read-only place. (A
  /// log that a killed process left next to it is applied, as SQLite does.)
  /// @throws InputError if it does not exist, or as check() does
  static Store open_to_read(const std::filesystem::path& file);
  /// @throws InputError naming file, table and row if a row differs from what was stored.
  void check() const;

  /// Records the suite and which result belongs to which of its runs, replacing the earlier record.
  /// Results are kept.
  void plan(const Suite& suite, const SuiteOverrides& overrides, const PlannedKeys& key_of_name);
  /// Whether this is exactly the recorded suite.
  bool is_planned(const Suite& suite, const SuiteOverrides& overrides,
                  const PlannedKeys& key_of_name) const;
  /// The recorded suite. @throws InputError if there is none, or if no file matches a pattern
  /// `files` of its environments.
  Suite planned_suite() const;
  PlannedKeys planned_keys() const;

  std::optional<RunStatus> status(const std::string& key) const;
  /// Error of a failed run; empty if it did not fail.
  std::string error(const std::string& key) const;

  /// Claims a run that is neither finished nor in progress. Another process's claim is taken over
  /// if that process has died, or if it is on another host and has been silent for kClaimLife_s.
  bool claim(const std::string& key);
  void release(const std::string& key);
  void beat();  ///< marks this process's claims as alive
  static constexpr int kClaimLife_s = 120;

  /// put() and put_failure() also end the claim. A failed run is excluded from the tables.
  void put(const std::string& key, const RunResult& run, const RunCost& cost);
  void put_failure(const std::string& key, const RunSpec& spec, const std::string& error,
                   const RunCost& cost);
  void forget_failure(const std::string& key);
  /// Removes a result, so that it is rerun.
  void forget(const std::string& key);

  /// Loads a finished run, without its volume and grid; `spec` supplies names and paths.
  RunResult load(const std::string& key, const RunSpec& spec) const;
  /// The largest resident set of any finished run, MB; 0 if no run has finished.
  double largest_rss_mb() const;

  /// Copies the results of another store that this one lacks; returns the number of runs copied.
  /// @throws InputError if a run of the same name was planned with different settings, code or
  /// input.
  std::size_t merge(const std::filesystem::path& other);
  /// Checks that all files can be merged. @throws InputError as merge() does, or if they contain
  /// results of different suites, or of the same suite with different trials or runs, or a damaged
  /// result.
  static void check_mergeable(const std::vector<std::filesystem::path>& files);

  /// Rows of a query, for exports: column names first.
  using Value = std::variant<std::monostate, std::int64_t, double, std::string>;  ///< null first
  std::vector<std::vector<Value>> values(const std::string& sql) const;
  /// The same as text: null is empty, numbers are printed so that they round-trip.
  std::vector<std::vector<std::string>> rows(const std::string& sql) const;

  const std::filesystem::path& file() const { return file_; }

 private:
  Store();

  std::filesystem::path file_;
  std::string opened_;  ///< what SQLite opened to read: a copy's name, or a URI with options
  std::unique_ptr<TemporaryFolder> copy_;
  std::unique_ptr<SQLite::Database> database_;  ///< closed before its copy is removed
};

/// A store's results for a suite.
struct BenchResults {
  std::vector<RunResult> runs;       ///< finished ones, in the order of expand(suite)
  std::vector<FailedRun> failed;     ///< failed ones, in the same order
  std::vector<std::string> missing;  ///< names of the remaining runs, such as those of other shards
};

/// Loads the store's results for the runs of a suite.
/// @param keys  of all its runs
BenchResults load_results(const Store& store, const Suite& suite, const PlannedKeys& keys);
/// The same for the suite that was planned last.
BenchResults load_results(const Store& store, const Suite& suite);

/// The current time, "2026-11-22T07:08:40Z".
std::string utc_now();

/// The shortest text that reads back as the same double.
std::string exact(double value);

}  // namespace mh
