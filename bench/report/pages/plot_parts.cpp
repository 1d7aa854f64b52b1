// SPDX-License-Identifier: Apache-2.0
#include "bench/report/pages/plot_parts.hpp"

#include <iterator>

#include "bench/report/drawing/gnuplot.hpp"

namespace mh {

namespace {

// The inks differ in lightness, so that they can be told apart in gray and by the color-blind.
constexpr const char* kInks[] = {"#0065a3", "#d98a00", "#00805d", "#b4568c", "#3a9bd9", "#a33f00"};

}  // namespace

const char* ink_of(std::size_t i) {
  return kInks[i % std::size(kInks)];
}

std::string beginning(const PlotOrder& order, const std::filesystem::path& file, double height_cm) {
  return gnuplot_terminal(file, order.width_cm, height_cm) +
         "set key outside top center horizontal noenhanced samplen 6\nset border 3\nset tics "
         "nomirror out scale 0.5\nset grid linecolor '#dddddd' linewidth 0.5\n";
}

}  // namespace mh
