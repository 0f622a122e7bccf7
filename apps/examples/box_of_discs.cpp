// Sixty discs fall into a box. After each step a callback sees grains and contacts; here it asks when they
// are at rest.
#include <cmath>
#include <cstdio>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"

using namespace drumlin::particles;

// A scene is a text, here as in a file. `drumlin scene keys` lists what it can say.
const char* const box = R"(
format = "drumlin-scene-1"
title = "A box of discs"
grains.density_kg_m3 = 2700
grains.generated = { count = 60, diameter_min_mm = 1.8, diameter_max_mm = 2.2, region = { shape = "rectangle", min_mm = [0, 0], max_mm = [20, 40] } }
walls = [{ name = "box", shape = "polyline", x_mm = [0, 0, 20, 20], z_mm = [60, 0, 0, 60] }]
effects = { gravity = {}, friction = { grain_grain = 0.4, grain_wall = 0.4 }, spin = {} }
stages = [{ name = "fall", duration_s = 0.5, time_step_s = 1e-3 }]
solver.tolerance = 1e-4
)";

int main() {
  try {
    Simulation simulation(parse_scene(box, "box"));
    double wall_force = 0, residual = 0, moved = 1;
    run_through(simulation, [&](const StepReport& report) {
      residual = std::fmax(residual, report.solve.residual.rms);
      double impulse = 0;  // upwards, of the walls: along the normal, and by friction along (n_z, -n_x)
      for (const SnapshotContact& c : simulation.last_contacts())
        if (c.j < 0) impulse += c.impulse_n * c.normal_z - c.impulse_t * c.normal_x;
      wall_force = impulse / simulation.last_time_step();
      const double before = std::exchange(moved, kinetic_energy(simulation.state().bodies));
      return std::fmax(before, moved) > 1e-8;  // at rest before and after a step: false ends it
    });
    double weight = 0;
    for (const double inverse_mass : simulation.state().bodies.inverse_mass) weight += 1 / inverse_mass;
    // All in units of d, sqrt(d/g) and the density of the discs: simulation.scales() says what these are.
    std::printf(
        "%zu discs at rest after %.3f s; the box carries %.4f of their weight; largest residual %.1e\n",
        simulation.state().bodies.count(), simulation.state().time() * simulation.scales().time_s,
        wall_force / weight, residual);
    return std::abs(wall_force / weight - 1) < 0.01 ? 0 : 1;
  } catch (const drumlin::InputError& error) {  // says line, key and what would be allowed
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
