// Results of flows from numbers that are given: no flow is solved.
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/estimates/flow_accuracy.hpp"
#include "continuum/time_stepping/drum_march.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace continuum;
namespace {

RheologyFit law_with_k() {
  RheologyFit law;
  law.mu = LogLaw{.a = 0.35, .b = 0.013};
  law.k = NormalStressRatio{.I = {1e-3, 1e-2, 1e-1}, .k = {0.95, 1, 1.1}};
  law.nu = 0.82;
  return law;
}

FlowScene drum_scene() { return read_flow_scene(test::data_folder() / "scenes/drum-6rpm-flow.toml"); }

FlowScene ring_scene() {
  FlowScene scene;
  scene.geometry = FlowAnnulus{66, 132, 13, 350};
  scene.grains = {.count = {}, .diameter_min_mm = 3, .diameter_max_mm = 3.6, .density_kg_m3 = 2700};
  return scene;
}

TEST(FlowCase, HasAClosedFormOnlyWhereTheProblemHas) {
  RheologyFit without_k = law_with_k();
  without_k.k = {};
  EXPECT_TRUE(flow_case(ring_scene(), without_k).closed_form);
  EXPECT_FALSE(flow_case(ring_scene(), law_with_k()).closed_form);  // k changes the pressure along the radius
  EXPECT_FALSE(flow_case(drum_scene(), without_k).closed_form);
}

MeshResult mesh_result(int level, int unknowns, double theta_deg) {
  return {level, unknowns / 10, unknowns, {{{"theta_deg", theta_deg, {}}}}};
}

Sensitivity changed_by(const std::string& setting, double theta_deg, double cpu_seconds) {
  return {setting, true, {{{"theta_deg", theta_deg, {}}}}, 0, 3, cpu_seconds};
}

TEST(FlowAccuracy, AddsTheErrorsOfMeshEpsAndIteration) {
  const std::vector<MeshResult> meshes = {mesh_result(0, 1000, 19), mesh_result(1, 4000, 19.5)};
  const std::vector<Sensitivity> changes = {changed_by(finer_shear_rate, -0.03, 2),
                                            changed_by(weaker_pressure, 0.2, 2),
                                            changed_by(one_more_iteration, 1e-6, 1)};
  const FlowReport report;
  const FlowAccuracy accuracy = accuracy_of(drum_scene(), {report, meshes, changes, {}, 10});
  ASSERT_EQ(accuracy.scalars.size(), 1u);
  const ScalarAccuracy& theta = accuracy.scalars[0];
  EXPECT_NEAR(theta.error().value(), 0.5 + 0.04 + 1e-6, 1e-12);  // eps / 4 leaves a third of its change
  EXPECT_EQ(theta.dominant(), "mesh");
  EXPECT_EQ(theta.by_p_min, 0.2);  // a choice of the model: no part of the error
  EXPECT_FALSE(theta.by_law);
  ASSERT_EQ(accuracy.halvings.size(), 3u);
  EXPECT_EQ(accuracy.halvings[0].source, "mesh");
  EXPECT_DOUBLE_EQ(accuracy.halvings[0].cpu_seconds, 10 * (1 + 4));  // four times the unknowns
  EXPECT_DOUBLE_EQ(accuracy.halvings[1].cpu_seconds, 12);
}

TEST(FlowAccuracy, TakesTheLimitThatThreeMeshesShow) {
  const std::vector<MeshResult> meshes = {mesh_result(0, 1000, 20 + 0.16), mesh_result(1, 4000, 20 + 0.04),
                                          mesh_result(2, 16000, 20 + 0.01)};
  const FlowReport report;
  const FlowAccuracy accuracy = accuracy_of(drum_scene(), {report, meshes, {}, {}, 10});
  EXPECT_NEAR(accuracy.scalars.at(0).error().value(), 0.01, 1e-9);  // second order: the rest is a third
}

TEST(FlowAccuracy, OfAMarchIsNotKnown) {
  FlowScene scene = drum_scene();
  scene.time = FlowTime{.step_s = 0.1, .steps = 2};
  const std::vector<MeshResult> meshes = {mesh_result(0, 1000, 19)};
  const FlowReport report;
  const FlowAccuracy accuracy = accuracy_of(scene, {report, meshes, {}, {}, 10});
  EXPECT_TRUE(accuracy.scalars.empty() && accuracy.halvings.empty());
}

TEST(DrumMarch, RampsFromTheSpeedOfItsStart) {
  FlowScene scene = drum_scene();
  scene.time = FlowTime{.step_s = 0.1, .steps = 40, .ramp_s = 2};
  DrumMarch march = drum_march(scene, law_with_k());
  EXPECT_DOUBLE_EQ(speed_share(march, 0.5), 0.25);
  EXPECT_EQ(speed_share(march, 3), 1);
  march.start.start_share = 0.6;
  EXPECT_DOUBLE_EQ(speed_share(march, 1), 0.8);
  EXPECT_TRUE(march.case_at(0.5).problem.turned);  // as complete at any speed
}

}  // namespace
}  // namespace drumlin
