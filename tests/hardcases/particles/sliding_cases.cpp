// Sliding and rolling of one disc.
#include <cmath>
#include <numbers>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

const char* const exact = "one contact is solved exactly; residual 1e-9";

/// Acceleration of a disc on a floor under gravity tilted by `slope_deg`.
double acceleration_on_incline(double slope_deg, double mu, bool spin = true) {
  TestScene trial =
      on_floor({{0, 0.5}}).with(Gravity{9.81, -90 + slope_deg}, Friction{mu, mu}).lasting(2, 1e-3);
  return bodies_at_end(spin ? trial.with(Spin{}) : trial).v_x[0] / 2;
}

std::vector<HardCheck> incline() {
  const double slope = std::numbers::pi / 9, steep = 4 * slope;  // tan = 0.364 and 5.67
  return {
      equals("acceleration, 20 deg, mu = 0.2 (rolls: 0.364 < 0.6)", 2.0 / 3 * std::sin(slope),
             acceleration_on_incline(20, 0.2), 1e-8, exact),
      equals("acceleration, 20 deg, mu = 0.1 (slips: 0.364 > 0.3)", std::sin(slope) - 0.1 * std::cos(slope),
             acceleration_on_incline(20, 0.1), 1e-8, exact),
      equals("acceleration, 80 deg, mu = 0", std::sin(steep), acceleration_on_incline(80, 0), 1e-7, exact),
      equals("acceleration, 80 deg, mu = 10 (rolls: 5.67 < 30)", 2.0 / 3 * std::sin(steep),
             acceleration_on_incline(80, 10), 1e-7, exact),
      equals("acceleration, 80 deg, mu = 10, no spin (sticks: 5.67 < 10)", 0,
             acceleration_on_incline(80, 10, false), 1e-7, exact)};
}

std::vector<HardCheck> slide_to_roll() {
  const double mu = 0.2, v0 = 1.5, h = 1e-3;
  TestRun run(scene_of({{0, 0.5, 1, v0}})
                  .between({floor_wall()})
                  .with(Gravity{}, Friction{mu, mu}, Spin{})
                  .lasting(4, h));
  double rolls_at = 0;
  run_watched(run, [&] {
    const Bodies& b = run.bodies();
    if (rolls_at == 0 && std::abs(b.v_x[0] - 0.5 * b.spin[0]) < 1e-9) rolls_at = run.time();
  });
  return {equals("time at which it rolls", v0 / (3 * mu), rolls_at, 2 * h, "known to a step"),
          equals("speed", 2.0 / 3 * v0, run.bodies().v_x[0], 1e-9, exact)};
}

}  // namespace

std::vector<HardCase> sliding_cases() {
  return {
      {"incline",
       "a disc rolls iff tan theta <= 3 mu, a = 2/3 g sin theta; else g (sin theta - mu cos theta)", true,
       incline},
      {"slide-to-roll", "v = 2/3 v0 at t = v0/(3 mu g)", true, slide_to_roll},
  };
}

}  // namespace drumlin
