#include "apps/commands/region_table.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "coupling/core/documents/csv.hpp"
#include "particles/measurement/flow_rate.hpp"

namespace drumlin::apps {
namespace {

/// Counts of one region since the start.
struct Counts {
  std::string name;
  std::int64_t out = 0, in = 0, waiting = 0;
};

std::vector<Counts> counts_of(const particles::Scene& scene, const particles::Simulation& simulation) {
  std::vector<Counts> counts;
  const auto& traffic = simulation.state().traffic;
  if (!traffic) return counts;
  for (std::size_t o = 0; o < scene.outlets.size(); ++o) {
    const particles::OutletState& outlet = traffic->outlets[o];
    const auto wait = static_cast<std::int64_t>(outlet.waiting.size());
    counts.push_back({scene.outlets[o].name, outlet.taken(),
                      scene.outlets[o].returns_to ? outlet.taken() - wait : 0, wait});
  }
  const double seconds = simulation.state().time() * simulation.scales().time_s;
  for (std::size_t s = 0; s < scene.sources.size(); ++s)
    counts.push_back({scene.sources[s].name, 0, traffic->poured[s],
                      particles::waiting(scene.sources[s], traffic->poured[s], seconds)});
  return counts;
}

}  // namespace

std::string region_lines(const particles::Scene& scene, const particles::Simulation& simulation) {
  std::string lines;
  const auto& state = simulation.state();
  for (const Counts& count : counts_of(scene, simulation))
    lines += fmt::format("{},{:.9g},{},{},{},{}\n", state.step, state.time() * simulation.scales().time_s,
                         csv_text(count.name), count.out, count.in, count.waiting);
  return lines;
}

nlohmann::ordered_json regions_report(const particles::Scene& scene,
                                      const particles::Simulation& simulation) {
  nlohmann::ordered_json regions = nlohmann::ordered_json::array();
  const auto counts = counts_of(scene, simulation);
  const Scales& scales = simulation.scales();
  const double mass = scales.density_kg_m3 * scales.length_m * scales.length_m;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    nlohmann::ordered_json region = {{"name", counts[c].name},
                                     {"out", counts[c].out},
                                     {"in", counts[c].in},
                                     {"waiting", counts[c].waiting}};
    if (c < scene.outlets.size()) {
      const particles::OutletState& outlet = simulation.state().traffic->outlets[c];
      region["out_kg_m"] = outlet.mass * mass;
      if (const auto flow = particles::flow_rate(outlet.times))
        region["rate"] = {{"grains_per_s", flow->rate / scales.time_s},
                          {"ci99", flow->ci99 / scales.time_s},
                          {"from_s", flow->from * scales.time_s},
                          {"to_s", flow->to * scales.time_s}};
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

std::string regions_text(const particles::Scene& scene, const particles::Simulation& simulation) {
  std::string text;
  for (const auto& region : regions_report(scene, simulation)) {
    text += fmt::format("{}: {} grains out, {} in, {} wait for room", region["name"].get<std::string>(),
                        region["out"].get<std::int64_t>(), region["in"].get<std::int64_t>(),
                        region["waiting"].get<std::int64_t>());
    if (region.contains("rate"))
      text += fmt::format("; {:.4g} +- {:.2g} grains/s (99 %) from {:.3g} to {:.3g} s",
                          region["rate"]["grains_per_s"].get<double>(), region["rate"]["ci99"].get<double>(),
                          region["rate"]["from_s"].get<double>(), region["rate"]["to_s"].get<double>());
    text += "\n";
  }
  return text;
}

}  // namespace drumlin::apps
