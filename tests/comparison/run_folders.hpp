#pragma once
// Folders as `drumlin measure` and `drumlin flow` leave them, with the profiles of example.hpp.
#include <nlohmann/json.hpp>

#include "coupling/core/files/text_file.hpp"
#include "tests/comparison/example.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::testing {

using Json = nlohmann::ordered_json;

inline Json example_scales() {
  return {{"length_m", 0.0033}, {"time_s", 0.01834098}, {"density_kg_m3", 2700.0}};
}

inline Json example_measured() {
  Json json{{"format", "drumlin-measured-1"}, {"reduced", false}, {"seconds", 20.0}};
  for (const Scalar& scalar : example_side().scalars.scalars)
    json[scalar.name] = {{"value", scalar.value}, {"ci99", *scalar.ci99}};
  json["settings"] = {
      {"rotation", 0.0115}, {"drum_radius", 68.18}, {"frame_angle_deg", 19.7}, {"scales", example_scales()}};
  json["steadiness"] = {{"steady", true}, {"reasons", Json::array()}};
  return json;
}

inline Json example_run() {
  return {{"format", "drumlin-run-1"}, {"title", "A drum"},     {"reduced", false},
          {"status", "finished"},      {"wall_seconds", 300.0}, {"cpu_seconds", 250.0}};
}

/// RUN: run.json, measured/measured.json, measured/profiles.csv.
inline std::filesystem::path measured_folder(const TemporaryFolder& folder, const std::string& name,
                                             const ProfileSet& profiles = example_profiles(),
                                             const Json& measured = example_measured(),
                                             const Json& run = example_run()) {
  const std::filesystem::path path = folder / name;
  std::filesystem::create_directories(path / "measured");
  replace_file(path / "run.json", run.dump());
  replace_file(path / "measured" / "measured.json", measured.dump());
  write_profiles(path / "measured" / "profiles.csv", profiles);
  return path;
}

inline Json example_flow() {
  return {{"format", "drumlin-flow-run-2"},
          {"reduced", false},
          {"geometry", "drum"},
          {"theta_deg", 19.7},
          {"Q", 21.8},
          {"H", example_H},
          {"lambda", 3.5},
          {"seconds", 5.0},
          {"cpu_seconds", 5.0},
          {"settings", {{"rotation", 0.0115}, {"drum_radius", 68.18}, {"scales", example_scales()}}}};
}

/// FLOWRUN: flow.json, profiles.csv.
inline std::filesystem::path flow_folder(const TemporaryFolder& folder, const std::string& name,
                                         const ProfileSet& profiles = continuum_profiles(),
                                         const Json& flow = example_flow()) {
  const std::filesystem::path path = folder / name;
  std::filesystem::create_directories(path);
  replace_file(path / "flow.json", flow.dump());
  write_profiles(path / "profiles.csv", profiles);
  return path;
}

}  // namespace drumlin::testing
