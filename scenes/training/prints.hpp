// SPDX-License-Identifier: Apache-2.0
#pragma once

// Drawn and printed sheets among the training patterns; make_training_pattern() is their door.

#include "scenes/training/ink.hpp"

namespace mh::training {

Sheet barcodes(const Ink& ink);   ///< panels of bars of uneven width
Sheet charts(const Ink& ink);     ///< squared paper with curves and marks
Sheet collage(const Ink& ink);    ///< turned rectangles, ellipses and triangles over each other
Sheet confetti(const Ink& ink);   ///< small scattered bits on a plain ground
Sheet halftone(const Ink& ink);   ///< dots whose size follows a cloud
Sheet scales(const Ink& ink);     ///< rows of overlapping arcs
Sheet scribbles(const Ink& ink);  ///< wandering pen lines
Sheet truchet(const Ink& ink);    ///< tiles of quarter arcs, each turned at random
Sheet wire_mesh(const Ink& ink);  ///< crossing wires before something dark

}  // namespace mh::training
