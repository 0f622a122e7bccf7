// What a converged flow must still meet: mass balance, a slope that a free surface can have, a speed that is
// not eps's.
#include "continuum/estimates/flow_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/fem/scene_options.hpp"

namespace drumlin::flow_limits {
using namespace continuum;
namespace {

RheologyFit law_of(const FrictionLaw& mu) {
  RheologyFit law;
  law.mu = mu;
  law.nu = 0.82;
  return law;
}
const RheologyFit paper = law_of(LogLaw{.a = 0.35, .b = 0.013});
const RheologyFit jop = law_of(JopLaw{0.383, 0.643, 0.279});

FlowScene scene_of(const std::string& geometry, const std::string& rest) {
  return parse_flow_scene(
      "format = \"drumlin-flow-scene-1\"\n" + geometry +
          "\n[grains]\ndiameter_min_mm = 3\ndiameter_max_mm = 3.6\ndensity_kg_m3 = 2700\n" + rest,
      "scene");
}

// A drum of 30 d on cells of 3 d.
FlowScene drum_scene(int grains = 350, double rpm = 15, double cell = 3) {
  FlowScene scene = scene_of("[drum]\ndiameter_mm = 100\nrotation_rpm = 15",
                             "count = 350\n[mesh]\nlevels = 1\n[regularisation]\nshear_rate = 1e-3\n");
  scene.grains.count = grains;
  std::get<FlowDrum>(scene.geometry).rotation_rpm = rpm;
  scene.mesh.surface_cell = cell;
  return scene;
}

struct Judged {
  FlowSolution solution;
  FlowOnFinerMeshes finer;
  FlowFindings findings;
  std::vector<std::string> missed;
};

Judged judged(const FlowScene& scene, const RheologyFit& law) {
  const FlowCase chosen = flow_case(scene, law);
  std::vector<MeshResult> meshes;
  FlowObserver observer;
  observer.level_finished = [&](int level, const FlowField& field) {
    meshes.push_back({level, field.cells(), field.unknowns(), chosen.scalars(field)});
  };
  FlowSolution solution = solve_flow(chosen.problem, solver_options(scene), observer);
  EXPECT_TRUE(solution.report.converged) << solution.report.failure;
  FlowOnFinerMeshes finer = add_meshes(scene, chosen, solution, observer, [](double) {});
  FlowFindings findings = findings_of(chosen, solution.field, finer.checks);
  auto missed = missed_limits(scene, chosen, meshes, findings, finer);
  return {std::move(solution), std::move(finer), std::move(findings), std::move(missed)};
}

// The only sentence, if there is one.
std::string sentence(const Judged& flow) {
  EXPECT_LE(flow.missed.size(), 1u);
  return flow.missed.empty() ? "" : flow.missed.front();
}

bool says(const Judged& flow, const char* words) { return sentence(flow).find(words) != std::string::npos; }

TEST(FlowLimits, CellsAreHalvedWhereTheMeshIsTooCoarse) {
  const Judged flow = judged(drum_scene(), paper);
  ASSERT_GE(flow.finer.imbalance.size(), 2u);
  EXPECT_GT(flow.finer.imbalance.front(), largest_flux_imbalance);
  EXPECT_LT(flow.finer.imbalance.back(), largest_flux_imbalance);
  EXPECT_EQ(sentence(flow), "");
  // It is the flow of a scene that asks for these meshes, each solved to 1e-8.
  FlowScene finer = drum_scene();
  const int added = static_cast<int>(flow.finer.imbalance.size()) - 1;
  finer.mesh.levels += added;
  finer.mesh.surface_cell *= std::pow(0.5, added);
  const FlowSolution asked = solve_flow(flow_case(finer, paper).problem, solver_options(finer));
  EXPECT_EQ(flow.solution.field.cells(), asked.field.cells());
  EXPECT_NEAR(flow.solution.field.theta(), asked.field.theta(), 1e-6);
  EXPECT_EQ(flow.solution.report.meshes, asked.report.meshes);
  EXPECT_EQ(static_cast<std::size_t>(flow.solution.report.iterations), flow.solution.report.history.size());
  // Others start from it as from any flow.
  const FlowSolution again = solve_flow_from(
      flow.solution.field.state(), flow_case(drum_scene(), paper).problem, solver_options(drum_scene()));
  EXPECT_EQ(again.report.start, "neighbour");
  EXPECT_NEAR(again.field.theta(), asked.field.theta(), 1e-6);
}

TEST(FlowLimits, ALeakIsNotOneOfTheMesh) {
  FlowScene soft = drum_scene(350, 15, 1.5);
  soft.boundary->surface_stiffness = 10;
  const Judged flow = judged(soft, paper);
  EXPECT_EQ(flow.finer.imbalance.size(), 1u);
  EXPECT_TRUE(says(flow, "surface_stiffness")) << sentence(flow);
}

TEST(FlowLimits, AFlowThatDependsOnItsMeshIsSaidToBeIllPosed) {
  FlowScene weak = drum_scene(350, 15, 1.5);
  weak.regularisation.pressure = 1e-12;  // no strength where the surface's traction is negative
  const Judged flow = judged(weak, paper);
  EXPECT_GT(flow.finer.imbalance.back(), largest_flux_imbalance);
  EXPECT_TRUE(flow.solution.report.converged);  // that of the last mesh that had one
  EXPECT_TRUE(says(flow, "ill-posed")) << sentence(flow);
}

TEST(FlowLimits, NoFreeSurfaceHangsOver) {
  FlowScene glued = drum_scene(350, 15, 1.5);
  glued.regularisation.pressure = 9.7;
  const Judged flow = judged(glued, paper);
  EXPECT_GT(flow.solution.field.theta(), 0.5 * std::numbers::pi);
  EXPECT_TRUE(says(flow, "none of a free surface")) << sentence(flow);
}

// tau = mu p rate/sqrt(rate^2 + eps^2) in plane shear.
TEST(FlowLimits, AWallThatMovesAtTheSpeedOfEpsMeetsTooLittleStress) {
  FlowScene scene = scene_of("[plane_shear]\ngap_mm = 66\nwall_speed_mm_s = 72\npressure_pa = 350",
                             "[mesh]\nsurface_cell = 5\nlevels = 1\n[regularisation]\npressure = 1e-4\n");
  const double rate = 72.0 / 66 * scales_of(scene).time_s;
  const auto with_eps = [&](double eps) {
    scene.regularisation.shear_rate = eps;
    return judged(scene, paper);
  };
  const Judged same = with_eps(rate), larger = with_eps(2 * rate), small = with_eps(0.1 * rate);
  EXPECT_NEAR(same.findings.eps_share, 1 - 1 / std::sqrt(2), 1e-6);
  EXPECT_TRUE(says(same, "flows hardly faster than eps")) << sentence(same);
  EXPECT_NEAR(larger.findings.eps_share, 1 - 1 / std::sqrt(5), 1e-6);
  EXPECT_TRUE(says(larger, "does not flow")) << sentence(larger);
  EXPECT_NEAR(small.findings.eps_share, 1 - 1 / std::sqrt(1.01), 1e-6);
  EXPECT_EQ(sentence(small), "");
}

TEST(FlowLimits, ALayerBelowTheYieldSlopeDoesNotFlow) {
  const auto at = [](double slope_deg) {
    FlowScene scene = scene_of("[incline]\nheight_mm = 66\nslope_deg = 17",
                               "[mesh]\nsurface_cell = 1\nlevels = 1\n[regularisation]\npressure = 1e-3\n");
    std::get<FlowIncline>(scene.geometry).slope_deg = slope_deg;
    return judged(scene, jop);
  };
  const Judged resting = at(17), flowing = at(25);
  // mu_s p rate/sqrt(rate^2 + eps^2) carries tan(theta) p: 20 d at that rate.
  const double m = std::tan(17 * std::numbers::pi / 180) / 0.383;
  EXPECT_NEAR(resting.findings.closed_form->speed, 20 * 1e-5 * m / std::sqrt(1 - m * m), 2e-6);
  EXPECT_NEAR(resting.findings.eps_share, 1, 1e-6);
  EXPECT_TRUE(says(resting, "does not flow")) << sentence(resting);
  EXPECT_LT(flowing.findings.eps_share, 1e-3);
  EXPECT_EQ(sentence(flowing), "");
}

TEST(FlowLimits, ADrumThatTurnsMoreSlowlyThanEpsDoesNotFlow) {
  FlowScene scene = drum_scene(350, 1e-4, 1.5);
  scene.boundary->surface_stiffness = 1e8;
  const Judged flow = judged(scene, paper);
  EXPECT_GT(flow.findings.eps_share, 0.99);
  EXPECT_TRUE(says(flow, "does not flow")) << sentence(flow);
}

TEST(FlowReport, NamesNoSlopeOfRejectedSteps) {
  const double turn = 2 * std::numbers::pi;
  IterationReport line;
  line.theta = 0.4;
  EXPECT_EQ(slope_of(line), 0.4);
  line.rejected = true;
  EXPECT_FALSE(slope_of(line));
  line.rejected = false;
  line.theta = -1173 * turn;
  EXPECT_FALSE(slope_of(line));
  // Inertia finds no way into a drum that would centrifuge: its slope turns round and round.
  FlowScene fast = drum_scene(350, 300, 3);
  fast.effects.inertia.emplace();
  FlowObserver observer;
  int rejections = 0;
  observer.rejected = [&](const IterationReport& last) {
    ++rejections;
    EXPECT_TRUE(last.rejected && last.phase.starts_with("inertia")) << last.phase;
  };
  FlowSolverOptions options = solver_options(fast);
  options.max_iterations = 8;
  const FlowSolution solution = solve_flow(flow_case(fast, paper).problem, options, observer);
  EXPECT_GT(rejections, 0);
  int beyond = 0;
  for (const IterationReport& one : solution.report.history) {
    if (std::abs(one.theta) > 0.5 * std::numbers::pi) ++beyond;
    EXPECT_EQ(slope_of(one).has_value(), !one.rejected && std::abs(one.theta) < 0.5 * std::numbers::pi);
    EXPECT_TRUE(!one.rejected || one.phase.starts_with("inertia")) << one.phase;
  }
  EXPECT_GT(beyond, 0);
}

}  // namespace
}  // namespace drumlin::flow_limits
