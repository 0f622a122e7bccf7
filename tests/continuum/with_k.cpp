// The law with k in the finite elements: layers that can be written down.
#include "boxes.hpp"
#include "continuum/reference/closed_forms.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::with_k {
using namespace continuum;
namespace {

using namespace testing_boxes;

const LogLaw paper{0.35, 0.013};

NonCoaxialStress some_k() { return {.k = StressRatioLaw({1e-3, 1e-1}, {0.93, 1.07})}; }

TEST(PlaneShearWithK, CarriesExactlyKAndTheSameRate) {
  const double P = 4, mu = 0.2901;
  FlowProblem problem = strip(10, 4, paper, constant_traction(mu * P, -P));
  problem.turned = some_k();
  problem.regularisation = {.shear_rate = 1e-7, .pressure = 1e-4};
  FlowSolverOptions options = one_mesh();
  options.tolerance = 1e-11;
  const FlowField field = converged(problem, options);
  const double rate = plane_shear_rate(StressLaw(paper), P, mu * P);
  for (const double z : {-9.0, -5.0, -0.5}) {
    const PointState s = state_at(field, {0.1, z});
    // Uniform, hence exact on any mesh; p_min^2/p^2 = 1e-9 moves mu, that over b = 1e-7 the rate.
    EXPECT_NEAR(s.dvx_dz / rate, 1, 1e-6);
    EXPECT_NEAR(s.sigma_zz, P, 1e-8);
    EXPECT_NEAR(s.sigma_xz, mu * P, 1e-8);
    const double k = some_k().k.at_ln(std::log(s.dvx_dz / std::sqrt(P))).value;
    EXPECT_NEAR(s.sigma_xx / s.sigma_zz, k, 1e-7);
    EXPECT_NEAR(s.k, k, 1e-7);
    EXPECT_NEAR(std::tan(2 * s.axis_angle), (k - 1) / (2 * mu), 1e-6);
  }
}

TEST(SmallDrumWithK, IsSolvedWithoutItFirst) {
  FlowProblem problem = small_drum_problem();
  problem.turned = NonCoaxialStress{.k = StressRatioLaw({1e-4, 1e-2, 1e-1}, {0.96, 1.03, 1.0})};
  int seen = 0;
  double theta_without = 0;
  FlowObserver observer;
  observer.solved_plain = [&](const FlowField& field) {
    ++seen;
    theta_without = field.theta();
  };
  const FlowField field = converged(problem, one_mesh(), observer);
  EXPECT_EQ(seen, 1);
  // k within 4 % of one turns the stress by up to 3 degrees but hardly moves the slope.
  EXPECT_NEAR(field.theta(), theta_without, 0.5 * degree);
}

}  // namespace
}  // namespace drumlin::with_k
