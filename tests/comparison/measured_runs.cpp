// What a folder must hold to be calibrated on or compared: one refusal each, named by file, key and value.
#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "coupling/results/measured_run.hpp"
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

TEST(MeasuredRun, RefusesAnotherVersionOfEveryFile) {
  const TemporaryFolder folder;
  Json other = example_measured();
  other["format"] = "drumlin-measured-9";
  expect_refused(measured_folder(folder, "a", example_profiles(), other),
                 {"measured.json", "drumlin-measured-1"});
  Json run = example_run();
  run["format"] = "drumlin-run-9";
  expect_refused(measured_folder(folder, "b", example_profiles(), example_measured(), run),
                 {"run.json", "drumlin-run-1"});
  const fs::path c = measured_folder(folder, "c");
  replace_file(c / "measured" / "profiles.csv", "# drumlin-profiles-9\nz,v_x\n");
  expect_refused(c, {"profiles.csv", "drumlin-profiles-1"});
}

TEST(MeasuredRun, RefusesAnUnfinishedRun) {
  const TemporaryFolder folder;
  Json run = example_run();
  run["status"] = "running";
  expect_refused(measured_folder(folder, "run", example_profiles(), example_measured(), run),
                 {"run.json", "status", "running", "finished"});
}

TEST(MeasuredRun, RefusesAnUnsteadyRunUnlessItIsAccepted) {
  const TemporaryFolder folder;
  Json measured = example_measured();
  measured["steadiness"] = {{"steady", false}, {"reasons", {"half a turn only", "still settling"}}};
  const fs::path run = measured_folder(folder, "run", example_profiles(), measured);
  expect_refused(run, {"steadiness", "half a turn only", "still settling", "--accept-unsteady"});
  const MeasuredRun accepted = read_measured_run(run, Unsteady::accept);
  EXPECT_EQ(accepted.unsteady, (std::vector<std::string>{"half a turn only", "still settling"}));
  measured.erase("steadiness");
  expect_refused(measured_folder(folder, "silent", example_profiles(), measured), {"does not say"});
}

TEST(MeasuredRun, RefusesTheOtherSideAndAFrameThatIsNotPlaced) {
  const TemporaryFolder folder;
  expect_refused(measured_folder(folder, "side", continuum_profiles()),
                 {"profiles.csv", "side", "continuum", "particles"});
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
  const fs::path csv = run / "measured" / "profiles.csv", json = run / "measured" / "measured.json";
  const std::string profiles = file_text(csv), measured = file_text(json);
  for (const char* text : {"nan", "inf", "-inf", "1e999"}) {
    std::string damaged = profiles;
    const auto at = damaged.find("\n-59.5,") + 7;
    damaged.replace(at, damaged.find(',', at) - at, text);
    replace_file(csv, damaged);
    expect_refused(run, {"profiles.csv", "v_x", text});
  }
  replace_file(csv, profiles);
  std::string damaged = measured;
  damaged.replace(damaged.find("0.0033"), 6, "1e999 ");
  replace_file(json, damaged);
  expect_refused(run, {"measured.json"});
}

TEST(MeasuredRun, RefusesUnitsThatDisagreeBetweenItsFiles) {
  const TemporaryFolder folder;
  ProfileSet millimetres = example_profiles();
  millimetres.header.diameter_m = 3.3;
  expect_refused(measured_folder(folder, "mm", millimetres),
                 {"diameter_m", "3.3", "0.0033", "the same units"});
  Json measured = example_measured();
  measured["settings"]["scales"]["length_m"] = nullptr;
  expect_refused(measured_folder(folder, "none", example_profiles(), measured), {"settings.scales.length_m"});
  measured = example_measured();
  measured["settings"]["frame_angle_deg"] = 12;
  expect_refused(measured_folder(folder, "frame", example_profiles(), measured),
                 {"theta_deg", "12", "the same frame"});
  measured = example_measured();
  measured["reduced"] = true;
  expect_refused(measured_folder(folder, "reduced", example_profiles(), measured),
                 {"reduced", "false", "true"});
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
  const auto refusal = [&](const fs::path& path) {
    return message_of<InputError>([&] { read_flow_run(path); });
  };
  expect_words(refusal(flow_folder(folder, "side", example_profiles())), {"side", "continuum"});
  Json other = example_flow();
  other["format"] = "drumlin-flow-run-9";
  expect_words(refusal(flow_folder(folder, "version", continuum_profiles(), other)), {"drumlin-flow-run-2"});
  other = example_flow();
  other["geometry"] = "chute";
  expect_words(refusal(flow_folder(folder, "chute", continuum_profiles(), other)), {"geometry", "drum"});
  ProfileSet hole = continuum_profiles();
  column_of(hole, "v_x").value[30] = std::nan("");
  expect_words(refusal(flow_folder(folder, "hole", hole)), {"v_x", "is empty"});
  fs::remove(good / "flow.json");
  expect_words(refusal(good), {"flow.json", "not finished"});
}

}  // namespace
}  // namespace drumlin::apps
