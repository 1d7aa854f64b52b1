// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace mh {

// Charts are drawn by gnuplot, since Debian packages it, it needs no window, and its whole input is
// one script that anyone can change.

/// A text quoted for gnuplot: nothing in it is interpreted, and lines break at '\n'.
std::string gnuplot_text(const std::string& text);

/// The first lines of a script: the output format, by the file's extension (.pdf: vectors, fonts
/// embedded; else a PNG of 300 pixels per inch), and the path.
std::string gnuplot_terminal(const std::filesystem::path& file, double width_cm, double height_cm);

/// Draws a chart into a file; readers see either the old file or the complete new one.
/// @param script  returns the script; receives the path that gnuplot_terminal() needs
/// @throws InputError naming the file if it is neither .pdf nor .png; MachineError if gnuplot is
/// missing or fails.
void draw_by_gnuplot(const std::filesystem::path& file,
                     const std::function<std::string(const std::filesystem::path&)>& script);

}  // namespace mh
