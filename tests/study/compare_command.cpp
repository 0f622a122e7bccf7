// drumlin compare --study on runs and flows made here.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/support/commands.hpp"
#include "coupling/common/errors.hpp"
#include "tests/study/run_folders.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin::apps {
using namespace coupling;
namespace {

namespace fs = std::filesystem;
using testing::flow_folder;
using testing::flow_run;
using testing::message_of;
using testing::run_folder;
using testing::TemporaryFolder;
using Json = nlohmann::ordered_json;

/// A flow whose law was fitted on the run at 6 rpm, under the name that run_folder gives it.
StudyFlow flow_of_six(double rpm) {
  StudyFlow flow = flow_run(rpm);
  flow.fitted_on = {"rpm-6"};
  return flow;
}

TEST(CompareStudyCommand, SortsFoldersByTheirFilesAndLeavesTablePageAndFigures) {
  const TemporaryFolder folder;
  const CompareStudyOptions options{{flow_folder(folder, flow_of_six(6)), run_folder(folder, 5),
                                     run_folder(folder, 6), flow_folder(folder, flow_of_six(5))},
                                    {},
                                    folder / "study"};
  EXPECT_EQ(compare_study(options), 0);
  const Json json = Json::parse(file_text(folder / "study/study.json"));
  EXPECT_EQ(json["format"], "drumlin-comparison-study-1");
  ASSERT_EQ(json["speeds"].size(), 2u);
  EXPECT_EQ(json["speeds"][0]["role"], "predicted");
  EXPECT_EQ(json["speeds"][1]["role"], "calibrated");
  EXPECT_EQ(json["speeds"][1]["scalars"]["theta_deg"]["paper"], 19.7);
  EXPECT_NEAR(json["laws"]["flowing_layer_depth"]["paper"]["c"]["value"].get<double>(), 3, 0);
  const std::string page = file_text(folder / "study/index.html");
  EXPECT_LT(page.find("class=\"verdict"), page.find("<figure>")) << "the verdict stands on top";
  for (const char* figure : {"speeds.png", "rates.png", "errors.png"})
    EXPECT_TRUE(fs::exists(folder / "study" / figure)) << figure;
  EXPECT_NE(file_text(folder / "study/table.md").find("| 5 | predicted |"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "study/figures.pending"));
  EXPECT_THROW(compare_study(options), InputError) << "nothing is overwritten unasked";
}

TEST(CompareStudyCommand, JudgesByLimitsOfAFile) {
  const TemporaryFolder folder;
  const CompareStudyOptions options{{flow_folder(folder, flow_of_six(6)), run_folder(folder, 5),
                                     run_folder(folder, 6), flow_folder(folder, flow_of_six(5))},
                                    test::data_folder() / "limits" / "bed.toml",
                                    folder / "study"};
  EXPECT_EQ(compare_study(options), 0);
  const Json limits = Json::parse(file_text(folder / "study/study.json"))["limits"];
  EXPECT_EQ(limits["speeds_rpm"].size(), 2u);
  EXPECT_EQ(limits["rows"].size(), 32u);  // sixteen limits, two registrations
  EXPECT_EQ(limits["judged_by_calibrating_runs"], Json::array({"rpm-6"}));
  EXPECT_NE(file_text(folder / "study/limits.md").find("| sigma_xz static, centre, relative |"),
            std::string::npos);
}

TEST(CompareStudyCommand, RefusesUnfinishedFlowsOtherEffectsAndOtherGeometries) {
  const TemporaryFolder folder;
  const fs::path run = run_folder(folder, 6), six = flow_folder(folder, flow_of_six(6)),
                 five = flow_folder(folder, flow_of_six(5), "[effects.inertia]\n");
  const auto refusal = [&](std::vector<fs::path> folders) {
    const std::string said = message_of<InputError>([&] {
      compare_study({std::move(folders), {}, folder / "study"});
    });
    EXPECT_FALSE(fs::exists(folder / "study")) << "a refusal leaves nothing";
    return said;
  };
  EXPECT_NE(refusal({run, six, five}).find("inertia"), std::string::npos);
  EXPECT_NE(refusal({run, folder / "nowhere"}).find("no such folder"), std::string::npos);
  EXPECT_NE(refusal({run}).find("continuum flow"), std::string::npos);
  Json flow = Json::parse(file_text(six / "flow.json"));
  flow["geometry"] = "chute";
  replace_file(six / "flow.json", flow.dump());
  EXPECT_NE(refusal({run, six}).find("chute"), std::string::npos);
  fs::remove(six / "flow.json");
  EXPECT_NE(refusal({run, six}).find("not finished"), std::string::npos);
}

}  // namespace
}  // namespace drumlin::apps
