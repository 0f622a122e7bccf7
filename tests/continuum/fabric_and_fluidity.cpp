// Fabric that the material carries along and fluidity that spreads, in whole flows.
#include "boxes.hpp"
#include "continuum/fem/detail/carried_field.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/sampling/drum_profiles.hpp"
#include "coupling/common/errors.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;

const LogLaw paper{0.35, 0.013};

FlowSolverOptions options_of(int levels, double held_tolerance) {
  FlowSolverOptions options;
  options.levels = levels;
  options.picard_tolerance = held_tolerance;
  return options;
}

// A layer under the pressure P whose body force makes g_loc = G (1 + 0.8 cos(k z)): its stress is known, and
// with it g.
struct WavyLayer {
  double P = 4, H = 8, G = 0.07, k = std::numbers::pi / 8;

  double local_fluidity(double z) const { return G * (1 + 0.8 * std::cos(k * z)); }
  double fluidity(double z, double length) const {
    return G * (1 + 0.8 * std::cos(k * z) / (1 + length * length * k * k));
  }
  /// mu at which the local law has that fluidity.
  double mu(double z) const {
    double low = -30, high = 3;  // ln I
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high), I = std::exp(middle);
      (I * std::sqrt(P) / paper.friction(I).mu < local_fluidity(z) ? low : high) = middle;
    }
    return paper.friction(std::exp(low)).mu;
  }
  FlowProblem problem(double length) const {
    FlowProblem layer = strip(H, 8, paper, constant_traction(mu(0) * P, -P));
    layer.regularisation = {.shear_rate = 1e-6, .pressure = 1e-4};
    layer.nonlocal = NonlocalFluidity{length};
    layer.extra_force = [*this](Vec2 x) {
      const double h = 1e-3;
      return Vec2{-P * (mu(x.z + h) - mu(x.z - h)) / (2 * h), 0};
    };
    return layer;
  }
};

TEST(NonlocalFlow, OfAGivenStressHasTheFluidityOfTheClosedForm) {
  const WavyLayer layer;
  const double length = 1.5;
  std::vector<double> errors;
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) {
    double sum = 0;
    int points = 0;
    for (double z = -7.9; z < 0; z += 0.2, ++points) {
      const double rate = state_at(field, {0.1, z}).dvx_dz;
      sum += std::pow(rate / (layer.mu(z) * layer.fluidity(z, length)) - 1, 2);
    }
    errors.push_back(std::sqrt(sum / points));
  };
  (void)converged(layer.problem(length), options_of(3, 1e-6), observer);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.7);
  EXPECT_LT(errors[2], 5e-3);
  // Left out, it would be off by a quarter where g_loc is least.
  const double z = -layer.H;
  EXPECT_LT(layer.local_fluidity(z) / layer.fluidity(z, length), 0.75);
}

const std::vector<Vec2> places = {{0, -0.5}, {0, -3}, {5, -2}, {-6, -1}, {2, -9}};

double distance(const FlowField& a, const FlowField& b) {
  const auto here = a.at(places), there = b.at(places);
  double sum = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    sum += std::pow(here[i].velocity.x - there[i].velocity.x, 2) +
           std::pow(here[i].velocity.z - there[i].velocity.z, 2);
  return std::sqrt(sum);
}

TEST(NonlocalFlow, TendsToTheLocalOneWithTheSquareOfItsLength) {
  const auto drum_with = [](double length) {
    FlowProblem problem = small_drum_problem(paper);
    if (length > 0) problem.nonlocal = NonlocalFluidity{length};
    return converged(problem, options_of(1, 1e-6));
  };
  const FlowField local = drum_with(0);
  const double near = distance(drum_with(0.25), local), far = distance(drum_with(0.5), local);
  EXPECT_GT(near, 1e-4);
  EXPECT_NEAR(far / near, 4, 0.8);
}

