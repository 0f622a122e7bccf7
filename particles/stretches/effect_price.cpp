#include "particles/stretches/effect_price.hpp"

#include <malloc.h>

#include "coupling/core/machine/own_costs.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {
namespace {

/// Bytes that the program has asked for and not given back.
double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// What the grains do at one instant, in the units of the simulation, per mass.
struct Instant {
  double energy = 0, x = 0, z = 0;
};

Instant instant_of(const Bodies& bodies) {
  Instant now;
  double mass = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double m = 1 / bodies.inverse_mass[b];
    mass += m, now.x += m * bodies.x[b], now.z += m * bodies.z[b];
  }
  now.energy = kinetic_energy(bodies) / mass, now.x /= mass, now.z /= mass;
  return now;
}

double slope_of(const EffectPrice& price, const Scene& scene) {
  if (!scene.effects.gravity) return std::nan("");
  for (const Wall& wall : scene.walls)
    if (const auto* container = std::get_if<ContainerShape>(&wall.shape)) {
      const double down = scene.effects.gravity->direction_deg * M_PI / 180;
      const double hangs = std::atan2(price.center_z_mm - container->center_mm[1],
                                      price.center_x_mm - container->center_mm[0]);
      return std::abs(std::remainder(hangs - down, 2 * M_PI)) * 180 / M_PI;
    }
  return std::nan("");
}

}  // namespace

EffectPrice price_of(const Scene& scene, double seconds, int threads,
                     const std::function<void()>& after_step) {
  EffectPrice price;
  const double bytes_before = heap_bytes(), start = own_cpu_seconds();
  Simulation simulation(scene, threads);
  const Scales& scales = simulation.scales();
  const double end = seconds / scales.time_s;
  double steps = 0, late = 0;
  while (!simulation.finished() && simulation.state().time() < end) {
    const StepReport report = simulation.step();
    after_step();
    steps += 1;
    price.detection_seconds += report.detection_seconds;
    price.solver_seconds += report.solve.seconds;
    price.contacts += report.contacts;
    price.sweeps += report.solve.sweeps;
    price.missed += report.contacts > 0 && report.solve.status != Status::converged;
    if (simulation.state().time() < end / 2) continue;
    const Instant now = instant_of(simulation.state().bodies);
    late += 1;
    price.kinetic_energy_J_kg += now.energy, price.center_x_mm += now.x, price.center_z_mm += now.z;
    price.overlap_d += report.overlap.mean;
  }
  price.cpu_seconds = own_cpu_seconds() - start;
  price.bytes = heap_bytes() - bytes_before;
  price.unknowns_per_contact = simulation.stepper().unknowns_per_contact();
  price.velocities_per_body = simulation.stepper().velocities_per_body();
  for (double* mean : {&price.contacts, &price.sweeps, &price.missed}) *mean /= steps;
  price.kinetic_energy_J_kg *= std::pow(scales.velocity_m_s(), 2) / late;
  price.center_x_mm *= scales.length_m * 1e3 / late, price.center_z_mm *= scales.length_m * 1e3 / late;
  price.overlap_d /= late;
  price.slope_deg = slope_of(price, scene);
  return price;
}

}  // namespace drumlin::particles
