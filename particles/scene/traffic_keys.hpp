#pragma once
// The keys of outlets and sources, each described once (scene_keys.hpp).
#include "coupling/core/documents/key_table.hpp"
#include "particles/effects/key_ranges.hpp"
#include "particles/scene/traffic.hpp"

namespace drumlin::particles {

template <class Visitor>
void describe(Visitor& v, Outlet& o) {
  v.value("name", o.name, required("", not_empty(), "Name, in regions.csv."));
  v.table("region", o.region, Need::required, "By the grains' centres.");
  v.optional_table("returns_to", o.returns_to,
                   "They come back here as new ones, at random places with room.");
  v.value("return_velocity_mm_s", o.return_velocity_mm_s,
          defaulted("mm/s", at_least(-1e9, 1e9), "Their velocity [v_x, v_z] then."));
}

template <class Visitor>
void describe(Visitor& v, Source& s) {
  v.value("name", s.name, required("", not_empty(), "Name, in regions.csv."));
  v.table("region", s.region, Need::required, "Random places; grains without room wait.");
  v.value("grains_per_s", s.grains_per_s, required("1/s", above(0, 1e9), "Grains per simulated second."));
  v.value("count", s.count, when_given("", at_least(1, 1e8), "In all; without: no end."));
  v.value("diameter_min_mm", s.diameter_min_mm, required("mm", length_mm(), "Smallest diameter."));
  v.value("diameter_max_mm", s.diameter_max_mm, required("mm", length_mm(), "Largest diameter."));
  v.optional_table("sizes", s.sizes, "Of the diameters; without: uniform.");
  v.value("material", s.material, when_given("", not_empty(), "One of grains.materials."));
  v.value("density_kg_m3", s.density_kg_m3,
          when_given("kg/m3", above(0, 1e6), "Without: grains.density_kg_m3."));
  v.value("velocity_mm_s", s.velocity_mm_s,
          defaulted("mm/s", at_least(-1e9, 1e9), "Velocity [v_x, v_z] of new grains."));
}

}  // namespace drumlin::particles
