// drumlin cost over a scene of particles: points, resuming, refusals.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/support/accept.hpp"
#include "apps/support/commands.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/common/errors.hpp"
#include "tests/cost/drum_of_a_dozen.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string rotating() {
  return testing::drum_of_a_dozen + R"([[stages]]
name = "turn"
duration_s = 0.5
time_step_s = 1e-3
motions = [{ wall = "drum", kind = "rotation", speed_rpm = 60 }]
[solver]
tolerance = 1e-2
)";
}

apps::CostOptions tiny_sweep(const testing::TemporaryFolder& folder) {
  apps::CostOptions options;
  options.scene = folder.with("scene.toml", rotating());
  options.output = folder / "cost";
  options.sweep = {"tolerance=1e-1:1e-2:1e-3", "step=1e-3"};
  return options;
}

Json swept(const apps::CostOptions& options) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(apps::cost(options), 0);
  ::testing::internal::GetCapturedStdout();
  return read_json(*options.output / "cost.json", "drumlin-cost-1");
}

TEST(ParticleSweep, SaysWhatATighterSolveBuysAndTakes) {
  const testing::TemporaryFolder folder;
  const Json report = swept(tiny_sweep(folder));
  const Json& points = report.at("points");
  ASSERT_EQ(points.size(), 3u);
  int standards = 0;
  for (const Json& point : points) standards += point.at("default").get<bool>();
  EXPECT_EQ(standards, 1);
  const auto of = [&](double tolerance) {
    for (const Json& point : points)
      if (point.at("tolerance") == tolerance) return point;
    return Json();
  };
  EXPECT_GT(of(1e-3).at("sweeps"), of(1e-1).at("sweeps"));
  EXPECT_LT(of(1e-3).at("errors").at("solver"), of(1e-1).at("errors").at("solver"));
  // The most accurate solve is beaten by none.
  const Json front = of(1e-3).at("pareto");
  EXPECT_NE(std::find(front.begin(), front.end(), Json("solver")), front.end());
  EXPECT_TRUE(fs::exists(folder / "cost" / "work_precision.png"));
}

TEST(ParticleSweep, DoesNoPointTwice) {
  const testing::TemporaryFolder folder;
  auto options = tiny_sweep(folder);
  const Json first = swept(options);
  // One point is lost, as if the call had been interrupted before it; another is marked, to be known again.
  const fs::path points = folder / "cost" / "points";
  const fs::path lost = points / "accelerated-tolerance-0.001-step-0.001.json";
  const fs::path kept = points / "accelerated-tolerance-0.1-step-0.001.json";
  ASSERT_TRUE(fs::remove(lost));
  Json marked = read_json(kept, "drumlin-cost-point-1");
  marked["load_before"] = -7;
  apps::write_json(kept, marked);
  EXPECT_EQ(apps::accept({folder / "cost", "one point lost, one marked"}), 0);
  options.existing = apps::ExistingOutput::resume;
  const Json second = swept(options);
  EXPECT_TRUE(fs::exists(lost));
  ASSERT_EQ(second.at("points").size(), first.at("points").size());
  for (std::size_t i = 0; i < first.at("points").size(); ++i) {
    // The work is the same to the last sweep, whether it was done again or not.
    for (const char* key : {"sweeps", "errors"})
      EXPECT_EQ(first.at("points")[i].at(key), second.at("points")[i].at(key)) << key;
    const bool is_kept = second.at("points")[i].at("tolerance") == 0.1;
    EXPECT_EQ(second.at("points")[i].at("load_before") == -7, is_kept);
  }
}

TEST(ParticleSweep, IsNotContinuedWithAnotherScene) {
  const testing::TemporaryFolder folder;
  auto options = tiny_sweep(folder);
  swept(options);
  EXPECT_THROW(apps::cost(options), InputError);  // neither --resume nor --overwrite
  options.existing = apps::ExistingOutput::resume;
  options.overrides = {"effects.friction.grain_grain=0.3"};
  EXPECT_THROW(apps::cost(options), InputError);
}

TEST(ParticleSweep, RefusesWhatItDoesNotKnow) {
  const testing::TemporaryFolder folder;
  auto options = tiny_sweep(folder);
  for (const char* word :
       {"mesh", "tolerances", "tolerance=abc", "tolerance=-1", "solver=best", "step=0", "step=1e-3=2"}) {
    options.sweep = {word};
    EXPECT_THROW(apps::cost(options), InputError) << word;
  }
  EXPECT_FALSE(fs::exists(folder / "cost"));
  options.sweep = {"tolerance", "tolerance"};
  EXPECT_THROW(apps::cost(options), InputError);
  options.sweep = {};
  options.output.reset();
  EXPECT_THROW(apps::cost(options), InputError);
  options.scene = folder.with("other.toml", "format = \"drumlin-import-1\"\n");
  EXPECT_THROW(apps::cost(options), InputError);
}

}  // namespace
}  // namespace drumlin
