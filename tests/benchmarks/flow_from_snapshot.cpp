#include "tests/benchmarks/flow_from_snapshot.hpp"

#include "coupling/core/basics/errors.hpp"

namespace drumlin::benchmark {

using namespace particles;

Scene last_stage_of(Scene scene) {
  scene.stages = {scene.stages.back()};
  scene.stages[0].snapshots = 0;
  return scene;
}

SimulationState state_at(const Scene& scene, const Snapshot& from) {
  SimulationState state = Simulation(scene).state();
  Bodies& bodies = state.bodies;
  if (bodies.count() != from.x.size() || bodies.spin.size() != from.spin.size())
    throw InputError("the snapshot is not of this scene");
  bodies.x = from.x, bodies.z = from.z, bodies.v_x = from.v_x, bodies.v_z = from.v_z;
  bodies.spin = from.spin, bodies.radius = from.radius;
  for (std::size_t i = 0; i < bodies.count(); ++i) bodies.inverse_mass[i] = 1 / mass_of_disc(from.radius[i]);
  return state;
}

}  // namespace drumlin::benchmark
