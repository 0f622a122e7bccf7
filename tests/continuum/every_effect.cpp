// What holds for every effect of the continuum, through a list of them, in a drum of 30 grains' width.
#include <algorithm>
#include <map>

#include "boxes.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "coupling/core/basics/errors.hpp"
#include "remembering.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::every_effect {
using namespace continuum;
using namespace testing_boxes;
namespace {

const DrumGeometry drum = small_drum();

struct Effect {
  const char* name;
  void (*add)(FlowProblem&);
  bool (*shows)(const FlowField&, const FlowField& plain);  ///< what it does
  double torque = 1e-4, power = 1e-3;                       ///< errors of the balances
  double theta = 1e-5, stress = 1e-5;                       ///< what another observer may see otherwise
  double again = 1e-7;                                      ///< and who starts from the flow itself
  int updates = 0;                                          ///< of what is held, at most
  int updates_again = 3;                                    ///< from the flow itself
  bool in_time = true;                                      ///< whether a march knows it
};
void PrintTo(const Effect& one, std::ostream* out) { *out << one.name; }

constexpr Vec2 places[] = {{0, -0.5}, {0, -3}, {5, -2}, {-6, -1}, {2, -9}};

bool turns_the_stress(const FlowField& field, const FlowField&) {
  return std::abs(state_at(field, {2, -9}).axis_angle) > 1 * degree;
}
bool turns_the_stress_a_little(const FlowField& field, const FlowField&) {
  return std::any_of(std::begin(places), std::end(places),
                     [&](Vec2 place) { return std::abs(state_at(field, place).axis_angle) > 0.1 * degree; });
}
bool moves_the_slope(const FlowField& field, const FlowField& plain) {
  return std::abs(field.theta() - plain.theta()) > 1e-5;
}

void add_threshold(FlowProblem& problem) {
  problem.inertia = Inertia{};
  problem.threshold_fluidity = ThresholdFluidity{0.5, 0.3};
}
void add_memory(FlowProblem& problem) {
  problem.inertia = Inertia{};
  problem.memory.emplace(testing_remembering::law);
}

const Effect effects[] = {
    {"none", [](FlowProblem&) {},
     [](const FlowField& field, const FlowField& plain) { return field.theta() == plain.theta(); }},
    {"inertia", [](FlowProblem& p) { p.inertia = Inertia{}; }, moves_the_slope},
    {.name = "k",
     .add =
         [](FlowProblem& p) {
           p.turned = NonCoaxialStress{.k = StressRatioLaw({1e-4, 1e-2, 1e-1}, {0.96, 1.03, 1.0})};
         },
     .shows = turns_the_stress_a_little,
     .stress = 1e-4,
     .updates = 20},
    {.name = "nonlocal",
     .add = [](FlowProblem& p) { p.nonlocal = NonlocalFluidity{1}; },
     .shows = moves_the_slope,
     .updates = 20,
     .updates_again = 4,
     .in_time = false},
    {.name = "threshold",
     .add = add_threshold,
     .shows =
         [](const FlowField& field, const FlowField&) {
           return state_at(field, {2, -9}).fluidity > 0;
         },
     .torque = 1e-2,
     .in_time = false},
    {.name = "memory",
     .add = add_memory,
     .shows = turns_the_stress,
     .torque = 1e-2,
     .stress = 1e-4,
     .again = 1e-4,
     .updates = 20,
     .in_time = false},
    {.name = "amount",
     .add =
         [](FlowProblem& p) {
           add_memory(p);
           p.memory->law.amount = testing_remembering::swelling;
         },
     .shows = moves_the_slope,
     .torque = 1e-2,
     .theta = 2e-5,
     .stress = 2e-4,
     .again = 1e-4,
     .updates = 25,
     .in_time = false},
    {.name = "threshold_and_memory",
     .add = [](FlowProblem& p) { add_memory(p), add_threshold(p); },
     .shows = turns_the_stress,
     .torque = 1e-2,
     .stress = 1e-4,
     .again = 1e-4,
     .updates = 20,
     .in_time = false},
    {.name = "moving_surface",
     .add =
         [](FlowProblem& p) {
           p.moving_surface = MovingSurface{.degree = 6,
                                            .tolerance = 0.03,
                                            .slope_half_length = 0.5 * drum.half_chord(),
                                            .wall_velocity = [](Vec2 point, Vec2 left, Vec2 right) {
                                              return entraining_wall_velocity(drum, 1, point, left, right);
                                            }};
         },
     .shows = [](const FlowField& field, const FlowField&) { return largest_height(*field.surface()) > 0.3; },
     .stress = 1e-4},
};

FlowProblem with(const Effect& effect) {
  FlowProblem problem = small_drum_problem();
  effect.add(problem);
  return problem;
}

FlowSolverOptions options_of(const Effect& effect) {
  FlowSolverOptions options = one_mesh();
  if (effect.name == std::string("k")) options.picard_tolerance = 1e-6;
  return options;
}

/// The flow with each effect alone, solved once.
std::map<std::string, FlowSolution> flows;

const FlowSolution& solved(const Effect& effect) {
  const auto found = flows.find(effect.name);
  if (found != flows.end()) return found->second;
  return flows.emplace(effect.name, ended(solve_flow(with(effect), options_of(effect)))).first->second;
}

class EveryFlowEffect : public ::testing::TestWithParam<Effect> {
 protected:
  static void TearDownTestSuite() { flows.clear(); }  // while MPI lives
  const FlowSolution& flow = solved(GetParam());
};

TEST_P(EveryFlowEffect, KeepsTheBalancesAndDoesSomething) {
  const FlowField& field = flow.field;
  const ScalarSet checks = drum_checks(field, drum);
  EXPECT_NEAR(checks.value("Q_relative_error"), 0, 1e-3);
  EXPECT_NEAR(checks.value("torque_relative_error"), 0, GetParam().torque);
  EXPECT_NEAR(checks.value("power_relative_error"), 0, GetParam().power);
  EXPECT_GT(checks.value("dissipation"), 0);
  EXPECT_EQ(field.integrals().ill_posed_area, 0);
  EXPECT_TRUE(GetParam().shows(field, solved(effects[0]).field));
  if (GetParam().updates == 0) return;
  EXPECT_GT(flow.report.picard_updates, 1);
  EXPECT_LE(flow.report.picard_updates, GetParam().updates);
  EXPECT_LT(flow.report.picard_change, options_of(GetParam()).picard_tolerance);
}

TEST_P(EveryFlowEffect, IsTheSameForAnObserverThatTurns) {
  FlowProblem turning = with(GetParam());
  turning.frame = RotatingFrame{drum.rotation, drum.axis_offset};
  const FlowField seen = converged(turning, options_of(GetParam()));
  const auto [theta, stress] = std::pair(GetParam().theta, GetParam().stress);
  EXPECT_NEAR(seen.theta(), flow.field.theta(), theta);
  for (const Vec2 place : places) {
    const PointState here = state_at(flow.field, place), there = state_at(seen, place);
    EXPECT_NEAR(here.velocity.x, there.velocity.x, theta);
    EXPECT_NEAR(here.velocity.z, there.velocity.z, theta);
    EXPECT_NEAR(here.sigma_xx, there.sigma_xx, stress);
    EXPECT_NEAR(here.sigma_xz, there.sigma_xz, stress);
    EXPECT_NEAR(here.axis_angle, there.axis_angle, stress);
  }
  if (seen.surface()) {
    EXPECT_NEAR(height(*seen.surface(), 3), height(*flow.field.surface(), 3), stress);
  }
}

TEST_P(EveryFlowEffect, StaysWhereItStartsFromItself) {
  const FlowState state = flow.field.state();  // velocity and pressure say all
  EXPECT_EQ(state.values.size(), FlowState::values_per_cell * state.cells.size());
  const FlowSolution again = ended(solve_flow_from(state, with(GetParam()), options_of(GetParam())));
  EXPECT_EQ(again.report.start, "neighbour");
  EXPECT_LE(again.report.picard_updates, GetParam().updates_again);
  if (GetParam().updates == 0) {
    EXPECT_LE(again.report.iterations, 2);
  }
  EXPECT_NEAR(again.field.theta(), flow.field.theta(), GetParam().again);
  const PointState here = state_at(flow.field, {2, -9}), there = state_at(again.field, {2, -9});
  EXPECT_NEAR(there.velocity.x, here.velocity.x, 10 * GetParam().again);
  if (here.fluidity > 0) {
    EXPECT_NEAR(there.fluidity / here.fluidity, 1, std::max(1e-5, GetParam().again));
  }
}

TEST_P(EveryFlowEffect, IsRefusedInTimeWhereAStateDoesNotHoldIt) {
  const FlowMarch march{.time_step = 1, .steps = 1};
  const FlowField rest = flow_at_rest(small_drum_problem(), one_mesh());
  const auto marches = [&] { (void)march_flow(rest, with(GetParam()), march, one_mesh()); };
  if (GetParam().in_time)
    EXPECT_NO_THROW(marches());
  else
    EXPECT_THROW(marches(), InputError);
}

/// What Newton's method holds for a flow: unknowns, entries of its matrix.
std::pair<int, std::size_t> system_of(const FlowField& field) {
  const fem::SolvedLevel& level = field.level();
  fem::System system(*level.discretisation);
  assemble_tangent(level.problem, *level.discretisation, level.setting, level.state, system);
  return {field.unknowns(), static_cast<std::size_t>(system.matrix.n_nonzero_elements())};
}

/// Terms stand within the same entries, and what is held lies beside the matrix; the fluidity of a threshold
/// is an unknown.
TEST_P(EveryFlowEffect, HoldsItsOwnFieldsAndNoUnknownOfAnother) {
  const FlowProblem problem = with(GetParam());
  const fem::SolvedLevel& level = flow.field.level();
  const auto& held = level.state.held;
  EXPECT_EQ(level.setting.inertia.has_value(), problem.inertia.has_value());
  EXPECT_EQ(level.discretisation->surface.has_value(), problem.moving_surface.has_value());
  EXPECT_EQ(level.discretisation->has_fluidity(), problem.threshold_fluidity.has_value());
  EXPECT_EQ(flow.field.has_fluidity(), problem.threshold_fluidity.has_value());
  EXPECT_EQ(held && held->turning, problem.turned.has_value());
  EXPECT_EQ(held && held->ln_fluidity, problem.nonlocal.has_value());
  EXPECT_EQ(held && held->axes, problem.memory.has_value());
  EXPECT_EQ(held && held->rho, problem.memory.has_value());
  EXPECT_EQ(held == nullptr, GetParam().updates == 0);
  if (!problem.threshold_fluidity) {
    EXPECT_EQ(system_of(flow.field), system_of(solved(effects[0]).field));
  }
}

INSTANTIATE_TEST_SUITE_P(Drum, EveryFlowEffect, ::testing::ValuesIn(effects),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace drumlin::every_effect
