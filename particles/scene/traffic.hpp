#pragma once
// Outlets and sources: regions of a scene in which grains are taken away, and in which others are poured.
#include <array>
#include <optional>
#include <string>
#include <variant>

#include "particles/scene/generated_grains.hpp"

namespace drumlin::particles {

/// Takes away every grain whose centre is in the region, and counts it.
struct Outlet {
  std::string name;
  std::variant<CircleRegion, RectangleRegion> region;
  /// Grains come back in this region, as new ones, at random places where there is room.
  std::optional<std::variant<CircleRegion, RectangleRegion>> returns_to = {};
  std::array<double, 2> return_velocity_mm_s{0, 0};
};

/// Pours grains at random places of its region, so many per second; those without room wait.
struct Source {
  std::string name;
  std::variant<CircleRegion, RectangleRegion> region;
  double grains_per_s = 0;
  std::optional<int> count = {};  ///< in all; without, as long as the run goes
  double diameter_min_mm = 0;
  double diameter_max_mm = 0;
  std::optional<Sizes> sizes = {};
  std::optional<std::string> material = {};
  std::optional<double> density_kg_m3 = {};  ///< without, that of the scene
  std::array<double, 2> velocity_mm_s{0, 0};
};

}  // namespace drumlin::particles
