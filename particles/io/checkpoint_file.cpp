#include "particles/io/checkpoint_file.hpp"

#include <limits>
#include <string_view>

#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_stages.hpp"
#include "particles/io/checkpoint_traffic.hpp"

namespace drumlin::particles {
namespace {

const std::string checkpoint_format = "drumlin-checkpoint-2";

/// Calls visit(name, field, words) for every single number: one list for writing and reading.
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
  visit("totals/contact_sweeps", t.contact_sweeps, {"1", "contacts times sweeps, summed"});
  visit("totals/residual_sum", t.residual_sum, {"1", "residual, summed over the steps"});
  visit("totals/residual_max", t.residual_max, {"1", "residual, largest"});
  visit("totals/penetration_sum", t.penetration_sum, {"d", "penetration, summed over the steps"});
  visit("totals/penetration_max", t.penetration_max, {"d", "penetration, largest"});
  visit("totals/sinking_sum", t.sinking_sum, {"d", "sinking, summed over the steps"});
  visit("totals/sinking_max", t.sinking_max, {"d", "sinking, largest"});
  visit("totals/overlap_sum", t.overlap_sum, {"d", "overlap, summed over the steps"});
  visit("totals/overlap_max", t.overlap_max, {"d", "overlap, largest"});
  auto& o = t.stage_overlaps;
  visit("totals/stage/stage", o.stage);
  visit("totals/stage/steps", o.steps);
  visit("totals/stage/overlap_sum", o.sum, {"d", "overlap, summed over the steps of the stage"});
  visit("totals/stage/overlap_max", o.max, {"d", "overlap, largest of the stage"});
  visit("totals/stage/step", o.step);
  visit("totals/stage/grain", o.grain);
  visit("totals/stage/other", o.other);
  visit("totals/stage/time_s", o.time_s, {"s", "time of the largest"});
  visit("totals/stage/x", o.x, {"d", "place of the largest, to the right"});
  visit("totals/stage/z", o.z, {"d", "place of the largest, upwards"});
  visit("totals/wall_seconds", t.wall_seconds, {"s", "wall time"});
  visit("totals/cpu_seconds", t.cpu_seconds, {"s", "processor time"});
  visit("totals/detection_seconds", t.detection_seconds, {"s", "wall time of detection"});
  visit("totals/setup_seconds", t.setup_seconds, {"s", "wall time of assembly"});
  visit("totals/solver_seconds", t.solver_seconds, {"s", "wall time of the solver"});
  visit("totals/projection_seconds", t.projection_seconds, {"s", "wall time of the projection"});
  visit("totals/output_seconds", t.output_seconds, {"s", "wall time of output"});
  auto& s = c.state;
  visit("state/step", s.step);
  visit("state/step_in_stage", s.step_in_stage);
  visit("state/time_at_stage_start", s.time_at_stage_start,
        {"sqrt(d/g)", "start of the stage", H5Range::from_0});
  visit("state/time_in_stage", s.time_in_stage,
        {"sqrt(d/g)", "since the start of the stage", H5Range::from_0});
  visit("state/snapshots", s.snapshots);
  visit("memory/time_step", s.memory.time_step, {"sqrt(d/g)", "of the remembered impulses", H5Range::from_0});
}

/// The accounts of the energy ledger that each scene has.
template <class L, class Visit>
void each_account_of_ledger(L& ledger, Visit visit) {
  visit("energy/kinetic", ledger.kinetic, {"rho0 g d^3", "kinetic energy"});
  visit("energy/potential", ledger.potential, {"rho0 g d^3", "potential energy"});
  visit("energy/kinetic_at_start", ledger.kinetic_at_start, {"rho0 g d^3", "kinetic energy at the start"});
  visit("energy/potential_at_start", ledger.potential_at_start,
        {"rho0 g d^3", "potential energy at the start"});
  visit("energy/walls", ledger.walls, {"rho0 g d^3", "work of the walls"});
  visit("energy/friction", ledger.friction, {"rho0 g d^3", "work of friction"});
  visit("energy/impacts", ledger.impacts, {"rho0 g d^3", "work of impacts"});
  visit("energy/time_integration", ledger.time_integration, {"rho0 g d^3", "work of the time integration"});
  visit("energy/projection", ledger.projection, {"rho0 g d^3", "work of the projection"});
  visit("energy/turnover", ledger.turnover, {"rho0 g d^3", "turnover"});
}

template <class C, class Visit>
void each_array_of_checkpoint(C& c, Visit visit) {
  auto& b = c.state.bodies;
  visit("bodies/x", b.x, {"d", "centre, to the right"});
  visit("bodies/z", b.z, {"d", "centre, upwards"});
  visit("bodies/v_x", b.v_x, {"sqrt(g d)", "velocity to the right"});
  visit("bodies/v_z", b.v_z, {"sqrt(g d)", "velocity upwards"});
  visit("bodies/spin", b.spin, {"sqrt(g/d)", "angular velocity, clockwise"});
  visit("bodies/radius", b.radius, {"d", "radius", H5Range::above_0});
  visit("bodies/inverse_mass", b.inverse_mass,
        {"1/(rho0 d^2)", "inverse of the mass per depth", H5Range::above_0});
  visit("memory/impulse", c.state.memory.impulse, {"rho0 d^2 sqrt(g d)", "of the last step"});
}

}  // namespace

