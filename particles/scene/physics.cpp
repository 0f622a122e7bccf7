#include "particles/scene/physics.hpp"

namespace drumlin::particles {

Scene physics_of(Scene scene) {
  scene.title.clear();
  scene.seed = 1;
  scene.reduced = false;
  scene.solver = {};
  scene.output = {};
  for (Stage& stage : scene.stages) {
    stage.duration_s = 1;
    stage.turns.reset();
    stage.time_step_s = 1;
    stage.snapshots = 0;
  }
  return scene;
}

}  // namespace drumlin::particles
