#pragma once
// The pieces into which an outline of the material falls.
#include "continuum/model/outline.hpp"

namespace drumlin::continuum {

struct OutlinePieces {
  std::vector<Outline> outlines;  ///< none crosses itself
  double passed = 0;              ///< area cut off at openings
};

/// Cuts an outline where it crosses itself. Loops that run clockwise are air, which is closed, those inside
/// of another piece lie twice there; both go, and pieces below size^2. A free point less than a fifth of the
/// size above an open opening counts as beyond it: there the material breaks in two. Call with_area()
/// afterwards. Throws NotConvergedError where more air would be closed than `largest_bubble`.
OutlinePieces pieces_of(const Outline& outline, const Region& region, double time, const SizeField& size);

/// The most air that is closed when the material comes down on a wall or on itself: 16 size^2, or 5 % of its
/// area.
double largest_bubble(double size, double area);

}  // namespace drumlin::continuum
