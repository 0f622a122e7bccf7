#include "apps/commands/calibrate/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "coupling/exchange/errors.hpp"
#include "coupling/files/field_map_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

fs::path maps_of(const fs::path& run) { return run / "measured" / "maps.h5"; }

void require_same_frame(const FieldMap& map, const MeasuredRun& run) {
  for (const char* key : {"theta_deg", "axis_depth", "drum_radius", "rotation"}) {
    const auto ours = map.header.find(key), theirs = run.profiles.header.find(key);
    const bool both = ours != map.header.end() && theirs != run.profiles.header.end();
    if (both && ours->second == theirs->second) continue;
    throw InputError({InputProblem{maps_of(run.folder).string(), 0, 0, key,
                                   both ? ours->second + ", in profiles.csv " + theirs->second : "is missing",
                                   "the frame of the profiles: measure both anew"}});
  }
}

RunEvidence evidence_of(const fs::path& folder, Source source, const CalibrateOptions& options) {
  RunEvidence evidence;
  evidence.run = read_measured_run(folder, options.accept_unsteady ? Unsteady::accept : Unsteady::refuse);
  const double rotation = std::stod(evidence.run.profiles.header.at("rotation"));
  evidence.rotation_rpm = rotation / evidence.run.scales.time_s * 30 / std::numbers::pi;
  if (source == Source::maps) {
    evidence.map = read_field_map(maps_of(folder));
    require_same_frame(*evidence.map, evidence.run);
    BlockSelection selection;
    selection.I_min = options.I_min.value_or(selection.I_min);
    selection.I_max = options.I_max.value_or(selection.I_max);
    evidence.blocks = law_points(*evidence.map, selection);
    if (!options.relaxation) evidence.map.reset();
    return evidence;
  }
  LayerSelection selection;
  selection.I_min = options.I_min.value_or(selection.I_min);
  selection.I_max = options.I_max.value_or(selection.I_max);
  evidence.layers = friction_points(evidence.run.profiles, selection);
  evidence.ratios = friction_points(evidence.run.profiles, selection, "k");
  return evidence;
}

}  // namespace

Source source_of(const CalibrateOptions& options) {
  if (options.from == "profiles") {
    if (options.misalignment || options.relaxation)
      throw InputError("--misalignment and --relaxation need tensors over the drum: --from maps");
    return Source::profiles;
  }
  std::vector<fs::path> all = options.runs;
  all.insert(all.end(), options.validate.begin(), options.validate.end());
  const auto without =
      std::find_if(all.begin(), all.end(), [](const fs::path& run) { return !fs::exists(maps_of(run)); });
  if (without == all.end()) return Source::maps;
  if (options.from == "maps" || options.misalignment || options.relaxation)
    throw InputError(maps_of(*without).string() +
                     ": is missing; drumlin measure RUN --parts maps makes it (or use --from profiles)");
  return Source::profiles;
}

std::vector<RunEvidence> evidence_of(const std::vector<fs::path>& runs, Source source,
                                     const CalibrateOptions& options) {
  std::vector<RunEvidence> all;
  for (const fs::path& run : runs) all.push_back(evidence_of(run, source, options));
  return all;
}

}  // namespace drumlin::apps
