// drumlin compare: a particle run and a continuum run of one drum, side by side.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/comparison_json.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/report_page.hpp"
#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/paper_table.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "particles/io/snapshot_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The files of both runs. The particle run's own record is needed for its costs and provenance.
struct Inputs {
  ComparedSide particles, continuum;
  Json run, measured, flow;
  fs::path particle_profiles, continuum_profiles, snapshot, maps;
};

Inputs read_inputs(const CompareOptions& options) {
  Inputs inputs;
  const fs::path measured = options.run / "measured";
  for (const auto& folder : {options.run, options.flow_run})
    if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  if (!fs::exists(measured / "measured.json"))
    throw InputError(
        fmt::format("{}: has not been measured; run drumlin measure first", options.run.string()));
  inputs.particle_profiles = measured / "profiles.csv";
  inputs.continuum_profiles = options.flow_run / "profiles.csv";
  inputs.maps = options.flow_run / "maps.h5";
  const auto snapshots = snapshot_files(options.run);
  if (snapshots.empty()) throw InputError(options.run.string() + ": holds no snapshots");
  inputs.snapshot = snapshots.back();
  inputs.particles = {read_profiles(inputs.particle_profiles),
                      read_scalars(measured / "measured.json", "drumlin-measured-1")};
  inputs.continuum = {read_profiles(inputs.continuum_profiles),
                      read_scalars(options.flow_run / "flow.json", "drumlin-flow-run-1")};
  inputs.run = read_json(options.run / "run.json", "drumlin-run-1");
  inputs.measured = read_json(measured / "measured.json", "drumlin-measured-1");
  inputs.flow = read_json(options.flow_run / "flow.json", "drumlin-flow-run-1");
  return inputs;
}

Json entry(const Json& object, const std::string& key) { return object.value(key, Json()); }

Json header_of(const ProfileSet& profiles) {
  Json header;
  for (const auto& [key, value] : profiles.header) header[key] = value;
  return header;
}

Json content_of(const Inputs& inputs, const Comparison& comparison, const ZoneOptions& zones) {
  const bool reduced = inputs.particles.profiles.header.at("reduced") == "true";
  std::string title =
      entry(inputs.run, "title").is_string() ? inputs.run["title"].get<std::string>() : "Drum";
  Json content{{"format", "drumlin-comparison-1"},
               {"title", title + ": particles and continuum" + (reduced ? " (reduced)" : "")},
               {"reduced", reduced}};
  add_comparison(content, comparison);
  const auto speed = paper_speed_rpm(inputs.particles.profiles, paper_data_folder());
  add_paper(content, speed,
            speed ? paper_table(paper_numbers(paper_data_folder(), *speed), comparison.scalars)
                  : std::vector<PaperRow>());
  content["costs"] = {{"particle run, wall", entry(inputs.run, "wall_seconds")},
                      {"particle run, processor", entry(inputs.run, "cpu_seconds")},
                      {"measurement, wall", entry(inputs.measured, "seconds")},
                      {"continuum solve, wall", entry(inputs.flow, "seconds")}};
  content["settings"] = {{"surface_margin", zones.surface_margin}, {"wall_margin", zones.wall_margin}};
  content["particles"] = {{"profiles", header_of(inputs.particles.profiles)},
                          {"measurement", entry(inputs.measured, "settings")},
                          {"run", inputs.run}};
  content["continuum"] = {{"profiles", header_of(inputs.continuum.profiles)}, {"flow", inputs.flow}};
  content["provenance"] = to_json(provenance());
  return content;
}

/// Every quantity that both sides have, at the particles' layers: NAME_particles (with its interval) and
/// NAME_continuum.
ProfileSet overlaid(const Inputs& inputs) {
  ProfileSet set;
  set.z = inputs.particles.profiles.z;
  set.header = {{"reduced", inputs.particles.profiles.header.at("reduced")}};
  for (const auto& column : inputs.particles.profiles.columns) {
    if (inputs.continuum.profiles.find(column.name) == nullptr) continue;
    FieldOverlay field = overlay(column.name, inputs.particles.profiles, inputs.continuum.profiles);
    set.columns.push_back({column.name + "_particles", std::move(field.particles), column.ci99});
    set.columns.push_back({column.name + "_continuum", std::move(field.continuum), {}});
  }
  return set;
}

std::vector<ReportFigure> drawn_figures(const Inputs& inputs, const fs::path& output, const Json& content) {
  const Json H = content["scalars"]["H"]["particles"]["value"];
  draw_figures(
      "compare_figures.py",
      {"--particles", inputs.particle_profiles.string(), "--continuum", inputs.continuum_profiles.string(),
       "--snapshot", inputs.snapshot.string(), "--maps", inputs.maps.string(), "--output", output.string(),
       "--depth", H.is_number() ? fmt::format("{}", H.get<double>()) : "nan"});
  return {{output / "drums.png",
           "Speed in the frame of the drum, on one colour scale: grains of the last snapshot, and the "
           "continuum."},
          {output / "velocity.png",
           "Velocity along the surface, linear and logarithmic, with the particles' 99 % band."},
          {output / "shear_rate.png", "Shear rate. Where the band reaches zero its sign is not known."},
          {output / "stresses.png", "Stresses, compression positive."},
          {output / "ratios.png", "Inertial number and the two stress ratios over depth."},
          {output / "friction.png", "Stress ratio over inertial number, layer by layer."}};
}

std::string short_number(const Json& value) {
  return value.is_number() ? fmt::format("{:.3g}", value.get<double>()) : value.dump();
}

std::string summary_of(const Json& content) {
  const Json& counts = content["verdict"];
  std::string text =
      fmt::format("{}\ntargets: {} met, {} missed, {} not measured\n", content["title"].get<std::string>(),
                  counts["met"].get<int>(), counts["missed"].get<int>(), counts["not_measured"].get<int>());
  for (const auto& target : content["targets"])
    if (target["outcome"] == "missed")
      text += fmt::format("  missed: {} {}: {} (limit {} {}) {}\n", target["quantity"].get<std::string>(),
                          target.value("zone", std::string()), short_number(target["value"]),
                          short_number(target["limit"]), target["measure"].get<std::string>(),
                          target.value("remark", std::string()));
  return text;
}

}  // namespace

int compare(const CompareOptions& options) {
  const fs::path finished = options.output / "comparison.json";
  if (options.existing == ExistingOutput::resume && fs::exists(finished)) {
    fmt::print("{}: done already\n", options.output.string());
    return static_cast<int>(ExitCode::done);
  }
  const Inputs inputs = read_inputs(options);
  const ZoneOptions zones;
  const Comparison comparison = compare(inputs.particles, inputs.continuum, zones);
  const Json content = content_of(inputs, comparison, zones);

  prepare_output(options.output, options.existing, {"comparison.json", "overlay.csv"},
                 {options.run, options.flow_run});
  write_profiles(options.output / "overlay.csv", overlaid(inputs));
  const auto figures = drawn_figures(inputs, options.output, content);
  replace_file(options.output / "index.html", report_page(content, figures));
  // Last: its presence says that the report is whole.
  write_json(finished, content);
  fmt::print("{}report: {}\n", summary_of(content), fs::absolute(options.output / "index.html").string());
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
