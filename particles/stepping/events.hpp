#pragma once
// What happens to a scene between its steps, as one list: walls that open or move otherwise, coefficients,
// gravity, the rates of a cell, grains that outlets take and sources pour.
#include <vector>

#include "particles/effects/moving_cell.hpp"
#include "particles/stepping/simulation_state.hpp"
#include "particles/stepping/step_laws.hpp"

namespace drumlin::particles {

/// What steps depend on beside their state. Events make it from scene and state, after a restart too.
struct Setting {
  Walls walls;
  StepLaws laws;
  CellLaw cell = {};
};

/// Where an event acts, before a step of the state's stage.
struct EventInput {
  const Scene& scene;
  const Scales& scales;
  double time_step = 0;
  Setting& setting;
  SimulationState& state;
};

/// Its time is a stage: when that begins may be a result.
struct Event {
  int from = 0, end = 0;   ///< the stages for which it counts
  bool each_step = false;  ///< happens before each of their steps and may change grains; else as `from`
                           ///< begins, while times of the state are those of the stage before
  void (*apply)(const Stage& own, const EventInput&) = nullptr;  ///< `own`: the stage `from`
};

/// All of a scene, ascending in `from`.
std::vector<Event> events_of(const Scene&);

/// Gravity of the state's stage; only in a scene whose stages change it.
Gravity gravity_at(const EventInput&, double time_in_stage);

}  // namespace drumlin::particles
