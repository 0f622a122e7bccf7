#include "particles/distributed/runs_on_ranks.hpp"

#include "particles/scene/materials.hpp"

namespace drumlin::particles {

std::vector<InputProblem> not_on_ranks(const Scene& scene) {
  std::vector<InputProblem> problems;
  const auto refuse = [&](bool here, const std::string& key, const char* why) {
    if (here)
      problems.push_back({"", 0, 0, key, std::string("not on ranks: ") + why, "drumlin run, on one process"});
  };
  refuse(scene.periodic_x.has_value(), "periodic_x", "deal.II 9.4 knows no ghosts across periodic sides");
  refuse(scene.periodic_z.has_value(), "periodic_z", "deal.II 9.4 knows no ghosts across periodic sides");
  each_effect(
      [&]<class E>(const std::optional<E>& effect) {
        if constexpr (requires { E::not_on_ranks; })
          refuse(effect.has_value(), std::string("effects.") + E::name, E::not_on_ranks);
      },
      scene.effects);
  refuse(materials_matter(scene), "grains.materials", "materials do not travel with the grains yet");
  refuse(moves_walls_by_force(scene), "stages.motions",
         "a wall moved by a force is one body of contacts on all ranks");
  refuse(ends_stages_early(scene), "stages.until", "they do not look for what ends a stage");
  refuse(changes_gravity(scene), "stages.gravity", "their steps know one gravity");
  refuse(any_stage(scene, changes_coefficients), "stages.friction, stages.restitution",
         "their steps know one value of each coefficient");
  refuse(changes_grains(scene), "outlets, sources", "the number of grains is fixed there");
  refuse(scene.output.energy_ledger, "output.energy_ledger", "no ledger is kept there");
  refuse(scene.output.walls_every_s.has_value(), "output.walls_every_s",
         "loads on walls are not added up there");
  refuse(scene.solver.capture_unconverged > 0, "solver.capture_unconverged",
         "problems are not gathered there");
  const auto& name = scene.solver.name;
  refuse(name != "accelerated" && name != "accelerated-double" && name != "nlgs", "solver.name",
         "they solve by accelerated, accelerated-double or nlgs");
  return problems;
}

}  // namespace drumlin::particles
