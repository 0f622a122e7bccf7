#include "apps/commands/compare_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "coupling/comparison/layers.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/results/run_checks.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/io/snapshot_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Maps are optional (the profiles that the repository keeps have none), but must be of the same frame.
std::optional<FieldMap> maps_in(const fs::path& file, const ProfileSet& profiles) {
  if (!fs::exists(file)) return std::nullopt;
  FieldMap map = read_field_map(file);
  std::vector<InputProblem> problems;
  for (const HeaderNumber number : {&RunHeader::theta_deg, &RunHeader::rotation, &RunHeader::drum_radius,
                                    &RunHeader::diameter_m, &RunHeader::axis_depth})
    require_number_near(file, map.header, number, number_or_nan(profiles.header, number), "profiles.csv",
                        problems);
  if (map.header.side != profiles.header.side)
    problems.push_back({file.string(), 0, 0, "side",
                        map.header.side ? std::string("is ") + name_of(*map.header.side) : "is missing",
                        name_of(profiles.header.side.value())});
  if (!problems.empty()) throw InputError(problems);
  return map;
}

/// The last snapshots, so many that a page shows a good part of a turn and stays small.
std::vector<fs::path> moving_snapshots(const std::vector<fs::path>& all) {
  constexpr std::size_t most = 120, fine = 200;  // frames; of one run, beyond which some are left out
  const std::size_t stride = std::max<std::size_t>(1, all.size() / fine);
  std::vector<fs::path> chosen;
  for (std::size_t back = 0; back < all.size() && chosen.size() < most; back += stride)
    chosen.push_back(all[all.size() - 1 - back]);
  std::reverse(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

LoadedSide load_side(const fs::path& folder, Unsteady unsteady, MovingSnapshots moving) {
  LoadedSide side;
  side.folder = folder;
  if (fs::is_directory(folder) && is_flow_run(folder)) {
    FlowRun flow = read_flow_run(folder, FlowGeometry::any);
    side.kind = RunSide::continuum;
    side.name = flow.name;
    side.scales = flow.scales;
    side.maps_file = checked_file(flow.files, "maps.h5");
    side.accepted = std::move(flow.accepted);
    side.compared = {std::move(flow.profiles), std::move(flow.scalars), {}};
  } else {
    MeasuredRun run = read_measured_run(folder, unsteady);
    side.name = run.name;
    side.scales = run.scales;
    side.unsteady = run.unsteady;
    side.maps_file = checked_file(run.measured_files, "maps.h5");
    side.accepted = std::move(run.accepted);
    side.compared = {std::move(run.profiles), std::move(run.scalars), {std::move(run.slices), {}}};
    if (moving == MovingSnapshots::find && fs::is_directory(folder / "snapshots"))
      for (const fs::path& file : moving_snapshots(particles::snapshot_files(folder)))
        side.moving.push_back(checked_file(run.files, "snapshots/" + file.filename().string()));
    if (!side.moving.empty()) side.snapshot = side.moving.back();
  }
  // Layers are the same everywhere along x.
  if (coupling::geometry_of(side.compared.profiles) == Geometry::drum)
    side.compared.fields.maps = maps_in(side.maps_file, side.compared.profiles);
  if (!side.compared.fields.maps) side.maps_file.clear();
  return side;
}

void require_same_scales(const LoadedSide& first, const LoadedSide& second) {
  std::vector<InputProblem> problems;
  const auto compare = [&](const char* key, double Scales::*unit) {
    if (nearly_equal(second.scales.*unit, first.scales.*unit)) return;
    problems.push_back({"", 0, 0, key,
                        fmt::format("{:.6g} in {}, {:.6g} in {}", first.scales.*unit, first.folder.string(),
                                    second.scales.*unit, second.folder.string()),
                        "the same units on both sides"});
  };
  compare("scales.length_m", &Scales::length_m);
  compare("scales.time_s", &Scales::time_s);
  compare("scales.density_kg_m3", &Scales::density_kg_m3);
  if (!problems.empty()) throw InputError(problems);
}

Json records_of(const LoadedSide& side) {
  const auto record = [&]<class T>(const char* name, T) {
    const fs::path file = side.folder / name;
    return fs::exists(file) ? read_json<T>(file) : Json();
  };
  if (side.kind == RunSide::continuum) return {{"flow", record("flow.json", FlowRecord())}};
  return {{"run", record("run.json", RunRecord())},
          {"measured", record("measured/measured.json", MeasuredRecord())}};
}

}  // namespace drumlin::apps
