// What a folder must hold to be calibrated on or compared: one refusal each, named by file, key and value.
#include <gtest/gtest.h>

#include <cstring>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/measured_run.hpp"
#include "tests/comparison/run_folders.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin::apps {
using namespace coupling;
namespace {

namespace fs = std::filesystem;
using namespace testing;

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) expect_has(text, word);
}

/// The refusal of the run names all these words.
void expect_refused(const fs::path& run, const std::vector<std::string>& words) {
  expect_words(message_of<InputError>([&] { read_measured_run(run); }), words);
}

/// Another text behind a key of the header in the file.
void spoil_header(const fs::path& file, const std::string& key, const std::string& text) {
  std::string content = file_text(file);
  const auto from = content.find("# " + key + " = ");
  content.replace(from, content.find('\n', from) - from, "# " + key + " = " + text);
  replace_file(file, content);
}

/// One text of a file of a good folder, replaced, and words of the refusal.
struct Spoilt {
  const char *file, *text, *by;
  std::vector<std::string> words;
};
constexpr const char *measured_json = "measured/measured.json", *profiles_csv = "measured/profiles.csv";

void spoil(const fs::path& folder, const Spoilt& spoilt) {
  std::string content = file_text(folder / spoilt.file);
  content.replace(content.find(spoilt.text), std::strlen(spoilt.text), spoilt.by);
  replace_file(folder / spoilt.file, content);
}

TEST(MeasuredRun, ReadsWhatStandsInTheFolder) {
  const TemporaryFolder folder;
  const MeasuredRun run = read_measured_run(measured_folder(folder, "six"));
  EXPECT_EQ(run.name, "six");
  EXPECT_EQ(run.scalars.value("H"), example_H);
  EXPECT_EQ(run.scales.length_m, 0.0033);
  EXPECT_FALSE(run.reduced);
  EXPECT_TRUE(run.unsteady.empty());
  EXPECT_EQ(name_of_folder(folder / "six/"), "six");
}

TEST(MeasuredRun, EveryRunOfTheRepositoryIsOne) {
  std::vector<MeasuredRun> runs;
  for (const auto& entry : fs::directory_iterator(drumlin::test::data_folder() / "profiles")) {
    runs.push_back(read_measured_run(entry.path()));
    EXPECT_EQ(runs.back().slices.size(), 5u) << runs.back().name;
  }
  EXPECT_EQ(runs.size(), 8u);
  EXPECT_NO_THROW(require_same_units(runs));
}

TEST(MeasuredRun, RefusesWhatIsNoFolderAndWhatWasNotMeasured) {
  const TemporaryFolder folder;
  expect_refused(folder / "nowhere", {"nowhere", "no such folder"});
  expect_refused(folder.with("file", "text"), {"file", "folder is needed"});
  const fs::path run = measured_folder(folder, "run");
  fs::remove(run / "measured" / "measured.json");
  expect_refused(run, {"run drumlin measure"});
}

TEST(MeasuredRun, RefusesAnUnsteadyRunUnlessItIsAccepted) {
  const TemporaryFolder folder;
  Json measured = example_measured();
  measured["steadiness"] = {{"steady", false}, {"reasons", {"half a turn only", "still settling"}}};
  const fs::path run = measured_folder(folder, "run", example_profiles(), measured);
  expect_refused(run, {"steadiness", "half a turn only", "still settling", "--accept-unsteady"});
  const MeasuredRun accepted = read_measured_run(run, Unsteady::accept);
  EXPECT_EQ(accepted.unsteady, (std::vector<std::string>{"half a turn only", "still settling"}));
}

