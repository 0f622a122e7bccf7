#pragma once
// What a checkpoint file holds, item by item.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coupling/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/checkpoint_stages.hpp"
#include "particles/io/checkpoint_traffic.hpp"

namespace drumlin::particles {

inline const std::string checkpoint_format = "drumlin-checkpoint-2";

/// Calls visit(name, field) for every single number: one list for writing and reading.
template <class C, class Visit>
void each_number_of_checkpoint(C& c, Visit visit) {
  visit("log_bytes", c.log_bytes);
  visit("energy_bytes", c.energy_bytes);
  auto& t = c.totals;
  visit("totals/unconverged_steps", t.unconverged_steps);
  visit("totals/first_unconverged_step", t.first_unconverged_step);
  visit("totals/unresolved_impacts", t.unresolved_impacts);
  visit("totals/sweeps", t.sweeps);
  visit("totals/contacts", t.contacts);
  visit("totals/contact_sweeps", t.contact_sweeps);
  visit("totals/residual_sum", t.residual_sum);
  visit("totals/residual_max", t.residual_max);
  visit("totals/penetration_sum", t.penetration_sum);
  visit("totals/penetration_max", t.penetration_max);
  visit("totals/sinking_sum", t.sinking_sum);
  visit("totals/sinking_max", t.sinking_max);
  visit("totals/overlap_sum", t.overlap_sum);
  visit("totals/overlap_max", t.overlap_max);
  visit("totals/wall_seconds", t.wall_seconds);
  visit("totals/cpu_seconds", t.cpu_seconds);
  visit("totals/detection_seconds", t.detection_seconds);
  visit("totals/setup_seconds", t.setup_seconds);
  visit("totals/solver_seconds", t.solver_seconds);
  visit("totals/projection_seconds", t.projection_seconds);
  visit("totals/output_seconds", t.output_seconds);
  auto& s = c.state;
  visit("state/step", s.step);
  visit("state/step_in_stage", s.step_in_stage);
  visit("state/time_at_stage_start", s.time_at_stage_start);
  visit("state/time_in_stage", s.time_in_stage);
  visit("state/snapshots", s.snapshots);
  visit("memory/time_step", s.memory.time_step);
}

/// The accounts of the energy ledger that each scene has.
template <class L, class Visit>
void each_account_of_ledger(L& ledger, Visit visit) {
  visit("energy/kinetic", ledger.kinetic);
  visit("energy/potential", ledger.potential);
  visit("energy/kinetic_at_start", ledger.kinetic_at_start);
  visit("energy/potential_at_start", ledger.potential_at_start);
  visit("energy/walls", ledger.walls);
  visit("energy/friction", ledger.friction);
  visit("energy/impacts", ledger.impacts);
  visit("energy/time_integration", ledger.time_integration);
  visit("energy/projection", ledger.projection);
  visit("energy/turnover", ledger.turnover);
}

template <class C, class Visit>
void each_array_of_checkpoint(C& c, Visit visit) {
  auto& b = c.state.bodies;
  visit("bodies/x", b.x);
  visit("bodies/z", b.z);
  visit("bodies/v_x", b.v_x);
  visit("bodies/v_z", b.v_z);
  visit("bodies/spin", b.spin);
  visit("bodies/radius", b.radius);
  visit("bodies/inverse_mass", b.inverse_mass);
  visit("memory/impulse", c.state.memory.impulse);
}

/// Adds all of it to `out`, which has the members of H5Content or, besides, add_by_first(). What there is
/// once for each body or remembered contact has names that begin with "bodies/" or "memory/".
template <class Out>
void add_checkpoint(const Checkpoint& checkpoint, Out& out) {
  out.add_text("format", checkpoint_format);
  out.add_text("scene", checkpoint.scene);
  each_number_of_checkpoint(checkpoint,
                            [&out](const char* name, auto value) { out.add_number(name, value); });
  each_array_of_checkpoint(checkpoint, [&out](const char* name, const std::vector<double>& values) {
    out.add(name, std::span<const double>(values));
  });
  const SimulationState& state = checkpoint.state;
  out.add_number("state/stage", static_cast<std::int64_t>(state.stage));
  out.add("memory/i", std::span<const std::int32_t>(state.memory.i));
  out.add("memory/j", std::span<const std::int32_t>(state.memory.j));
  if (!state.bodies.material.empty())
    out.add("bodies/material", std::span<const std::int32_t>(std::vector<std::int32_t>(
                                   state.bodies.material.begin(), state.bodies.material.end())));
  if (state.energy) {
    each_account_of_ledger(*state.energy,
                           [&out](const char* name, double value) { out.add_number(name, value); });
    each_account(state.energy->effects, [&out](const std::string& name, const std::optional<double>& work) {
      if (work) out.add_number("energy/" + name, *work);
    });
    if (state.energy->cell) out.add_number("energy/cell", *state.energy->cell);
  }
  std::vector<double> poses;
  for (const Pose& pose : state.pose_at_start) poses.insert(poses.end(), {pose.angle, pose.x, pose.z});
  out.add("walls/pose_at_start", std::span<const double>(poses));
  std::vector<double> driven;
  for (const DrivenState& wall : state.driven) driven.insert(driven.end(), {wall.position, wall.velocity});
  if (!driven.empty()) out.add("walls/driven", std::span<const double>(driven));
  const auto add_rest = [&](H5Content& content) {
    put_stage_changes(checkpoint, content);
    put_traffic(checkpoint, content);
  };
  if constexpr (requires { out.add_by_first(add_rest); })
    out.add_by_first(add_rest);
  else
    add_rest(out);
  out.add_number("marks/count", static_cast<std::int64_t>(state.marks.size()));
  for (std::size_t m = 0; m < state.marks.size(); ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    out.add_number(name + "snapshot_step", state.marks[m].snapshot_step);
    out.add_number(name + "time", state.marks[m].time);
    out.add(name + "x", std::span<const double>(state.marks[m].x));
    out.add(name + "z", std::span<const double>(state.marks[m].z));
  }
}

}  // namespace drumlin::particles
