#pragma once
// Folders of measured runs and of flows as the commands leave them.
#include <nlohmann/json.hpp>

#include "coupling/common/text_file.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/flow_runs.hpp"

namespace drumlin::testing {

inline nlohmann::ordered_json measured_json(const coupling::StudyRun& run) {
  nlohmann::ordered_json json{{"format", "drumlin-measured-1"},
                              {"reduced", run.profiles.header.reduced.value()}};
  for (const Scalar& scalar : run.scalars.scalars)
    json[scalar.name] = {{"value", scalar.value}, {"ci99", *scalar.ci99}};
  json["fits"] = {{"decay_log_rate", 0.5}};
  json["settings"] = {{"linear_share", 0.3},
                      {"decay_window_below_H", {2, 8}},
                      {"rotation", run.profiles.header.rotation.value()},
                      {"scales", {{"length_m", 0.0033}, {"time_s", 0.01834098}, {"density_kg_m3", 2700}}}};
  json["steadiness"] = {{"steady", true}, {"reasons", nlohmann::ordered_json::array()}};
  return json;
}

/// A run folder as `drumlin run` and `drumlin measure` leave it, without its snapshots.
inline std::filesystem::path run_folder(const TemporaryFolder& folder, const coupling::StudyRun& run,
                                        const nlohmann::ordered_json& measured) {
  const std::filesystem::path path = folder / ("rpm-" + std::to_string(std::lround(run.rotation_rpm)));
  std::filesystem::create_directories(path / "measured");
  replace_file(path / "run.json", R"({"format": "drumlin-run-1", "status": "finished"})");
  replace_file(path / "measured" / "measured.json", measured.dump());
  write_profiles(path / "measured" / "profiles.csv", run.profiles);
  return path;
}

inline std::filesystem::path run_folder(const TemporaryFolder& folder, double rpm) {
  const coupling::StudyRun run = drum_run(rpm);
  return run_folder(folder, run, measured_json(run));
}

/// A flow folder as `drumlin flow` leaves it, without its maps and figures.
inline std::filesystem::path flow_folder(const TemporaryFolder& folder, const coupling::StudyFlow& flow,
                                         const std::string& effects = "") {
  const std::filesystem::path path = folder / flow.name;
  std::filesystem::create_directories(path);
  nlohmann::ordered_json json{{"format", "drumlin-flow-run-2"},
                              {"reduced", flow.side.profiles.header.reduced.value()},
                              {"geometry", "drum"},
                              {"cpu_seconds", flow.cpu_seconds},
                              {"start", flow.start}};
  for (const Scalar& scalar : flow.side.scalars.scalars) json[scalar.name] = scalar.value;
  json["settings"] = {{"law", {{"law", "log"}, {"a", 0.35}, {"b", 0.013}, {"fitted_on", flow.fitted_on}}},
                      {"rotation", flow.side.profiles.header.rotation.value()},
                      {"scales", {{"length_m", 0.0033}, {"time_s", 0.01834098}, {"density_kg_m3", 2700}}}};
  replace_file(path / "flow.json", json.dump());
  replace_file(path / "flow_scene.toml", "[effects]\n" + effects);
  write_profiles(path / "profiles.csv", flow.side.profiles);
  return path;
}

}  // namespace drumlin::testing