TEST(MeasuredRun, RefusesAFrameThatIsNotPlaced) {
  const TemporaryFolder folder;
  int number = 0;
  for (const char* key :
       {"side", "theta_deg", "rotation", "drum_radius", "diameter_m", "position", "axis_depth", "wall_z"}) {
    ProfileSet profiles = example_profiles();
    erase_entry(profiles.header, key);
    expect_refused(measured_folder(folder, std::to_string(number++), profiles), {key, "is missing"});
    if (key == std::string("side")) continue;
    for (const char* text : {"nan", "inf", "1e999", "19 deg"}) {
      const fs::path run = measured_folder(folder, std::to_string(number++));
      spoil_header(run / "measured" / "profiles.csv", key, text);
      expect_refused(run, {"profiles.csv", key, text});
    }
  }
}

TEST(MeasuredRun, RefusesEmptyLayersInsideThePackingAlone) {
  const TemporaryFolder folder;
  ProfileSet profiles = example_profiles();
  column_of(profiles, "v_x").value[0] = std::nan("");                      // touches the wall
  column_of(profiles, "v_x").value[profiles.z.size() - 1] = std::nan("");  // touches the surface
  EXPECT_NO_THROW(read_measured_run(measured_folder(folder, "ends", profiles)));
  column_of(profiles, "sigma_xz").value[30] = std::nan("");
  expect_refused(measured_folder(folder, "hole", profiles), {"sigma_xz", "z = -29.5", "is empty"});
}

TEST(MeasuredRun, RefusesMissingLayersAndColumns) {
  const TemporaryFolder folder;
  ProfileSet profiles = example_profiles();
  profiles.columns.erase(profiles.columns.begin());
  expect_refused(measured_folder(folder, "column", profiles), {"v_x", "no column"});
  const auto without = [&](std::size_t from, std::size_t to) {
    ProfileSet cut = example_profiles();
    const auto erase = [&](std::vector<double>& v) {
      v.erase(v.begin() + static_cast<long>(from), v.begin() + static_cast<long>(to));
    };
    erase(cut.z);
    for (auto& column : cut.columns) erase(column.value), erase(column.ci99);
    return cut;
  };
  expect_refused(measured_folder(folder, "gap", without(20, 30)), {"no layer between"});
  expect_refused(measured_folder(folder, "bottom", without(0, 10)), {"no layer between -60"});
  expect_refused(measured_folder(folder, "none", without(0, 60)), {"0 layers"});
}

TEST(MeasuredRun, RefusesNumbersThatAreNone) {
  const TemporaryFolder folder;
  const fs::path run = measured_folder(folder, "run");
  const std::string profiles = file_text(run / profiles_csv);
  for (const char* text : {"nan", "inf", "-inf", "1e999"}) {
    std::string damaged = profiles;
    const auto at = damaged.find("\n-59.5,") + 7;
    damaged.replace(at, damaged.find(',', at) - at, text);
    replace_file(run / profiles_csv, damaged);
    expect_refused(run, {"profiles.csv", "v_x", text});
  }
}

TEST(MeasuredRun, RefusesOtherVersionsUnfinishedRunsAndFilesThatDisagree) {
  for (const Spoilt& spoilt : std::vector<Spoilt>{
           {measured_json,
            "drumlin-measured-1",
            "drumlin-measured-9",
            {"measured.json", "drumlin-measured-1"}},
           {"run.json", "drumlin-run-1", "drumlin-run-9", {"run.json", "drumlin-run-1"}},
           {profiles_csv, "drumlin-profiles-1", "drumlin-profiles-9", {"profiles.csv", "drumlin-profiles-1"}},
           {"run.json", "finished", "running", {"run.json", "status", "running", "finished"}},
           {measured_json, "steadiness", "mood", {"does not say"}},
           {profiles_csv, "particles", "continuum", {"profiles.csv", "side", "continuum", "particles"}},
           {profiles_csv, "0.0033", "3.3", {"diameter_m", "3.3", "0.0033", "the same units"}},
           {measured_json, "0.0033", "null", {"settings.scales.length_m"}},
           {measured_json, "0.0033", "1e999", {"measured.json"}},
           {measured_json,
            "frame_angle_deg\":19.7",
            "frame_angle_deg\":12",
            {"theta_deg", "12", "the same frame"}},
           {measured_json, "reduced\":false", "reduced\":true", {"reduced", "false", "true"}}}) {
    const TemporaryFolder folder;
    const fs::path run = measured_folder(folder, "run");
    spoil(run, spoilt);
    expect_refused(run, spoilt.words);
  }
}

