#include "apps/commands/calibrate/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

fs::path maps_of(const fs::path& run) { return run / "measured" / "maps.h5"; }

/// Layers without a drum speak through their profiles: in maps their walls would count.
bool is_in_layers(const fs::path& run) {
  const fs::path profiles = run / "measured" / "profiles.csv";
  return fs::exists(profiles) &&
         !(number_or_nan(read_profiles(profiles).header, &RunHeader::drum_radius) > 0);
}

void require_same_frame(const FieldMap& map, const MeasuredRun& run) {
  for (const HeaderNumber number :
       {&RunHeader::theta_deg, &RunHeader::axis_depth, &RunHeader::drum_radius, &RunHeader::rotation}) {
    const auto ours = map.header.*number, theirs = run.profiles.header.*number;
    if (ours && theirs && *ours == *theirs) continue;
    throw InputError(
        {InputProblem{maps_of(run.folder).string(), 0, 0, key_of(number),
                      ours && theirs ? fmt::format("{}, in profiles.csv {}", *ours, *theirs) : "is missing",
                      "the frame of the profiles: measure both anew"}});
  }
}

coupling::RunEvidence evidence_of(const MeasuredRun& run, coupling::EvidenceSource source,
                                  const CalibrateOptions& options) {
  coupling::RunEvidence evidence{.name = run.name, .reduced = run.reduced};
  if (const Scalar* nu = run.scalars.find("nu_bulk")) evidence.nu = *nu;
  const double rotation = needed_number(run.profiles.header, &RunHeader::rotation, "profiles.csv");
  evidence.rotation_rpm = rotation / run.scales.time_s * 30 / std::numbers::pi;
  const coupling::InertialSelection range{options.I_min, options.I_max};
  if (source == coupling::EvidenceSource::profiles) {
    coupling::add_layers(evidence, run.profiles, range);
    return evidence;
  }
  const FieldMap map = read_field_map(checked_file(run.measured_files, "maps.h5"));
  require_same_frame(map, run);
  coupling::add_blocks(evidence, map, range);
  return evidence;
}

}  // namespace

coupling::EvidenceSource source_of(const CalibrateOptions& options) {
  const bool needs_maps = options.misalignment || options.memory || options.nonlocal;
  const auto requested = enumerator<coupling::EvidenceSource>(options.from);  // nothing: auto
  if (requested == coupling::EvidenceSource::profiles) {
    if (needs_maps)
      throw InputError("--misalignment, --memory and --nonlocal need tensors over the drum: --from maps");
    return coupling::EvidenceSource::profiles;
  }
  std::vector<fs::path> all = options.runs;
  all.insert(all.end(), options.validate.begin(), options.validate.end());
  const auto without =
      std::find_if(all.begin(), all.end(), [](const fs::path& run) { return !fs::exists(maps_of(run)); });
  if (!requested && !needs_maps && std::any_of(all.begin(), all.end(), is_in_layers))
    return coupling::EvidenceSource::profiles;
  if (without == all.end()) return coupling::EvidenceSource::maps;
  if (requested || needs_maps)
    throw InputError(maps_of(*without).string() +
                     ": is missing; drumlin measure RUN --parts maps makes it (or use --from profiles)");
  return coupling::EvidenceSource::profiles;
}

MeasuredEvidence evidence_of(const std::vector<fs::path>& runs, coupling::EvidenceSource source,
                             const CalibrateOptions& options) {
  MeasuredEvidence all;
  for (const fs::path& folder : runs) {
    all.runs.push_back(
        read_measured_run(folder, options.accept_unsteady ? Unsteady::accept : Unsteady::refuse));
    all.evidence.push_back(evidence_of(all.runs.back(), source, options));
  }
  return all;
}

void require_bulk_fraction(const MeasuredEvidence& runs) {
  for (std::size_t r = 0; r < runs.runs.size(); ++r)
    if (!std::isfinite(runs.evidence[r].nu.value))
      throw InputError((runs.runs[r].folder / "measured" / "measured.json").string() +
                       ": nu_bulk: was not measured, and the law needs the volume fraction of the bulk");
}

}  // namespace drumlin::apps
