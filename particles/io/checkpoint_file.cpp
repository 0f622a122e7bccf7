#include "particles/io/checkpoint_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "coupling/common/last_whole.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/files/h5_image.hpp"
#include "particles/io/checkpoint_stages.hpp"
#include "particles/io/checkpoint_traffic.hpp"

namespace drumlin::particles {
namespace {

const std::string format = "drumlin-checkpoint-2";

/// Calls visit(name, field) for every single number: one list for writing and reading.
template <class C, class Visit>
void each_number(C& c, Visit visit) {
  visit("log_bytes", c.log_bytes);
  visit("energy_bytes", c.energy_bytes);
  auto& t = c.totals;
  visit("totals/unconverged_steps", t.unconverged_steps);
  visit("totals/first_unconverged_step", t.first_unconverged_step);
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

/// The energy ledger; rolling and cohesion only where the scene has them.
template <class L, class Visit>
void each_account(L& ledger, Visit visit) {
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
void each_array(C& c, Visit visit) {
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

void put(const Checkpoint& checkpoint, H5Writer& out) {
  out.add_text("format", format);
  out.add_text("scene", checkpoint.scene);
  each_number(checkpoint, [&out](const char* name, auto value) { out.add_number(name, value); });
  each_array(checkpoint, [&out](const char* name, const std::vector<double>& values) {
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
    each_account(*state.energy, [&out](const char* name, double value) { out.add_number(name, value); });
    if (state.energy->rolling) out.add_number("energy/rolling", *state.energy->rolling);
    if (state.energy->cohesion) out.add_number("energy/cohesion", *state.energy->cohesion);
    if (state.energy->cell) out.add_number("energy/cell", *state.energy->cell);
  }
  std::vector<double> poses;
  for (const Pose& pose : state.pose_at_start) poses.insert(poses.end(), {pose.angle, pose.x, pose.z});
  out.add("walls/pose_at_start", std::span<const double>(poses));
  std::vector<double> driven;
  for (const DrivenState& wall : state.driven) driven.insert(driven.end(), {wall.position, wall.velocity});
  if (!driven.empty()) out.add("walls/driven", std::span<const double>(driven));
  put_stage_changes(checkpoint, out);
  put_traffic(checkpoint, out);
  out.add_number("marks/count", static_cast<std::int64_t>(state.marks.size()));
  for (std::size_t m = 0; m < state.marks.size(); ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    out.add_number(name + "snapshot_step", state.marks[m].snapshot_step);
    out.add_number(name + "time", state.marks[m].time);
    out.add(name + "x", std::span<const double>(state.marks[m].x));
    out.add(name + "z", std::span<const double>(state.marks[m].z));
  }
}

constexpr auto most = std::numeric_limits<std::int64_t>::max();

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  H5Writer out;
  put(checkpoint, out);
  out.save(file);
}

std::string checkpoint_image(const Checkpoint& checkpoint) {
  H5Writer out;
  put(checkpoint, out);
  return out.image();
}

void keep_checkpoint(const std::filesystem::path& run, const std::string& image) {
  replace_file_keeping(run / checkpoint_name, run / previous_checkpoint_name, image);
}

void keep_checkpoint(const std::filesystem::path& run, const Checkpoint& checkpoint) {
  keep_checkpoint(run, checkpoint_image(checkpoint));
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const H5Reader in(file);
  if (!in.has("format")) in.refuse("format", "missing: no checkpoint");
  if (const std::string found = in.text("format"); found != format)
    in.refuse("format", "'" + found + "', this version reads " + format +
                            ": start over, or go on with the version that wrote it");
  Checkpoint checkpoint;
  checkpoint.scene = in.text("scene");
  each_number(checkpoint, [&in](const char* name, auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      value = in.number(name);
      // Totals of steps that missed their tolerance may hold others.
      if (!std::isfinite(value) && !std::string_view(name).starts_with("totals/"))
        in.refuse(name, fmt::format("is {}", value), "a finite number");
    } else {
      value = in.integer(name, 0, most);  // counters
    }
  });
  each_array(checkpoint, [&in](const char* name, std::vector<double>& values) { values = in.doubles(name); });
  SimulationState& state = checkpoint.state;
  state.stage = static_cast<int>(in.integer("state/stage", 0, std::numeric_limits<int>::max()));
  state.memory.i = in.ints("memory/i");
  state.memory.j = in.ints("memory/j");
  if (in.has("bodies/material"))
    for (const std::int32_t number : in.ints("bodies/material", 0, std::numeric_limits<std::uint8_t>::max()))
      state.bodies.material.push_back(static_cast<std::uint8_t>(number));
  if (in.has("energy")) {
    auto& energy = state.energy.emplace();
    each_account(energy, [&in](const char* name, double& value) { value = in.number(name); });
    if (in.has("energy/rolling")) energy.rolling = in.number("energy/rolling");
    if (in.has("energy/cohesion")) energy.cohesion = in.number("energy/cohesion");
    if (in.has("energy/cell")) energy.cell = in.number("energy/cell");
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
  const auto marks = in.integer("marks/count", 0, most);
  for (std::int64_t m = 0; m < marks; ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    state.marks.push_back({in.integer(name + "snapshot_step"), in.number(name + "time"),
                           in.doubles(name + "x"), in.doubles(name + "z")});
  }
  return checkpoint;
}

}  // namespace drumlin::particles
