// drumlin cost --effects: the price list of a scene. The scene as it is, each of its effects removed, each
// absent one added, one after the other; what each takes in time, memory and unknowns, and what it changes.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/sweep.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "particles/accuracy/effect_price.hpp"
#include "particles/scene/effect_variants.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

std::string name_of(const particles::EffectVariant& variant) {
  if (variant.change == particles::EffectChange::none) return "as it is";
  return (variant.change == particles::EffectChange::removed ? "without " : "with ") + variant.effect +
         (variant.with_it.empty() ? "" : ": " + variant.with_it);
}

nlohmann::ordered_json to_json(const particles::EffectVariant& variant) {
  static const char* const words[] = {"none", "removed", "added"};
  nlohmann::ordered_json row;
  row["effect"] = variant.effect;
  row["change"] = words[static_cast<int>(variant.change)];
  row["with_it"] = variant.with_it;
  return row;
}

void add_price(nlohmann::ordered_json& row, const particles::EffectPrice& p) {
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
  row["slope_deg"] = number_or_null(p.slope_deg);
  row["overlap_d"] = p.overlap_d;
}

void print_row(const std::string& name, const particles::EffectPrice& p) {
  print_out(fmt::format(
      "{:7.2f} s {:7.2f} MB {:8.0f} {:6.1f} {:5.1f} % {:10.3g} {:8.2f} {:>7} {:9.2g}  {}\n", p.cpu_seconds,
      p.bytes / (1 << 20), p.unknowns(), p.sweeps, 100 * p.missed, p.kinetic_energy_J_kg, p.center_z_mm,
      std::isnan(p.slope_deg) ? "-" : fmt::format("{:.2f}", p.slope_deg), p.overlap_d, name));
  flush_out();
}

}  // namespace

int price_particle_effects(const CostOptions& options) {
  const particles::Scene scene = particles::read_scene(options.scene, options.overrides);
  (void)particles::Simulation(scene);
  std::optional<StagedOutput> output;
  if (options.output)
    output.emplace(OutputRequest{*options.output, options.existing, "cost", {options.scene}});
  const CaughtInterruptions caught;
  nlohmann::ordered_json report, rows = nlohmann::ordered_json::array();
  print_out(fmt::format(
      "{}: the first {:g} s; results are means over the second half\n{}{}\n", options.scene.string(),
      options.seconds, scene.reduced ? "reduced\n" : "",
      "     time     memory unknowns sweeps  missed energy J/kg centre z   slope   overlap  scene\n"
      "                                                             mm     deg         d"));
  auto variants = particles::effect_variants(scene);
  // Once more at the end: what differs between the two is noise of the machine.
  variants.push_back(variants.front());
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const particles::EffectVariant& variant = variants[v];
    const std::string name =
        v > 0 && variant.change == particles::EffectChange::none ? "as it is, again" : name_of(variant);
    auto row = to_json(variant);
    row["name"] = name;
    if (variant.refused.empty()) {
      const particles::EffectPrice price =
          particles::price_of(variant.scene, options.seconds, options.threads, stop_if_interrupted);
      add_price(row, price);
      print_row(name, price);
    } else {
      row["refused"] = variant.refused;
      print_out(fmt::format("{:>88}  {}: {}\n", "not possible", name, variant.refused));
    }
    rows.push_back(row);
  }
  if (!output) return static_cast<int>(ExitCode::done);
  report["format"] = "drumlin-effect-prices-1";
  report["title"] = scene.title;
  report["reduced"] = scene.reduced;
  report["command"] = fmt::format("drumlin cost --effects {} --seconds {:g} --threads {}",
                                  options.scene.filename().string(), options.seconds, options.threads);
  report["simulated_seconds"] = options.seconds;
  report["threads"] = options.threads;
  report["variants"] = rows;
  report["provenance"] = to_json(provenance());
  const fs::path file = output->folder() / "cost.json";
  write_json(file, report);
  draw_figures("effect_price_figures.py",
               {file.string(), "--output", (output->folder() / "prices.png").string()});
  output->publish();
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
