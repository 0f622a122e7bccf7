#include "particles/scene/validate_cell.hpp"

#include <fmt/format.h>

#include "particles/scene/region.hpp"

namespace drumlin::particles {
namespace {

using Faults = std::vector<SceneFault>;

void check_height(const Scene& scene, Faults& faults) {
  const auto [low, high] = *scene.periodic_z;
  const auto* grains = std::get_if<GeneratedGrains>(&scene.grains.source);
  const double least = grains ? 3 * grains->diameter_max_mm : 0;  // as in periodic_x
  if (!(high - low > least))
    faults.push_back(
        {"periodic_z.z_max_mm",
         fmt::format("is {}", high),
         least > 0 ? fmt::format("beyond z_min_mm by more than 3 of the largest grains, > {}", low + least)
                   : fmt::format("> z_min_mm = {}", low),
         {"periodic_z", "grains.generated.diameter_max_mm"}});
  if (!grains) return;
  const auto [bottom, top] = extent_mm(grains->region, 1);
  if (bottom < low || top > high)
    faults.push_back({"grains.generated.region",
                      fmt::format("reaches from z = {} to {} mm", bottom, top),
                      fmt::format("inside the cell, {} to {} mm", low, high),
                      {"periodic_z", "grains.generated.region"}});
}

/// What a cell without walls cannot have.
void check_company(const Scene& scene, Faults& faults) {
  const auto refuse = [&](const std::string& key, const std::string& what, const std::string& allowed) {
    faults.push_back({key, what, allowed, {"periodic_z", key}});
  };
  if (!scene.periodic_x)
    refuse("periodic_z", "appears without periodic_x", "together with periodic_x: a cell without walls");
  if (!scene.walls.empty())
    refuse("walls", "are in a cell that is periodic in x and z", "none, or a scene without periodic_z");
  if (scene.effects.gravity)
    refuse("effects.gravity", "accelerates all grains of a cell that is periodic in x and z for ever",
           "absent: nothing there holds the grains");
  for (std::size_t s = 0; s < scene.stages.size(); ++s)
    if (scene.stages[s].gravity)
      refuse(fmt::format("stages.{}.gravity", s),
             "accelerates all grains of a cell that is periodic in x and z for ever", "absent");
  if (!scene.outlets.empty())
    refuse("outlets", "are in a cell that is periodic in x and z", "none, or a scene without periodic_z");
  if (!scene.sources.empty())
    refuse("sources", "are in a cell that is periodic in x and z", "none, or a scene without periodic_z");
}

void check_axis(const std::optional<CellAxis>& axis, const std::string& key, Faults& faults) {
  if (axis && axis->pressure_n_m2.has_value() == axis->rate_per_s.has_value())
    faults.push_back(
        {key,
         axis->rate_per_s ? "has both pressure_n_m2 and rate_per_s" : "names nothing that moves it",
         "either pressure_n_m2 or rate_per_s",
         {key}});
}

}  // namespace

void check_cell(const Scene& scene, Faults& faults) {
  if (scene.periodic_z) {
    check_height(scene, faults);
    check_company(scene, faults);
  }
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const std::string key = fmt::format("stages.{}.cell", s);
    const auto& cell = scene.stages[s].cell;
    if (!cell) continue;
    if (!scene.periodic_z)
      faults.push_back({key,
                        "moves a cell that the scene does not have",
                        "in a scene with periodic_x and periodic_z",
                        {key, "periodic_z"}});
    check_axis(cell->xx, key + ".xx", faults);
    check_axis(cell->zz, key + ".zz", faults);
    if (!cell->xx && !cell->zz && !cell->shear_rate_per_s)
      faults.push_back({key, "names nothing that moves", "xx, zz or shear_rate_per_s", {key}});
  }
  if (!presses_cell(scene)) return;
  if (scene.solver.capture_unconverged > 0)
    faults.push_back({"solver.capture_unconverged",
                      "requires contact problems of a cell under pressure, which their files cannot hold",
                      "0, or rates in place of pressures",
                      {"solver.capture_unconverged"}});
}

}  // namespace drumlin::particles
