#pragma once
// The state of a simulation between two steps.
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/stepping/energy_ledger.hpp"
#include "particles/stepping/exchange.hpp"
#include "particles/stepping/impulse_cache.hpp"
#include "particles/stepping/left_grains.hpp"
#include "particles/stepping/time_plan.hpp"
#include "particles/stepping/wall_loads.hpp"

namespace drumlin::particles {

/// Everything that the next step depends on: a run continued from it gives the same bytes.
struct SimulationState {
  std::int64_t step = 0;           ///< steps done
  int stage = 0;                   ///< of the next step
  std::int64_t step_in_stage = 0;  ///< steps done in it
  double time_at_stage_start = 0;
  double time_in_stage = 0;
  Bodies bodies;
  ImpulseCache memory;
  std::vector<Pose> pose_at_start;  ///< of each wall, when the current stage began
  std::vector<DrivenState> driven;  ///< of each wall that the current stage drives; position since its start
  std::int64_t snapshots = 0;       ///< taken so far

  /// Positions kept for the displacement over the velocity window of a snapshot to come.
  struct Mark {
    std::int64_t snapshot_step = 0;
    double time = 0;
    std::vector<double> x, z;
  };
  std::deque<Mark> marks;

  std::optional<EnergyLedger> energy;  ///< after the first step of a scene that asks for it

  // Of a scene that ends stages early.
  std::vector<StageEnd> ends;   ///< stages that are over
  std::int64_t rest_steps = 0;  ///< at rest in a row, up to the last one

  std::optional<Gravity> gravity;  ///< when the current stage began; of a scene whose stages change it
  std::optional<WallLoads> loads;  ///< of a scene that asks for walls.csv
  std::optional<Traffic> traffic;  ///< of a scene with outlets or sources
  std::optional<LeftGrains> left;  ///< once a grain has left
  std::optional<CellState> cell;   ///< of a scene whose cell moves

  double time() const { return time_at_stage_start + time_in_stage; }
};

}  // namespace drumlin::particles
