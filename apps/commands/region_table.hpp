#pragma once
// regions.csv of a run and what run.json says of it: grains that outlets have taken and sources have poured
// (docs/formats/run.md).
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

inline constexpr const char* region_table_name = "regions.csv";
inline constexpr const char* region_table_header = "step,time_s,region,out,in,waiting\n";

/// A line for each outlet and each source, with counts since the start.
std::string region_lines(const particles::Scene& scene, const particles::Simulation& simulation);

/// Totals, and of each outlet the rate with its interval.
nlohmann::ordered_json regions_report(const particles::Scene& scene, const particles::Simulation& simulation);
/// The same in words, a line each; empty for a scene without outlets and sources.
std::string regions_text(const particles::Scene& scene, const particles::Simulation& simulation);

}  // namespace drumlin::apps
