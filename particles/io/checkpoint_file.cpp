#include "particles/io/checkpoint_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "coupling/common/files/last_whole.hpp"
#include "coupling/common/files/text_file.hpp"
#include "coupling/hdf5/h5_reader.hpp"
#include "coupling/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_contents.hpp"
#include "particles/io/checkpoint_stages.hpp"
#include "particles/io/checkpoint_traffic.hpp"

namespace drumlin::particles {
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  H5Writer out;
  add_checkpoint(checkpoint, out);
  out.save(file);
}

std::string checkpoint_image(const Checkpoint& checkpoint) {
  H5Writer out;
  add_checkpoint(checkpoint, out);
  return out.image();
}

void keep_checkpoint(const std::filesystem::path& run, const std::string& image) {
  replace_file(run / checkpoint_name, image, run / previous_checkpoint_name);
}

void keep_checkpoint(const std::filesystem::path& run, const Checkpoint& checkpoint) {
  keep_checkpoint(run, checkpoint_image(checkpoint));
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const H5Reader in(file);
  if (!in.has("format")) in.refuse("format", "missing: no checkpoint");
  if (const std::string found = in.text("format"); found != checkpoint_format)
    in.refuse("format", "'" + found + "', this version reads " + checkpoint_format +
                            ": start over, or go on with the version that wrote it");
  Checkpoint checkpoint;
  checkpoint.scene = in.text("scene");
  each_number_of_checkpoint(checkpoint, [&in](const char* name, auto& value) {
    if (std::string_view(name) == "totals/unresolved_impacts" && !in.has(name))
      return;  // of an older version
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      value = in.number(name);
      // Totals of steps that missed their tolerance may hold others.
      if (!std::isfinite(value) && !std::string_view(name).starts_with("totals/"))
        in.refuse(name, fmt::format("is {}", value), "a finite number");
    } else {
      value = in.integer(name, 0);  // counters
    }
  });
  each_array_of_checkpoint(
      checkpoint, [&in](const char* name, std::vector<double>& values) { values = in.doubles(name); });
  SimulationState& state = checkpoint.state;
  state.stage = static_cast<int>(in.integer("state/stage", 0, std::numeric_limits<int>::max()));
  state.memory.i = in.ints("memory/i");
  state.memory.j = in.ints("memory/j");
  if (in.has("bodies/material"))
    for (const std::int32_t number : in.ints("bodies/material", 0, std::numeric_limits<std::uint8_t>::max()))
      state.bodies.material.push_back(static_cast<std::uint8_t>(number));
  if (in.has("energy")) {
    auto& energy = state.energy.emplace();
    each_account_of_ledger(energy, [&in](const char* name, double& value) { value = in.number(name); });
    each_account(energy.effects, [&in](const std::string& name, std::optional<double>& work) {
      if (in.has("energy/" + name)) work = in.number("energy/" + name);
    });
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
  const auto marks = in.integer("marks/count", 0);
  for (std::int64_t m = 0; m < marks; ++m) {
    const std::string name = "marks/" + std::to_string(m) + "/";
    state.marks.push_back({in.integer(name + "snapshot_step"), in.number(name + "time"),
                           in.doubles(name + "x"), in.doubles(name + "z")});
  }
  return checkpoint;
}

}  // namespace drumlin::particles
