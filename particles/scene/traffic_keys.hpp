#pragma once
// The keys of outlets and sources, each described once (scene_keys.hpp).
#include "coupling/documents/key_table.hpp"
#include "particles/effects/key_ranges.hpp"
#include "particles/scene/traffic.hpp"

namespace drumlin::particles {

template <class Visitor>
void describe(Visitor& v, Outlet& o) {
  v.value("name", o.name, required("", not_empty(), "Name of the outlet, for regions.csv."));
  v.table("region", o.region, Need::required, "A grain whose centre is in it is taken away and counted.");
  v.optional_table("returns_to", o.returns_to,
                   "Grains come back in this region as new ones, at random places where there is room.");
  v.value("return_velocity_mm_s", o.return_velocity_mm_s,
          defaulted("mm/s", at_least(-1e9, 1e9), "Velocity [v_x, v_z] with which they come back."));
}

template <class Visitor>
void describe(Visitor& v, Source& s) {
  v.value("name", s.name, required("", not_empty(), "Name of the source, for regions.csv."));
  v.table("region", s.region, Need::required,
          "Grains are poured at random places of it; those without room wait.");
  v.value("grains_per_s", s.grains_per_s, required("1/s", above(0, 1e9), "Grains per simulated second."));
  v.value("count", s.count,
          when_given("", at_least(1, 1e8), "Number of grains in all; without, as long as the run goes."));
  v.value("diameter_min_mm", s.diameter_min_mm, required("mm", length_mm(), "Smallest diameter."));
  v.value("diameter_max_mm", s.diameter_max_mm, required("mm", length_mm(), "Largest diameter."));
  v.optional_table("sizes", s.sizes,
                   "Distribution of the diameters; without it they are uniform between the two.");
  v.value("material", s.material, when_given("", not_empty(), "One of grains.materials."));
  v.value("density_kg_m3", s.density_kg_m3,
          when_given("kg/m3", above(0, 1e6), "Density of a disc; without, grains.density_kg_m3."));
  v.value("velocity_mm_s", s.velocity_mm_s,
          defaulted("mm/s", at_least(-1e9, 1e9), "Velocity [v_x, v_z] with which grains are poured."));
}

}  // namespace drumlin::particles
