// drumlin measure --study on measured runs made here.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/support/commands.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/study/study_run_folder.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/run_folders.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin::apps {
using namespace coupling;
namespace {

namespace fs = std::filesystem;
using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;
using Json = nlohmann::ordered_json;
using drumlin::testing::measured_json;
using drumlin::testing::run_folder;

StudyOptions options_for(const TemporaryFolder& folder, std::vector<fs::path> runs,
                         ExistingOutput existing = ExistingOutput::refuse) {
  return {std::move(runs), folder / "study", existing};
}

TEST(StudyCommand, LeavesStudyTablePageAndFiguresAndNamesAnUnsteadyRun) {
  const TemporaryFolder folder;
  const StudyRun unsteady = drumlin::testing::drum_run(2);
  Json measured = measured_json(unsteady);
  measured["steadiness"] = {{"steady", false}, {"reasons", {"half a turn only"}}};
  const std::vector<fs::path> runs{run_folder(folder, 6), run_folder(folder, unsteady, measured),
                                   run_folder(folder, 15)};
  EXPECT_EQ(study(options_for(folder, runs)), 0);
  const Json json = Json::parse(file_text(folder / "study/study.json"));
  EXPECT_EQ(json["format"], "drumlin-study-1");
  EXPECT_EQ(json["speeds"].size(), 3u);
  EXPECT_NEAR(json["laws"]["flowing_layer_depth"]["coefficients"]["c"]["value"].get<double>(), 3, 1e-6);
  ASSERT_EQ(json["warnings"].size(), 1u);
  EXPECT_EQ(json["warnings"][0], "rpm-2: half a turn only");
  EXPECT_NE(file_text(folder / "study/index.html").find("half a turn only"), std::string::npos);
  EXPECT_NE(file_text(folder / "study/paper_table.md").find("| H | 6 | 14.6 |"), std::string::npos);
  EXPECT_NE(file_text(folder / "study/index.html").find("data:image/png;base64,"), std::string::npos);
  for (const char* figure : {"fig03_velocity.png", "fig06_depth_and_friction.png", "fig11_rheology.png"})
    EXPECT_TRUE(fs::exists(folder / "study" / figure)) << figure;
  EXPECT_FALSE(fs::exists(folder / "study/figures.pending"));
  EXPECT_THROW(study(options_for(folder, runs)), InputError) << "nothing is overwritten unasked";
  EXPECT_EQ(study(options_for(folder, runs, ExistingOutput::resume)), 0);
}

// Those of data/profiles stand beside a run of today in ./reproduce: a key that scenes have learnt since must
// not part them.
TEST(StudyCommand, TakesRunsOfEarlierProgramsBesideThoseOfNow) {
  const TemporaryFolder folder;
  int runs = 0;
  for (const auto& entry : fs::directory_iterator(test::data_folder() / "profiles")) {
    const fs::path now = folder / (entry.path().filename().string() + "-now");
    fs::copy(entry.path(), now, fs::copy_options::recursive);
    const std::string text = file_text(now / "scene.toml");
    replace_file(now / "scene.toml", particles::scene_text(particles::parse_scene(text, "scene.toml")));
    const StudyRun earlier = read_study_run(entry.path()), today = read_study_run(now);
    EXPECT_NO_THROW(require_one_study({earlier, today})) << entry.path();
    ++runs;
  }
  EXPECT_EQ(runs, 8);
}

TEST(StudyCommand, RefusesWhatIsNoMeasuredFinishedRun) {
  const TemporaryFolder folder;
  const fs::path good = run_folder(folder, 6), other = run_folder(folder, 2);
  const auto refusal = [&] {
    const std::string said = message_of<InputError>([&] { study(options_for(folder, {good, other})); });
    EXPECT_FALSE(fs::exists(folder / "study")) << "a refusal leaves nothing";
    return said;
  };
  replace_file(other / "run.json", R"({"format": "drumlin-run-1", "status": "running"})");
  EXPECT_NE(refusal().find("unfinished"), std::string::npos);
  replace_file(other / "run.json", R"({"format": "drumlin-run-1", "status": "finished"})");
  const std::string measured = file_text(other / "measured/measured.json");
  replace_file(other / "measured/measured.json", R"({"format": "drumlin-measured-9"})");
  EXPECT_NE(refusal().find("drumlin-measured-1"), std::string::npos);
  replace_file(other / "measured/measured.json", measured);
  const std::string profiles = file_text(other / "measured/profiles.csv");
  std::string damaged = profiles;
  damaged.replace(damaged.find("wall_z = -64"), 12, "wall_z = low");
  replace_file(other / "measured/profiles.csv", damaged);
  EXPECT_NE(refusal().find("wall_z"), std::string::npos);
  replace_file(other / "measured/profiles.csv", profiles);
  fs::remove(other / "measured/measured.json");
  EXPECT_NE(refusal().find("drumlin measure"), std::string::npos);
  replace_file(other / "measured/measured.json", measured);
  fs::remove_all(good);
  EXPECT_NE(refusal().find("no such folder"), std::string::npos);
}

TEST(StudyCommand, RefusesMixedSettingsReducedRunsAndOtherScenes) {
  const TemporaryFolder folder;
  const StudyRun run = drumlin::testing::drum_run(2);
  Json measured = measured_json(run);
  measured["settings"]["linear_share"] = 0.5;
  const fs::path six = run_folder(folder, 6), other = run_folder(folder, run, measured);
  const auto refusal = [&] {
    return message_of<InputError>([&] { study(options_for(folder, {six, other})); });
  };
  EXPECT_NE(refusal().find("settings.linear_share"), std::string::npos);

  StudyRun reduced = run;
  reduced.profiles.header.reduced = true;
  run_folder(folder, reduced, measured_json(reduced));
  EXPECT_NE(refusal().find("reduced"), std::string::npos);

  run_folder(folder, run, measured_json(run));
  replace_file(six / "scene.toml", "[effects.friction]\ngrain_grain = 0.4\n");
  replace_file(other / "scene.toml", "[effects.friction]\ngrain_grain = 0.2\n");
  EXPECT_NE(refusal().find("effects"), std::string::npos);

  // An older program wrote no list of groups where there is none.
  replace_file(other / "scene.toml", "[effects.friction]\ngrain_grain = 0.4\npairs = []\n");
  EXPECT_EQ(study(options_for(folder, {six, other})), 0);
}

}  // namespace
}  // namespace drumlin::apps
