#include <gtest/gtest.h>

#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/run_log.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::message_of;
using testing::TemporaryFolder;

constexpr const char* header = "step,time_s,stage,contacts,residual,overlap_mean,overlap_max\n";

TEST(RunLog, AveragesOverTheWholeStageOfTheSnapshots) {
  const TemporaryFolder folder;
  const auto log = folder.with("log.csv", std::string(header) +
                                              "10,1,settle,5,9,9,9\n"
                                              "20,2,sample,5,0.01,1e-4,1e-3\n"
                                              "30,3,sample,5,0.03,3e-4,5e-3\n"
                                              "40,4,sample,5,,2e-4,2e-3\n");
  const ScalarSet scalars = accuracy_scalars(log, 2.5, 4);
  EXPECT_NEAR(scalars.value("overlap_mean"), 2e-4, 1e-12);
  EXPECT_NEAR(scalars.value("overlap_max"), 5e-3, 1e-12);
  EXPECT_NEAR(scalars.value("residual_mean"), 0.02, 1e-12);  // the empty field does not count
  EXPECT_FALSE(scalars.find("overlap_max")->ci99);
}

TEST(RunLog, SnapshotAtTheVeryEndBelongsToTheLastStage) {
  const TemporaryFolder folder;
  const auto log = folder.with("log.csv", std::string(header) + "10,1,settle,5,9,9,9\n20,2,sample,5,1,1,1\n");
  EXPECT_EQ(accuracy_scalars(log, 2.0001, 2.0001).value("overlap_mean"), 1);
}

TEST(RunLog, LogWithoutStepsGivesNoNumbers) {
  const TemporaryFolder folder;
  EXPECT_TRUE(std::isnan(accuracy_scalars(folder.with("log.csv", header), 0, 1).value("overlap_max")));
}

TEST(RunLog, FileOfAnotherKindIsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  const auto other = folder.with("log.csv", "step,time_s,stage\n");
  EXPECT_NE(message_of<InputError>([&] { accuracy_scalars(other, 0, 1); }).find("overlap_mean"),
            std::string::npos);
  const auto torn = folder.with("torn.csv", std::string(header) + "1,abc,x,1,1,1,1\n");
  EXPECT_NE(message_of<InputError>([&] { accuracy_scalars(torn, 0, 1); }).find("torn.csv:2"),
            std::string::npos);
  EXPECT_THROW(accuracy_scalars(folder / "missing.csv", 0, 1), InputError);
}

}  // namespace
}  // namespace drumlin
