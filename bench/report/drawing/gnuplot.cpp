// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {

namespace fs = std::filesystem;

namespace {

/// Runs gnuplot on a script and writes its output and errors to the file `said`.
bool ended_well(const fs::path& script, const fs::path& said) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, said.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::string program = "gnuplot", input = script.string();
  char* const arguments[] = {program.data(), input.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  while (failed == 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return failed == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::string gnuplot_text(const std::string& text) {
  std::istringstream lines(text);
  std::string quoted;
  for (std::string line; std::getline(lines, line);) {
    quoted += quoted.empty() ? "'" : ".\"\\n\".'";
    // Within single quotes, only a single quote is special; gnuplot misreads a doubled one at the
    // start of a text.
    for (const char c : printable(line))
      quoted += c == '\'' ? std::string("\u2019") : std::string(1, c);
    quoted += "'";
  }
  return quoted.empty() ? "''" : quoted;
}

std::string gnuplot_terminal(const fs::path& file, double width_cm, double height_cm) {
  const auto pixels = [](double cm) { return std::lround(cm / 2.54 * 300); };
  const std::string terminal =
      file.extension() == ".pdf"
          ? fmt::format("pdfcairo size {}cm,{}cm font 'DejaVu Sans,8' fontscale 0.8 linewidth 1",
                        width_cm, height_cm)
          : fmt::format(
                "pngcairo size {},{} font 'DejaVu Sans,8' fontscale 3.1 linewidth 3.1 pointscale "
                "3.1",
                pixels(width_cm), pixels(height_cm));
  return fmt::format("set terminal {}\nset output {}\n", terminal, gnuplot_text(file.string()));
}

void draw_by_gnuplot(const fs::path& file,
                     const std::function<std::string(const fs::path&)>& script) {
  if (file.extension() != ".pdf" && file.extension() != ".png")
    throw InputError(fmt::format("{}: charts are drawn as .pdf or .png", file.string()));
  const TemporaryFolder work(fs::temp_directory_path());
  const fs::path input = work.path() / "chart.gnuplot", errors = work.path() / "errors.txt";
  write_atomically(file, [&](const fs::path& temporary) {
    write_atomically(input, script(fs::absolute(temporary)));
    if (ended_well(input, errors) && is_file(temporary)) return;
    const std::string said = is_file(errors) ? printable(read_file(errors)) : std::string();
    throw MachineError(fmt::format("gnuplot cannot draw {} (Debian: gnuplot-nox): {}",
                                   file.string(), said.substr(0, 300)));
  });
}

}  // namespace mh
