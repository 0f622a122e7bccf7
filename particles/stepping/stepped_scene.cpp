#include "particles/stepping/stepped_scene.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"

namespace drumlin::particles {

StepReport SteppedScene::step() {
  if (!fault_.empty()) throw NotConvergedError(fault_);
  if (simulation_->finished()) throw InputError("the scene is finished: there is no further step");
  try {
    return checked_step(*simulation_);
  } catch (const std::exception& error) {
    fault_ = error.what();
    throw;
  }
}

void SteppedScene::change_stage(const std::function<void(Stage&)>& change, const std::string& moved) {
  Scene scene = scene_;
  Stage& stage = scene.stages[simulation_->next_stage()];
  if (stage.turns) stage.duration_s = duration_s(stage), stage.turns.reset();
  change(stage);
  scene = parse_scene(scene_text(scene), "scene");
  simulation_->change_stage(scene.stages[simulation_->next_stage()], moved);
  scene_ = std::move(scene);
}

void SteppedScene::set_friction(double grain_grain, double grain_wall) {
  change_stage([&](Stage& stage) { stage.effects.friction = {grain_grain, grain_wall}; });
}

void SteppedScene::set_gravity(double x, double z) {
  change_stage([&](Stage& stage) {
    const Scales& scales = simulation_->scales();
    const double down = x == 0 && z < 0 ? -90 : std::atan2(z, x) * 180 / std::numbers::pi;
    stage.gravity = {std::hypot(x, z) * scales.length_m / (scales.time_s * scales.time_s), down};
  });
}

void SteppedScene::set_wall(const std::string& wall, std::array<double, 2> velocity, double spin,
                            std::array<double, 2> center) {
  const auto change = [&](Stage& stage) {
    const Scales& scales = simulation_->scales();
    const auto& state = simulation_->state();
    const double since = simulation_->next_stage() == state.stage ? state.time_in_stage : 0;
    const double mm = 1e3 * scales.length_m, mm_s = 1e3 * scales.velocity_m_s();
    std::erase_if(stage.motions, [&](const auto& motion) { return motion.wall == wall; });
    for (int k : {0, 1}) center[k] = (center[k] - velocity[k] * since) * mm, velocity[k] *= mm_s;
    if (spin != 0)
      stage.motions.push_back({wall, Rotation{spin * 30 / std::numbers::pi / scales.time_s, center}});
    stage.motions.push_back({wall, Translation{velocity}});
  };
  change_stage(change, wall);
}

void SteppedScene::set_shear_rate(double rate) {
  change_stage([&](Stage& stage) {
    if (!stage.cell) throw InputError("shear rate: the stage has no cell that is periodic in x and z");
    stage.cell->shear_rate_per_s = rate / simulation_->scales().time_s;
  });
}

}  // namespace drumlin::particles
