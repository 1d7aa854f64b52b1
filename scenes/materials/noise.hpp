// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/grid2d.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// A periodic scalar field sampled at texels: the basis of procedural textures.
using Field = Grid2d<float>;

/// Value noise in [-1, 1]: random values on a cells_x by cells_y lattice (which wraps around),
/// interpolated with K. Perlin's fade curve.
Field value_noise(int width, int height, int cells_x, int cells_y, RandomStream random);

/// Each octave doubles the lattice resolution and scales its amplitude by `gain`.
struct Octaves {
  int cells_x, cells_y, count;
  float gain;
};
/// Fractal sum of value noise in about [-1, 1]. Octaves finer than two texels are omitted.
Field fbm(int width, int height, const Octaves& octaves, RandomStream random);

/// Independent normal noise at every texel, standard deviation 1.
Field white_noise(int width, int height, RandomStream random);

/// Bilinear sample of a repeating field, at texel coordinates.
float sample(const Field& field, float x, float y);

/// For one random point per lattice cell: the distances, in cells, to the nearest and the
/// second-nearest point, and the lattice index of the nearest. Wraps around.
struct Voronoi {
  Field nearest, second;
  Grid2d<int> cell;
};
/// @param jitter  0 = points at cell centers, 1 = anywhere in their cells.
Voronoi voronoi(int width, int height, int cells_x, int cells_y, float jitter, RandomStream random);

}  // namespace mh
