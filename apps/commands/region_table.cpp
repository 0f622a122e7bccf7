#include "apps/commands/region_table.hpp"

#include <fmt/format.h>

#include "coupling/core/documents/csv.hpp"
#include "particles/measurement/flow_rate.hpp"

namespace drumlin::apps {
namespace {

std::vector<RegionTotals> counts_of(const particles::Scene& scene, const particles::Simulation& simulation) {
  std::vector<RegionTotals> counts;
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
  for (const RegionTotals& count : counts_of(scene, simulation))
    lines += fmt::format("{},{:.9g},{},{},{},{}\n", state.step, state.time() * simulation.scales().time_s,
                         csv_text(count.name), count.out, count.in, count.waiting);
  return lines;
}

std::vector<RegionTotals> regions_of(const particles::Scene& scene, const particles::Simulation& simulation) {
  auto regions = counts_of(scene, simulation);
  const auto& [length, time, density] = simulation.scales();
  for (std::size_t o = 0; !regions.empty() && o < scene.outlets.size(); ++o) {
    const particles::OutletState& outlet = simulation.state().traffic->outlets[o];
    regions[o].out_kg_m = outlet.mass * (density * length * length);
    if (const auto flow = particles::flow_rate(outlet.times))
      regions[o].rate = {flow->rate / time, flow->ci99 / time, flow->from * time, flow->to * time};
  }
  return regions;
}

std::string regions_text(const particles::Scene& scene, const particles::Simulation& simulation) {
  std::string text;
  for (const auto& [name, out, in, waiting, mass, rate] : regions_of(scene, simulation)) {
    text += fmt::format("{}: {} grains out, {} in, {} wait for room", name, out, in, waiting);
    if (rate)
      text += fmt::format("; {:.4g} +- {:.2g} grains/s (99 %) from {:.3g} to {:.3g} s", rate->grains_per_s,
                          rate->ci99, rate->from_s, rate->to_s);
    text += "\n";
  }
  return text;
}

}  // namespace drumlin::apps
