#pragma once
// Grains made from a distribution: their number, their sizes and the region in which they are placed.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/basics/enum_names.hpp"
#include "particles/effects/key_ranges.hpp"

namespace drumlin::particles {

/// Region in which generated grains are placed.
struct CircleRegion {
  Point_mm center_mm{0, 0};
  double radius_mm = 0;
};
struct RectangleRegion {
  Point_mm min_mm{0, 0};
  Point_mm max_mm{0, 0};
};

/// What a distribution counts.
enum class CountedBy { number, mass };
constexpr auto names_of(CountedBy) { return std::array{"number", "mass"}; }

/// Diameters that are either the smallest or the largest.
struct TwoSizes {
  double small_share = 0;
  std::optional<CountedBy> by = {};  ///< what shares count; absent: number
};
/// Numbers, or mass, per diameter as D^-exponent, from the smallest to the largest.
struct PowerLawSizes {
  double exponent = 0;
  std::optional<CountedBy> by = {};
};
/// Normal in ln D, by number or by mass, cut at the smallest and the largest.
struct LognormalSizes {
  double median_mm = 0;
  double sigma = 0;  ///< of ln D
  std::optional<CountedBy> by = {};
};
/// A sieve analysis: the share of the mass that passes each opening, none the smallest diameter and all the
/// largest. Between two openings the mass is spread evenly over ln D, the straight line of grading curves.
struct SieveSizes {
  std::vector<double> openings_mm, passing_share;
};
using Sizes = std::variant<TwoSizes, PowerLawSizes, LognormalSizes, SieveSizes>;

/// apart: none touches another. deposited: in hollows, nearly at rest (deposited_placement.hpp).
enum class Placement { apart, deposited };
constexpr auto names_of(Placement) { return std::array{"apart", "deposited"}; }

/// Grains made from a distribution, placed without overlap in the region, from below.
struct GeneratedGrains {
  int count = 0;
  double diameter_min_mm = 0;
  double diameter_max_mm = 0;
  std::variant<CircleRegion, RectangleRegion> region;
  /// Without: uniform between the two, on a lattice of the largest. With: placed at random, the largest
  /// first.
  std::optional<Sizes> sizes = {};
  Placement placement = Placement::apart;
  bool deposited() const { return placement == Placement::deposited; }
  /// Walls that may reach into the region: no grain is placed in them (obstacles.hpp).
  std::optional<std::vector<std::string>> around = {};
};

}  // namespace drumlin::particles
