#pragma once
// regions.csv of a run and what run.json says of it: grains that outlets have taken and sources have poured
// (docs/formats/run.md).
#include <string>
#include <vector>

#include "coupling/core/documents/described.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

inline constexpr const char* region_table_name = "regions.csv";
inline constexpr const char* region_table_header = "step,time_s,region,out,in,waiting\n";

/// A line for each outlet and each source, with counts since the start.
std::string region_lines(const particles::Scene& scene, const particles::Simulation& simulation);

struct OutletRate {
  double grains_per_s = 0, ci99 = 0, from_s = 0, to_s = 0;
};
DRUMLIN_DESCRIBED(OutletRate, grains_per_s, ci99, from_s, to_s)

/// Counts of one region since the start, in run.json.
struct RegionTotals {
  std::string name;
  std::int64_t out = 0, in = 0, waiting = 0;
  std::optional<double> out_kg_m = {};  ///< of an outlet
  std::optional<OutletRate> rate = {};
};
DRUMLIN_DESCRIBED(RegionTotals, name, out, in, waiting, out_kg_m, rate)

std::vector<RegionTotals> regions_of(const particles::Scene& scene, const particles::Simulation& simulation);
/// The same in words, a line each; empty for a scene without outlets and sources.
std::string regions_text(const particles::Scene& scene, const particles::Simulation& simulation);

}  // namespace drumlin::apps
