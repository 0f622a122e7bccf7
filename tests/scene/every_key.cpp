// For every key of a scene file: another value, and what it changes in a tiny run (every_key.json). A key
// without a case fails the test.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/commands/run.hpp"
#include "apps/json/json_file.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace particles;
namespace {

const std::filesystem::path here = test::data_folder().parent_path() / "tests/scene";

/// What a run leaves, as texts by their names, as far as the same scene leaves the same again; nine digits.
using Left = std::map<std::string, std::string>;

std::vector<std::vector<std::string>> fields_of_file(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    lines.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) lines.back().push_back(field);
  }
  return lines;
}

/// Exit code of the run command, as main() would return it; what it says is not shown.
ExitCode run_quietly(const apps::RunOptions& options) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  ExitCode code{};
  try {
    code = static_cast<ExitCode>(apps::run(options));
  } catch (const InputError&) {
    code = ExitCode::wrong_input;
  } catch (const NotConvergedError&) {
    code = ExitCode::not_converged;
  }
  ::testing::internal::GetCapturedStdout();
  ::testing::internal::GetCapturedStderr();
  return code;
}

/// Of a finished or broken off run; of a refused scene the exit code alone. Beside the scene lie lists of
/// grains.
Left left_by_run(const std::string& scene, const std::vector<std::string>& overrides) {
  const testing::TemporaryFolder folder;
  folder.with("two.csv", "x_mm,z_mm,diameter_mm\n-3,2,3\n3,3,3.5\n");
  folder.with("three.csv", "x_mm,z_mm,diameter_mm,v_x_mm_s\n-3,2,3,50\n3,3,3.5,0\n0,8,3,0\n");
  apps::RunOptions options;
  options.scene = folder.with("scene.toml", scene);
  options.output = folder / "run";
  options.overrides = overrides;
  const auto& run = options.output;
  Left left{{"exit_code", std::to_string(static_cast<int>(run_quietly(options)))}};
  if (!std::filesystem::exists(run / "run.json")) return left;
  const auto report = read_json(run / "run.json", "drumlin-run-1");
  for (const char* key : {"status", "title", "reduced", "steps"}) left[key] = report.at(key).dump();
  const auto log = fields_of_file(run / "log.csv");
  for (std::size_t column = 0; column < log.at(0).size(); ++column)
    for (std::size_t line = 1; line < log.size(); ++line)
      left["log " + log[0][column]] += log[line].at(column) + " ";
  for (const auto& file : snapshot_files(run)) {
    const Snapshot snapshot = read_snapshot(file);
    const auto numbers = [](const std::vector<double>& values, double unit) {
      std::string text;
      for (const double value : values) text += fmt::format("{:.9g} ", value * unit);
      return text;
    };
    const double length_mm = snapshot.scales.length_m * 1e3, time_s = snapshot.scales.time_s;
    left["snapshots"] += fmt::format("{:.9g} ", snapshot.time * time_s);
    left["windows"] +=
        fmt::format("{:.9g}:{} ", snapshot.velocity_window * time_s, snapshot.displacement_x.size());
    left["positions"] = numbers(snapshot.x, length_mm) + numbers(snapshot.z, length_mm);  // of the last one
    left["spins"] = numbers(snapshot.spin, 1 / time_s);
    left["density"] = numbers({snapshot.scales.density_kg_m3}, 1);
  }
  std::ifstream energy(run / "energy.csv");
  std::getline(energy, left["energy columns"]);
  for (const auto& line : fields_of_file(run / "walls.csv"))
    for (const auto& field : line) left["walls"] += field + " ";
  left["checkpoint"] = std::filesystem::exists(run / "checkpoint.h5") ? "there" : "none";
  if (std::filesystem::exists(run / "problems"))
    for (const auto& file : std::filesystem::directory_iterator(run / "problems"))
      if (file.path().extension() == ".h5") left["captured"] += "one ";
  return left;
}

struct Case {
  std::string key, scene;
  std::vector<std::string> common;  ///< overrides of both runs
  std::string change, seen;
};

/// What gtest says of a case that fails.
void PrintTo(const Case& one, std::ostream* out) { *out << one.key << ": " << one.change; }

std::vector<Case> cases() {
  const auto table = nlohmann::json::parse(file_text(here / "every_key.json"), nullptr, true, true);
  const auto override_of = [&](const std::string& text) {
    return text.starts_with('$') ? table["overrides"].at(text).get<std::string>() : text;
  };
  std::vector<Case> all;
  for (const auto& [scene, rows] : table["cases"].items())
    for (const auto& row : rows) {
      Case& one = all.emplace_back(row[0], file_text(here / ("every_key_" + scene + ".toml")));
      for (const std::string common : row[1]) one.common.push_back(override_of(common));
      one.change = override_of(row[2]), one.seen = row[3];
    }
  return all;
}

TEST(EveryKeyTable, HasACase) {
  std::set<std::string> listed, covered;
  for (const auto& row : scene_keys())
    listed.insert(row.condition.empty() ? row.path : row.path + " with " + row.condition);
  for (const auto& one : cases()) covered.insert(one.key);
  EXPECT_EQ(listed, covered);
}

TEST(EveryKeyTable, TheSameSceneGivesTheSameRun) {
  for (const char* scene : {"every_key_drum.toml", "every_key_floor.toml"}) {
    const Left first = left_by_run(file_text(here / scene), {});
    EXPECT_EQ(first.at("exit_code"), "0");
    EXPECT_EQ(first, left_by_run(file_text(here / scene), {}));
  }
}

class EveryKey : public ::testing::TestWithParam<Case> {};

TEST_P(EveryKey, ChangesWhatARunLeaves) {
  const Case& one = GetParam();
  std::vector<std::string> changed = one.common;
  changed.push_back(one.change);
  Left before = left_by_run(one.scene, one.common), after = left_by_run(one.scene, changed);
  EXPECT_NE(before[one.seen], after[one.seen]) << one.change;
  // A refused scene would differ in everything and prove nothing.
  if (one.seen != "exit_code" && one.seen != "status") {
    EXPECT_EQ(before.at("status"), after.at("status"));
    // A finished run most of whose steps missed a tolerance has another one.
    if (before.at("status") != "\"finished\"") {
      EXPECT_EQ(before.at("exit_code"), after.at("exit_code"));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scene, EveryKey, ::testing::ValuesIn(cases()), [](const auto& chosen) {
  std::string name = chosen.param.key;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

}  // namespace
}  // namespace drumlin
