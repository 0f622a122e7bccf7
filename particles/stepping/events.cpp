#include "particles/stepping/events.hpp"

#include <algorithm>

#include "particles/scene/materials.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/stepping/exchange.hpp"

namespace drumlin::particles {
namespace {

void open_walls(const Stage& own, const EventInput& at) {
  Walls& walls = at.setting.walls;
  walls.open.resize(walls.names.size());
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    if (std::find(own.opens->begin(), own.opens->end(), walls.names[w]) != own.opens->end())
      walls.open[w] = true;
}

void begin_motions(const Stage& own, const EventInput& at) {
  SimulationState& state = at.state;
  state.driven = begin_stage(at.setting.walls, own, at.scales, state.time_in_stage, state.driven);
}

/// Those of the scene where the stage has none of its own.
void change_coefficients(const Stage& own, const EventInput& at) {
  const auto materials = material_names(at.scene);
  each_effect(
      [&]<class E>(const std::optional<E>& effect, const auto& values, auto& law) {
        if constexpr (HasPairs<E>) {
          if (!effect) return;
          E keys = *effect;
          if (values) static_cast<StageValues<E>&>(keys) = *values, keys.pairs.clear();
          law = law_of(keys, {at.scales, materials});
        }
      },
      at.scene.effects, own.effects, at.setting.laws);
}

/// That of the middle of the step: what a ramp gives in a step is exact.
void change_gravity(const Stage&, const EventInput& at) {
  at.setting.laws.gravity =
      law_of(gravity_at(at, at.state.time_in_stage + at.time_step / 2), {at.scales, {}});
}

void move_cell_otherwise(const Stage& own, const EventInput& at) {
  at.setting.cell = cell_law(own.cell, at.scales);
}

void exchange(const Stage&, const EventInput& at) { exchange_grains(at); }

}  // namespace

std::vector<Event> events_of(const Scene& scene) {
  const auto stages = static_cast<int>(scene.stages.size());
  const bool own_values = any_stage(scene, changes_coefficients), own_gravity = changes_gravity(scene);
  std::vector<Event> events;
  if (changes_grains(scene)) events.push_back({0, stages, true, exchange});
  for (int k = 0; k < stages; ++k) {
    const Stage& stage = scene.stages[k];
    if (stage.opens) events.push_back({k, stages, false, open_walls});
    events.push_back({k, k + 1, false, begin_motions});
    if (own_values) events.push_back({k, k + 1, false, change_coefficients});
    if (own_gravity) events.push_back({k, k + 1, stage.gravity && stage.gravity->ramp, change_gravity});
    if (moves_cell(scene)) events.push_back({k, k + 1, false, move_cell_otherwise});
  }
  return events;
}

Gravity gravity_at(const EventInput& at, double time_in_stage) {
  const Stage& stage = at.scene.stages[at.state.stage];
  return gravity_in_stage(stage.gravity, *at.state.gravity,
                          time_in_stage * at.scales.time_s / duration_s(stage));
}

}  // namespace drumlin::particles
