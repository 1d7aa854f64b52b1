// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include "bench/cli/commands.hpp"
#include "bench/cli/declarations.hpp"
#include "bench/run/run_process.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/run/signal_watch.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/printable.hpp"

namespace {

enum ExitCode {
  kGood = 0,
  kCheckFailed = 1,
  kBadInput = mh::kBadInputCode,
  kMachineFailed = 3,
  kInterrupted = mh::kInterruptedCode
};

int fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  fmt::print(stderr, "{}{}\n", mh::kErrorMark, mh::printable(std::move(message)));
  return code;
}

/// Flushes the buffered output: a full disk is noticed here at the latest.
int finish_output(int code) {
  std::cout.flush();
  const bool lost = std::fflush(stdout) != 0;
  if (!lost && std::ferror(stdout) == 0 && std::cout) return code;
  const std::string why = lost ? fmt::format(": {}", std::strerror(errno)) : "";
  if (code != kGood && code != kCheckFailed) return code;  // already reported
  return fail(kMachineFailed, "standard output: cannot be written" + why);
}

/// The first word that ends in "=" without a value, such as "--out=": CLI11 would take the next
/// word as its value. nullptr if there is none.
const char* option_without_value(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (const std::string_view word = argv[i];
        word.starts_with("--") && word.ends_with('=') && word.find('=') == word.size() - 1)
      return argv[i];
  return nullptr;
}

bool has_commands(const CLI::App& app) {
  return !app.get_subcommands([](const CLI::App*) { return true; }).empty();
}

int run(int argc, char** argv) {
  // A run does not report interrupts: the process that started it must see that it was killed.
  const bool is_run = argc >= 2 && std::string_view(argv[1]) == "run-child";
  if (!is_run) mh::tell_of_interrupts();
  mh::end_at_lost_pages(mh::kErrorMark, is_run ? mh::kInputChangedCode : kBadInput);
  // With this, a write beyond `ulimit -f` fails and is reported instead of ending the process
  // silently.
  std::signal(SIGXFSZ, SIG_IGN);
  // OpenCV must not split its work by the number of processors: results must be the same to the
  // bit.
  cv::setNumThreads(1);
  CLI::App app("Modelhouse: a simulation-backed test bench for object-aware visual SLAM.",
               "modelhouse");
  app.set_version_flag("--version", std::string("modelhouse ") + MH_VERSION);
  app.require_subcommand(1);
  app.option_defaults()->always_capture_default();
  app.footer(
      "Example:\n  modelhouse bench model_house --jobs 2\n"
      "Exit codes: 0 success; 1 the work ran but its check failed; 2 bad usage or bad input;\n"
      "3 the machine or an outside program failed; 130 interrupted: a message says whether\n"
      "the same command resumes the work.");
  mh::cli::add_bench(app);
  mh::cli::add_run_child(app);
  mh::cli::add_merge(app);
  mh::cli::add_export(app);
  mh::cli::add_report(app);
  mh::cli::add_verify(app);
  mh::cli::add_stress(app);
  mh::cli::add_check(app);
  mh::cli::add_audit(app);
  mh::cli::add_diagnose(app);
  mh::cli::add_episode(app);
  mh::cli::add_evaluate(app);
  mh::cli::add_scene(app);
  mh::cli::add_drive(app);
  mh::cli::add_live(app);
  mh::cli::add_render(app);
  mh::cli::add_degrade(app);
  mh::cli::add_sensors(app);
  mh::cli::add_slam(app);
  mh::cli::add_map(app);
  mh::cli::add_twin(app);
  mh::cli::add_detector(app);
  mh::cli::add_vocabulary(app);
  mh::cli::add_reference(app);
  mh::cli::add_declarations(app);
  if (const char* word = option_without_value(argc, argv))
    return fail(kBadInput, fmt::format("'{}': its value is missing", word));
  try {
    app.parse(argc, argv);
    return kGood;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const CLI::App& at = mh::cli::reached(app);
    if (app.remaining(true).empty() && has_commands(at)) {  // no command was given
      fmt::print("{}", app.help());
      return kBadInput;
    }
    return fail(kBadInput, mh::cli::explain(error, app));
  } catch (const mh::cli::CheckFailed&) {
    return kCheckFailed;
  } catch (const mh::Interrupted& interrupted) {
    fmt::print(stderr, "{}", mh::interrupted_line(interrupted.goes_on));
    return kInterrupted;
  } catch (const mh::InputChanged& error) {
    return fail(app.got_subcommand("run-child") ? mh::kInputChangedCode : kBadInput, error.what());
  } catch (const mh::InputError& error) {
    return fail(kBadInput, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(kBadInput, error.what());
  } catch (const mh::DiskFullError& error) {
    return fail(app.got_subcommand("run-child") ? mh::kDiskFullCode : kMachineFailed, error.what());
  } catch (const mh::MachineError& error) {
    return fail(kMachineFailed, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kMachineFailed, "out of memory");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(kMachineFailed,
                fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::exception& error) {
    return fail(kMachineFailed, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Every frame allocates and frees images. If the process keeps their memory, it avoids page
  // faults, which would take a tenth of the time of `slam`.
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TRIM_THRESHOLD, 128 << 20);
  return finish_output(run(argc, argv));
}