TEST(MeasuredRun, RefusesASliceOfAnotherFrame) {
  const TemporaryFolder folder;
  const fs::path run = measured_folder(folder, "run");
  fs::create_directories(run / "measured" / "slices");
  ProfileSet slice = example_profiles();
  slice.header.position = 20.5;
  write_profiles(run / "measured" / "slices" / "x+20.5.csv", slice);
  EXPECT_EQ(read_measured_run(run).slices.begin()->first, 20.5);
  slice.header.theta_deg = 25;
  write_profiles(run / "measured" / "slices" / "x+20.5.csv", slice);
  expect_refused(run, {"x+20.5.csv", "theta_deg", "25"});
}

TEST(MeasuredRun, NamesAllItsFaultsAtOnce) {
  const TemporaryFolder folder;
  ProfileSet profiles = continuum_profiles();
  profiles.header.axis_depth.reset();
  Json measured = example_measured();
  measured["steadiness"] = {{"steady", false}, {"reasons", {"half a turn only"}}};
  expect_refused(measured_folder(folder, "run", profiles, measured),
                 {"side", "axis_depth", "half a turn only"});
}

TEST(MeasuredRuns, OfMixedUnitsOrSizesAreRefusedTogether) {
  const TemporaryFolder folder;
  const MeasuredRun run = read_measured_run(measured_folder(folder, "run"));
  const auto refusal = [&](auto change) {
    MeasuredRun other = run;
    change(other);
    return message_of<InputError>([&] { require_same_units({run, other}); });
  };
  expect_words(refusal([](MeasuredRun& r) { r.scales.length_m = 0.001; }), {"scales.length_m", "0.001"});
  expect_words(refusal([](MeasuredRun& r) { r.scales.time_s *= 2; }), {"scales.time_s"});
  expect_words(refusal([](MeasuredRun& r) { r.scales.density_kg_m3 = 1; }), {"scales.density_kg_m3"});
  expect_words(refusal([](MeasuredRun& r) { r.reduced = true; }), {"reduced"});
}

TEST(FlowRunFolder, IsReadAndRefusedInTheSameWay) {
  const TemporaryFolder folder;
  const fs::path good = flow_folder(folder, "flow");
  EXPECT_EQ(read_flow_run(good).scalars.value("theta_deg"), 19.7);
  EXPECT_TRUE(is_flow_run(good));
  EXPECT_FALSE(is_flow_run(measured_folder(folder, "run")));
  const auto expect_flow_refused = [](const fs::path& path, const std::vector<std::string>& words) {
    expect_words(message_of<InputError>([&] { read_flow_run(path); }), words);
  };
  for (const Spoilt& spoilt : std::vector<Spoilt>{
           {"profiles.csv", "# side = continuum", "# side = particles", {"side", "continuum"}},
           {"flow.json", "drumlin-flow-run-2", "drumlin-flow-run-9", {"drumlin-flow-run-2"}},
           {"flow.json", "geometry\":\"drum", "geometry\":\"chute", {"geometry", "drum"}}}) {
    const fs::path flow = flow_folder(folder, "spoilt");
    spoil(flow, spoilt);
    expect_flow_refused(flow, spoilt.words);
  }
  ProfileSet hole = continuum_profiles();
  column_of(hole, "v_x").value[30] = std::nan("");
  expect_flow_refused(flow_folder(folder, "hole", hole), {"v_x", "is empty"});
  fs::remove(good / "flow.json");
  expect_flow_refused(good, {"flow.json", "not finished"});
}

}  // namespace
}  // namespace drumlin::apps
