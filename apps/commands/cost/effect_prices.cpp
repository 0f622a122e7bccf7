// drumlin cost --effects: the price list of a scene. The scene as it is, each of its effects removed, each
// absent one added, one after the other; what each takes in time, memory and unknowns, and what it changes.
#include <fmt/format.h>
#include <malloc.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/sweep.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/progress.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/scene/effect_variants.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

/// Bytes that the program has asked for and not given back.
double heap_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// What one variant takes, and what it leads to: means over the second half of its steps, in SI.
struct Price {
  double cpu_seconds = 0, detection_seconds = 0, solver_seconds = 0;
  double bytes = 0;
  int unknowns_per_contact = 0, velocities_per_body = 0;
  double contacts = 0, sweeps = 0, missed = 0;  ///< per step; share of steps that missed a tolerance
  double kinetic_energy_J_kg = 0;
  double center_x_mm = 0, center_z_mm = 0;
  double slope_deg = std::nan("");  ///< of the centre of mass about the container's centre, against gravity
  double overlap_d = 0;
  double unknowns() const { return contacts * unknowns_per_contact; }
};

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

double slope_of(const Price& price, const Scene& scene) {
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

/// Runs a scene's first `seconds`; an interruption leaves it unfinished.
Price price_of(const Scene& scene, double seconds, int threads) {
  Price price;
  const double bytes_before = heap_bytes(), start = process_seconds();
  Simulation simulation(scene, threads);
  const Scales& scales = simulation.scales();
  const double end = seconds / scales.time_s;
  double steps = 0, late = 0;
  while (!simulation.finished() && simulation.state().time() < end && interruption() == 0) {
    const StepReport report = simulation.step();
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
  price.cpu_seconds = process_seconds() - start;
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

std::string name_of(const EffectVariant& variant) {
  if (variant.change == EffectChange::none) return "as it is";
  return (variant.change == EffectChange::removed ? "without " : "with ") + variant.effect +
         (variant.with_it.empty() ? "" : ": " + variant.with_it);
}

nlohmann::ordered_json to_json(const EffectVariant& variant) {
  static const char* const words[] = {"none", "removed", "added"};
  nlohmann::ordered_json row;
  row["effect"] = variant.effect;
  row["change"] = words[static_cast<int>(variant.change)];
  row["with_it"] = variant.with_it;
  return row;
}

void add_price(nlohmann::ordered_json& row, const Price& p) {
  row["cpu_seconds"] = p.cpu_seconds;
  row["detection_seconds"] = p.detection_seconds;
  row["solver_seconds"] = p.solver_seconds;
  row["bytes"] = p.bytes;
  row["unknowns"] = p.unknowns();
  row["unknowns_per_contact"] = p.unknowns_per_contact;
  row["velocities_per_body"] = p.velocities_per_body;
  row["contacts"] = p.contacts;
  row["sweeps"] = p.sweeps;
  row["missed_share"] = p.missed;
  row["kinetic_energy_J_kg"] = p.kinetic_energy_J_kg;
  row["center_of_mass_mm"] = {p.center_x_mm, p.center_z_mm};
  row["slope_deg"] = std::isnan(p.slope_deg) ? nlohmann::ordered_json() : nlohmann::ordered_json(p.slope_deg);
  row["overlap_d"] = p.overlap_d;
}

void print_row(const std::string& name, const Price& p) {
  fmt::print("{:7.2f} s {:7.2f} MB {:8.0f} {:6.1f} {:5.1f} % {:10.3g} {:8.2f} {:>7} {:9.2g}  {}\n",
             p.cpu_seconds, p.bytes / (1 << 20), p.unknowns(), p.sweeps, 100 * p.missed,
             p.kinetic_energy_J_kg, p.center_z_mm,
             std::isnan(p.slope_deg) ? "-" : fmt::format("{:.2f}", p.slope_deg), p.overlap_d, name);
  std::fflush(stdout);
}

}  // namespace

int price_particle_effects(const CostOptions& options) {
  const Scene scene = read_scene(options.scene, options.overrides);
  (void)Simulation(scene);
  if (options.output) prepare_output(*options.output, options.existing, {"cost.json"}, {options.scene});
  catch_interruptions();
  nlohmann::ordered_json report, rows = nlohmann::ordered_json::array();
  fmt::print("{}: the first {:g} s; results are means over the second half\n{}{}\n", options.scene.string(),
             options.seconds, scene.reduced ? "reduced\n" : "",
             "     time     memory unknowns sweeps  missed energy J/kg centre z   slope   overlap  scene\n"
             "                                                             mm     deg         d");
  auto variants = effect_variants(scene);
  // Once more at the end: what differs between the two is noise of the machine.
  variants.push_back(variants.front());
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const EffectVariant& variant = variants[v];
    const std::string name =
        v > 0 && variant.change == EffectChange::none ? "as it is, again" : name_of(variant);
    auto row = to_json(variant);
    row["name"] = name;
    if (variant.refused.empty()) {
      const Price price = price_of(variant.scene, options.seconds, options.threads);
      stop_if_interrupted();
      add_price(row, price);
      print_row(name, price);
    } else {
      row["refused"] = variant.refused;
      fmt::print("{:>88}  {}: {}\n", "not possible", name, variant.refused);
    }
    rows.push_back(row);
  }
  if (!options.output) return static_cast<int>(ExitCode::done);
  report["format"] = "drumlin-effect-prices-1";
  report["title"] = scene.title;
  report["reduced"] = scene.reduced;
  report["command"] = fmt::format("drumlin cost --effects {} --seconds {:g} --threads {}",
                                  options.scene.filename().string(), options.seconds, options.threads);
  report["simulated_seconds"] = options.seconds;
  report["threads"] = options.threads;
  report["variants"] = rows;
  report["provenance"] = to_json(provenance());
  fs::create_directories(*options.output);
  write_json(*options.output / "cost.json", report);
  draw_figures("effect_price_figures.py", {(*options.output / "cost.json").string(), "--output",
                                           (*options.output / "prices.png").string()});
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
