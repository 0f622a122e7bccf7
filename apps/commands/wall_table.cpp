#include "apps/commands/wall_table.hpp"

#include <fmt/format.h>

#include <numbers>

#include "coupling/core/documents/csv.hpp"

namespace drumlin::apps {

std::string wall_lines(particles::Simulation& simulation) {
  const particles::WallLoads loads = simulation.take_wall_loads();
  const Scales& scales = simulation.scales();
  const double mm = scales.length_m * 1e3, second = scales.time_s;
  const double mass = scales.density_kg_m3 * scales.length_m * scales.length_m;
  const double force = mass * scales.length_m / (second * second) / loads.time;
  std::string lines;
  for (std::size_t w = 0; w < loads.walls.size(); ++w) {
    const particles::WallLoad& load = loads.walls[w];
    if (!(load.time > 0)) continue;
    const double t = load.time;
    lines += fmt::format(
        "{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n",
        simulation.state().time() * second, loads.time * second, csv_text(simulation.walls().names[w]),
        load.impulse_x * force, load.impulse_z * force, load.moment * force * scales.length_m,
        load.place.x / t * mm, load.place.z / t * mm, load.place.angle / t * 180 / std::numbers::pi,
        (load.last.x - load.first.x) / t * mm / second, (load.last.z - load.first.z) / t * mm / second,
        (load.last.angle - load.first.angle) / t / second);
  }
  return lines;
}

}  // namespace drumlin::apps