void expect_balances(const FlowField& field) {
  const FlowIntegrals sums = field.integrals({0, small_drum().axis_offset});
  EXPECT_NEAR(discharge(field, small_drum()) / small_drum().expected_Q(), 1, 1e-3);
  EXPECT_NEAR(sums.given_side_torque / sums.weight_torque, -1, 1e-4);
  EXPECT_NEAR(sums.dissipation / (sums.given_side_power + sums.weight_power), 1, 1e-3);
}

FlowProblem drum_with_fabric(std::optional<double> relaxation) {
  FlowProblem problem = small_drum_problem(paper);
  problem.turned = TurnedStress{.k = StressRatioLaw({1e-3, 1}, {0.92, 1.06})};
  if (relaxation) problem.turned->fabric = CarriedFabric{*relaxation};
  return problem;
}

TEST(CarriedFabric, TendsToTheLocalOneTheFasterItIsRenewed) {
  const FlowField field = converged(drum_with_fabric({}), options_of(1, 1e-4));
  const auto& level = field.level();
  const auto& d = *level.discretisation;
  const auto lag = [&](double relaxation) {
    const auto local =
        fem::fabric_sources(level.problem, d, level.state, level.state.held_values().turn, relaxation);
    const auto carried =
        fem::carried_by_flow(level.problem, d, level.state.solution, {local.rate, local.target}, 1e-8);
    const auto beta = fem::at_quadrature(*carried.field, d);
    double change = 0, size = 0;
    for (std::size_t q = 0; q < beta.size(); ++q) {
      change += std::pow(beta[q] - local.target[q], 2);
      size += std::pow(local.target[q], 2);
    }
    return std::sqrt(d.sum(change) / d.sum(size));
  };
  const double slow = lag(1), fast = lag(100), at_once = lag(1e4);
  EXPECT_LT(fast, 0.3 * slow);
  EXPECT_LT(at_once, fast);
  EXPECT_LT(at_once, 0.15);  // cells of 2 d do not hold the jumps of the turn
}

TEST(CarriedFabric, ChangesAlongItsWayAsItIsRenewed) {
  const double c = 0.5, h = 0.5;
  const FlowProblem problem = drum_with_fabric(c);
  const FlowField field = converged(problem, options_of(2, 1e-4));
  expect_balances(field);
  // v.grad k = -c gammadot (k - k_ss), to first order in k - k_ss, in simple shear: below the middle of the
  // surface, where beta is carried with one sign.
  double misfit = 0, size = 0;
  for (const double z : {-3.0, -3.5, -4.0, -4.5, -5.0}) {
    const auto k_at = [&](double dx, double dz) { return state_at(field, {dx, z + dz}).k; };
    const PointState here = state_at(field, {0, z});
    const double k_ss = problem.turned->k.at_ln(std::log(2 * here.rate / std::sqrt(here.law_pressure))).value;
    const double carried =
        (here.velocity.x * (k_at(h, 0) - k_at(-h, 0)) + here.velocity.z * (k_at(0, h) - k_at(0, -h))) /
        (2 * h);
    const double renewed = -c * 2 * here.rate * (here.k - k_ss);
    misfit += std::pow(carried - renewed, 2);
    size += std::pow(renewed, 2);
  }
  EXPECT_GT(std::sqrt(size), 5e-4);
  EXPECT_LT(std::sqrt(misfit / size), 0.15);
}

TEST(CarriedFabric, AndNonlocalFluidityAreRefusedInTime) {
  const FlowField rest = flow_at_rest(small_drum_problem(paper), options_of(1, 1e-3));
  FlowProblem nonlocal = small_drum_problem(paper);
  nonlocal.nonlocal = NonlocalFluidity{1};
  EXPECT_THROW((void)march_flow(rest, nonlocal, {.time_step = 1, .steps = 1}), InputError);
  EXPECT_THROW((void)march_flow(rest, drum_with_fabric(1), {.time_step = 1, .steps = 1}), InputError);
}

}  // namespace
}  // namespace drumlin
