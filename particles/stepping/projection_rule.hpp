#pragma once
// How much of an overlap a position projection takes away in a step, and how exactly.
#include <algorithm>

namespace drumlin::particles {

// A projection that takes away the whole overlap at once opens neighbouring contacts; the load closes them at
// gap/h in the next step, the packing heats, solves get worse and overlap grows: a settling drum of 7183
// discs blew up so.
inline constexpr double usual_correction_share = 0.2;
inline constexpr double largest_correction = 2e-3;  // d per step
// Overlaps of more than this, in d, are few: what a solve leaves at the same pair in several steps. All that
// is beyond goes at once.
inline constexpr double deep_overlap = 2.5e-4;
// Of the residual, relative to the corrections asked for. A few plain Gauss-Seidel sweeps leave the contacts
// that are solved early overlapped, the same ones in every step: their overlap grew to 0.1 d within a second.
inline constexpr double projection_tolerance = 0.05;

/// What a scene may choose of it.
struct ProjectionRule {
  int sweeps = 0;  ///< at most; 0: no projection
  double share = usual_correction_share;

  /// What the projection of a contact with this gap starts from: overlaps ask for a share of themselves, and
  /// for all beyond a deep one.
  double wanted_gap(double gap) const {
    if (gap >= 0) return gap;
    const double beyond = std::min(0.0, gap + deep_overlap);
    return std::max(share * (gap - beyond) + beyond, -largest_correction);
  }
};

}  // namespace drumlin::particles
