#include "particles/io/grains_of_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/placement.hpp"

namespace drumlin::particles {
namespace {

/// The last snapshot, or that of a time, to half a time step. Throws InputError that names the nearest.
std::pair<std::filesystem::path, Snapshot> requested_snapshot(const RunFolder& run,
                                                              const std::optional<double>& time_s) {
  const auto last = chosen_snapshot(run, "last");
  if (!time_s) return {last, checked_snapshot(run, last)};
  double nearest = 0, distance = std::numeric_limits<double>::infinity();
  for (const auto& file : run.snapshots) {
    Snapshot snapshot = checked_snapshot(run, file);
    const double time = snapshot.time * snapshot.scales.time_s;
    if (std::abs(time - *time_s) <= snapshot.time_step * snapshot.scales.time_s / 2)
      return {file, std::move(snapshot)};
    if (std::abs(time - *time_s) < distance) nearest = time, distance = std::abs(time - *time_s);
  }
  throw InputError(
      {InputProblem{"", 0, 0, "grains.from_run.time_s",
                    fmt::format("is {}, at which {} has no snapshot", *time_s, run.folder.string()),
                    fmt::format("time of a snapshot; the nearest one is {:.9g}", nearest)}});
}

/// Materials of the grains by their names; empty where laws ask for none.
std::vector<std::string> materials_of(const RunFolder& run, const Snapshot& snapshot) {
  if (!materials_matter(run.scene)) return {};
  const Bodies start = place_grains(run.scene, run.scales);
  const auto names = material_names(run.scene);
  std::vector<std::string> materials;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const auto id = snapshot.id.empty() ? static_cast<std::int64_t>(i) : snapshot.id[i];
    if (id >= static_cast<std::int64_t>(start.count()))
      throw InputError(run.folder.string() +
                       ": its snapshots do not tell the materials of grains that were poured or came back");
    const std::size_t number = start.material[static_cast<std::size_t>(id)];
    materials.push_back(number < names.size() ? names[number] : "");
  }
  return materials;
}

std::string list_of(const Snapshot& s, const std::vector<std::string>& materials) {
  const double mm = s.scales.length_m * 1e3, mm_s = s.scales.velocity_m_s() * 1e3;
  std::string text = "x_mm,z_mm,diameter_mm,v_x_mm_s,v_z_mm_s,spin_rad_s,density_kg_m3";
  text += materials.empty() ? "\n" : ",material\n";
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double disc = std::numbers::pi * s.radius[i] * s.radius[i];
    text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}", s.x[i] * mm, s.z[i] * mm,
                        2 * s.radius[i] * mm, s.v_x[i] * mm_s, s.v_z[i] * mm_s,
                        s.spin.empty() ? 0 : s.spin[i] / s.scales.time_s,
                        s.scales.density_kg_m3 * (s.mass.empty() ? 1 : s.mass[i] / disc));
    text += materials.empty() ? "\n" : "," + materials[i] + "\n";
  }
  return text;
}

}  // namespace

GrainsTakenOver grains_of_run(const GrainsOfRun& requested) {
  RunFolder run = read_run_folder(requested.run);
  const auto [file, snapshot] = requested_snapshot(run, requested.time_s);
  ListedGrains grains{run.folder / "grains.csv",
                      std::make_shared<const std::string>(list_of(snapshot, materials_of(run, snapshot)))};
  return {std::move(run), file, snapshot.time * snapshot.scales.time_s, std::move(grains)};
}

}  // namespace drumlin::particles
