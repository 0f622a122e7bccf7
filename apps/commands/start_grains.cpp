#include "apps/commands/start_grains.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "coupling/common/checksum.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/documents/json_document.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/placement.hpp"

namespace drumlin::apps {
namespace {

/// The last snapshot, or that of a time, to half a time step. Throws InputError that names the nearest.
std::pair<std::filesystem::path, particles::Snapshot> asked_snapshot(const particles::RunFolder& run,
                                                                     const std::optional<double>& time_s) {
  const auto last = particles::chosen_snapshot(run, "last");
  if (!time_s) return {last, particles::checked_snapshot(run, last)};
  double nearest = 0, distance = std::numeric_limits<double>::infinity();
  for (const auto& file : run.snapshots) {
    particles::Snapshot snapshot = particles::checked_snapshot(run, file);
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
std::vector<std::string> materials_of(const particles::RunFolder& run, const particles::Snapshot& snapshot) {
  if (!materials_matter(run.scene)) return {};
  const particles::Bodies start = place_grains(run.scene, run.scales);
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

std::string list_of(const particles::Snapshot& s, const std::vector<std::string>& materials) {
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

nlohmann::ordered_json take_over_grains(particles::Scene& scene) {
  const auto* asked = std::get_if<particles::GrainsOfRun>(&scene.grains.source);
  if (!asked) return nullptr;
  const particles::RunFolder run = particles::read_run_folder(asked->run);
  const auto [file, snapshot] = asked_snapshot(run, asked->time_s);
  const auto theirs = read_json(run.folder / "run.json", "drumlin-run-1");
  nlohmann::ordered_json chain = {{"run", run.folder.string()},
                                  {"title", run.scene.title},
                                  {"revision", theirs.value("revision", "")},
                                  {"snapshot", file.filename().string()},
                                  {"sum", file_sum(file).checksum},
                                  {"time_s", snapshot.time * snapshot.scales.time_s}};
  if (theirs.contains("started_from")) chain["started_from"] = theirs["started_from"];
  scene.grains.source =
      particles::ListedGrains{run.folder / "grains.csv", list_of(snapshot, materials_of(run, snapshot))};
  return chain;
}

}  // namespace drumlin::apps
