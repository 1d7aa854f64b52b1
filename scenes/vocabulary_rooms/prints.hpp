// SPDX-License-Identifier: Apache-2.0
#pragma once

// Drawn and printed sheets among the training patterns; call them through make_training_pattern().

#include "scenes/vocabulary_rooms/ink.hpp"

namespace mh::training {

Sheet barcodes(const Ink& ink);   ///< panels of bars of uneven width
Sheet charts(const Ink& ink);     ///< grid paper with curves and marks
Sheet collage(const Ink& ink);    ///< rotated, overlapping rectangles, ellipses and triangles
Sheet confetti(const Ink& ink);   ///< small scattered pieces on a plain ground
Sheet halftone(const Ink& ink);   ///< dots whose size follows a noise field
Sheet scales(const Ink& ink);     ///< rows of overlapping arcs
Sheet scribbles(const Ink& ink);  ///< wandering pen lines
Sheet truchet(const Ink& ink);    ///< tiles of quarter arcs, each rotated at random
Sheet wire_mesh(const Ink& ink);  ///< crossing wires in front of a dark background

}  // namespace mh::training
