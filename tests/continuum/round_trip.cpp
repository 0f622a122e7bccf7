// A flow solved, sampled with noise, calibrated and solved again returns to itself.
#include <random>

#include "boxes.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "continuum/postprocessing/flow_maps.hpp"
#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/calibration/law_points.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin {
using namespace continuum;
using namespace coupling;
namespace {

using namespace testing_boxes;

const FrictionForm logarithm{.formula = LogLaw{}};
const Coefficients truth{0.35, 0.013};

FlowProblem problem(const Coefficients& law) {
  FlowProblem drum = small_drum_problem(LogLaw{law[0], law[1]}, 1e-4, small_drum());
  // The law is given p + p_min^2/p, which its reader cannot know.
  drum.regularisation.pressure = 0.05;
  return drum;
}

/// The maps of the flow as particles would have left them: every stress and gradient with an error of its
/// own.
FieldMap noisy_maps(const FlowField& field, double noise) {
  const DrumGeometry drum = small_drum();
  MapArea area;
  area.x_min = -drum.radius;
  area.x_max = drum.radius;
  area.z_min = drum.axis_offset - drum.radius;
  area.inside = [drum](Vec2 p) { return p.z < 0 && std::hypot(p.x, p.z - drum.axis_offset) < drum.radius; };
  area.nu = drum.nu;
  FieldMap maps = flow_map(field, area, 1);
  maps.header.drum_radius = drum.radius;
  maps.header.axis_depth = drum.axis_offset;
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1);
  for (MapField& of : maps.fields) {
    const bool stress = of.name.starts_with("sigma_"), gradient = of.name.starts_with("d_v_");
    if (!stress && !gradient) continue;
    const std::vector<double>& scale = maps.field(stress ? "p" : "strain_rate").value;
    for (std::size_t node = 0; node < of.value.size(); ++node) {
      const double error = noise * scale[node];
      of.value[node] += error * normal(random);
      of.ci99.push_back(2.576 * error);
    }
  }
  return maps;
}

TEST(RoundTrip, AFlowSampledWithNoiseAndCalibratedReturnsToItself) {
  const FlowField first = converged(problem(truth), one_mesh());
  const BlockSelection selection{
      .I_min = 1e-4, .I_max = 1, .width = 5, .surface_margin = 2, .wall_margin = 2};
  const CalibratedLaw law =
      calibrated({frictions(law_points(noisy_maps(first, 0.02), selection))}, logarithm, 100);
  for (const double I : {1e-3, 1e-2, 5e-2}) {
    const double off = friction(logarithm, law.fit.law, I) - friction(logarithm, truth, I);
    EXPECT_LE(std::abs(off), half_width_at(law, I) + 1e-3) << I;
  }
  const FlowField again = converged(problem(law.fit.law), one_mesh());
  // The slope follows mu: d theta = d mu cos^2 theta. Velocities follow exp(d mu/b).
  EXPECT_NEAR(again.theta(), first.theta(), 2 * half_width_at(law, 1e-2) + 1e-3);
  const ProfileSet before = drum_profiles(first, small_drum(), {}),
                   after = drum_profiles(again, small_drum(), {});
  double change = 0, size = 0;
  for (std::size_t layer = 0; layer < before.z.size(); ++layer) {
    const double v = before.column("v_x").value[layer], w = after.column("v_x").value[layer];
    if (!std::isfinite(v) || !std::isfinite(w)) continue;
    change += (w - v) * (w - v);
    size += v * v;
  }
  EXPECT_LT(std::sqrt(change / size), 0.1);
}

}  // namespace
}  // namespace drumlin