std::string checkpoint_image(const Checkpoint& checkpoint) {
  H5Writer out;
  out.add_text("format", checkpoint_format);
  out.add_text("scene", checkpoint.scene);
  const auto number = [&out](const char* name, auto value, H5Words words = {}) {
    out.add_number(name, value, words);
  };
  each_number_of_checkpoint(checkpoint, number);
  each_array_of_checkpoint(checkpoint, [&out](const char* name, const auto& values, H5Words words) {
    out.add(name, values, words);
  });
  const SimulationState& state = checkpoint.state;
  out.add_number("state/stage", static_cast<std::int64_t>(state.stage));
  out.add("memory/i", state.memory.i);
  out.add("memory/j", state.memory.j);
  if (!state.bodies.material.empty())
    out.add("bodies/material",
            std::vector<std::int32_t>(state.bodies.material.begin(), state.bodies.material.end()));
  if (state.energy) {
    each_account_of_ledger(*state.energy, number);
    const auto add_work = [&out](const std::string& name, const std::optional<double>& work) {
      if (work) out.add_number("energy/" + name, *work, {"rho0 g d^3", "work of " + name});
    };
    each_account(state.energy->effects, add_work);
    add_work("cell", state.energy->cell);
  }
  std::vector<double> poses;
  for (const Pose& pose : state.pose_at_start) poses.insert(poses.end(), {pose.angle, pose.x, pose.z});
  out.add("walls/pose_at_start", poses, {"rad, d", "angle, x and z of each wall as the stage began"});
  std::vector<double> driven;
  for (const DrivenState& wall : state.driven) driven.insert(driven.end(), {wall.position, wall.velocity});
  if (!driven.empty())
    out.add("walls/driven", driven, {"d, sqrt(g d)", "position and velocity of each driven wall"});
  put_stage_changes(checkpoint, out);
  put_traffic(checkpoint, out);
  out.add_number("marks/count", static_cast<std::int64_t>(state.marks.size()));
  for (std::size_t m = 0; m < state.marks.size(); ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    out.add_number(name + "snapshot_step", state.marks[m].snapshot_step);
    out.add_number(name + "time", state.marks[m].time, {"sqrt(d/g)", "since the start"});
    out.add(name + "x", state.marks[m].x, {"d", "centres then, to the right"});
    out.add(name + "z", state.marks[m].z, {"d", "centres then, upwards"});
  }
  return out.image();
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  replace_file(file, checkpoint_image(checkpoint));
}

void keep_checkpoint(const std::filesystem::path& run, const std::string& image) {
  replace_file(run / checkpoint_name, image, run / previous_checkpoint_name);
}

void keep_checkpoint(const std::filesystem::path& run, const Checkpoint& checkpoint) {
  keep_checkpoint(run, checkpoint_image(checkpoint));
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const H5Reader in(file);
  in.require_format(checkpoint_format, ": start over, or go on with the version that wrote it");
  Checkpoint checkpoint;
  checkpoint.scene = in.text("scene");
  each_number_of_checkpoint(checkpoint, [&in](const char* name, auto& value, H5Words words = {}) {
    const bool is_newer = name == std::string_view("totals/unresolved_impacts") ||
                          std::string_view(name).starts_with("totals/stage/");
    if (is_newer && !in.has(name)) return;  // of an older version
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      // Totals of steps that missed their tolerance may hold any number.
      value = std::string_view(name).starts_with("totals/") ? in.number(name) : in.number(name, words.range);
    } else {
      value = in.integer(name, 0);  // counters
    }
  });
  each_array_of_checkpoint(checkpoint, [&in](const char* name, std::vector<double>& values, H5Words words) {
    values = in.doubles(name, words.range);
  });
  SimulationState& state = checkpoint.state;
  state.stage = static_cast<int>(in.integer("state/stage", 0, std::numeric_limits<int>::max()));
  state.memory.i = in.ints("memory/i");
  state.memory.j = in.ints("memory/j");
  if (!state.memory.i.empty()) in.number("memory/time_step", H5Range::above_0);
  if (in.has("bodies/material"))
    for (const std::int32_t number : in.ints("bodies/material", 0, std::numeric_limits<std::uint8_t>::max()))
      state.bodies.material.push_back(static_cast<std::uint8_t>(number));
  if (in.has("energy")) {
    auto& energy = state.energy.emplace();
    each_account_of_ledger(energy, [&in](const char* name, double& value, H5Words words) {
      value = in.number(name, words.range);
    });
    const auto read_work = [&in](const std::string& name, std::optional<double>& work) {
      if (in.has("energy/" + name)) work = in.number("energy/" + name, H5Range::finite);
    };
    each_account(energy.effects, read_work);
    read_work("cell", energy.cell);
  }
  const auto poses = rows_of(in, "walls/pose_at_start", 3);
  for (std::size_t p = 0; p < poses.size(); p += 3)
    state.pose_at_start.push_back({poses[p], poses[p + 1], poses[p + 2]});
  if (in.has("walls/driven")) {
    const auto driven = rows_of(in, "walls/driven", 2);
    for (std::size_t d = 0; d < driven.size(); d += 2) state.driven.push_back({driven[d], driven[d + 1]});
  }
  get_stage_changes(in, checkpoint);
  get_traffic(in, checkpoint);
  const auto marks = in.integer("marks/count", 0);
  for (std::int64_t m = 0; m < marks; ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    state.marks.push_back({in.integer(name + "snapshot_step", 0), in.number(name + "time", H5Range::from_0),
                           in.doubles(name + "x", H5Range::finite), in.doubles(name + "z", H5Range::finite)});
  }
  return checkpoint;
}

}  // namespace drumlin::particles
