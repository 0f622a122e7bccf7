// What programs of users call first: a scene to its end, and one contact problem from a matrix.
#include <gtest/gtest.h>

#include <stdexcept>

#include "coupling/core/basics/errors.hpp"
#include "particles/lab/matrix_problem.hpp"
#include "particles/lab/solve_contacts.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"
#include "tests/support/says.hpp"

namespace drumlin::particles {
namespace {

const std::string box = R"(format = "drumlin-scene-1"
title = "A box of discs"
grains.density_kg_m3 = 2700
grains.generated = { count = 12, diameter_min_mm = 1.8, diameter_max_mm = 2.2, region = { shape = "rectangle", min_mm = [0, 0], max_mm = [10, 20] } }
walls = [{ name = "box", shape = "polyline", x_mm = [0, 0, 10, 10], z_mm = [40, 0, 0, 40] }]
effects = { gravity = {}, friction = { grain_grain = 0.4, grain_wall = 0.4 }, spin = {} }
stages = [{ name = "fall", duration_s = 0.05, time_step_s = 1e-3 }]
)";

// A disc of mass 1 in a corner: floor and wall.
const std::vector<double> corner{1, 0, 0, 1, 0, 3, -1, 2, 0, -1, 1, 0, 1, 2, 0, 3},
    free_velocity{-1, 0.5, -0.5, -1};

TEST(RunThrough, EndsWithTheSceneOrWhereTheCallbackSaysSo) {
  Simulation whole(parse_scene(box, "box"));
  int calls = 0;
  run_through(whole, [&](const StepReport&) { return ++calls > 0; });
  EXPECT_TRUE(whole.finished());
  EXPECT_EQ(calls, 50);
  Simulation stopped(parse_scene(box, "box"));
  run_through(stopped, [&](const StepReport&) { return stopped.state().step < 7; });
  EXPECT_EQ(stopped.state().step, 7);
}

TEST(RunThrough, ThrowsWhereAStepMissesWhatItsSceneInsistsOn) {
  Simulation simulation(parse_scene(box, "box",
                                    {"solver.max_sweeps=1", "solver.check_every=1", "solver.tolerance=1e-14",
                                     "solver.stop_when_unconverged=true"}));
  try {
    run_through(simulation, [](const StepReport&) { return true; });
    FAIL() << "every step was solved to 1e-14 in one sweep";
  } catch (const NotConvergedError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("step ", 0), 0u) << error.what();
    expect_has(error.what(), "contact solver accelerated");
  }
}

TEST(MatrixProblem, IsSolvedThroughItsDiscAndJudgedByItsOwnResidual) {
  const BlockProblem problem = dense_problem(corner, free_velocity, {0.3, 0.3});
  StoppingRule rule;
  rule.tolerance = 1e-12;
  rule.max_sweeps = 100000;
  for (const char* solver : {"accelerated", "nlgs"}) {
    SolvedContacts solved = solve_contacts(problem, rule, solver);
    EXPECT_EQ(solved.report.status, Status::converged) << solver;
    EXPECT_LE(residual_of(problem, solved.solution).rms, 1e-12) << solver;
  }
  EXPECT_THROW((void)solve_contacts(problem, rule, "none"), InputError);
}

TEST(MatrixProblem, EndsAtOnceWhereItIsInterrupted) {
  StoppingRule rule;
  rule.tolerance = 0;
  rule.max_sweeps = 1000000;
  rule.max_seconds = 1e9;
  rule.interrupted = [] { return true; };
  const auto solved = solve_contacts(dense_problem(corner, free_velocity, {0.3, 0.3}), rule);
  EXPECT_EQ(solved.report.status, Status::out_of_time);
  EXPECT_LT(solved.report.sweeps, 1000);
}

TEST(MatrixProblem, RefusesWhatIsNone) {
  std::vector<double> askew = corner;
  askew[3] = 5;
  EXPECT_THROW((void)dense_problem(askew, free_velocity, {0.3, 0.3}), std::invalid_argument);
  EXPECT_THROW((void)dense_problem(corner, free_velocity, {0.3, -0.3}), std::invalid_argument);
  EXPECT_THROW((void)dense_problem(corner, free_velocity, {0.3}), std::invalid_argument);
  EXPECT_THROW((void)dense_problem({}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace drumlin::particles
