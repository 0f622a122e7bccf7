// Nonlocal fluidity against its closed forms.
#include "continuum/fem/detail/fluidity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "given_flow.hpp"

namespace drumlin::fluidity_test {
using namespace continuum;
namespace {

using testing_given_flow::errors_on_three_meshes, testing_given_flow::GivenFlow;
using Function = std::function<double(Vec2)>;

std::vector<double> factor(const GivenFlow& flow, double length, const Function& local) {
  const auto g = flow.at_points(local);
  const fem::FluidityFactor found = fem::fluidity_factor(flow.problem, flow.d, length, g, 1e-10);
  std::vector<double> values = fem::at_quadrature(*found.ln_factor, flow.d);
  for (double& value : values) value = std::exp(value);
  return values;
}

Vec2 rest(Vec2) { return {}; }

TEST(NonlocalFluidity, OfAWaveIsTheWaveDamped) {
  // No flux through the sides: half a wave between them, along x and along z.
  const double length = 0.7, k = std::numbers::pi / 4;
  const Function wave = [=](Vec2 x) { return std::cos(k * (x.x + 2)) * std::cos(k * x.z); };
  const Function exact = [=](Vec2 x) {
    return (1 + 0.8 * wave(x)) / (1 + 0.8 * wave(x) / (1 + 2 * length * length * k * k));
  };
  const BoxDomain box{.width = 4, .height = 4, .cells_x = 8, .cells_z = 8};
  const auto errors = errors_on_three_meshes(box, rest, [&](const GivenFlow& flow) {
    return flow.error(factor(flow, length, [&](Vec2 x) { return 1 + 0.8 * wave(x); }), exact);
  });
  expect_orders(errors, {1.8, 1.8});
  EXPECT_LT(errors[2], 3e-3);
}

TEST(NonlocalFluidity, IsLocalForALengthOfNought) {
  const GivenFlow flow(ChordDomain{.radius = 6, .axis_offset = 0.5, .surface_cell = 1, .surface_zone = 2}, 0,
                       rest);
  for (const double value : factor(flow, 0, [](Vec2 x) { return std::exp(x.x + 2 * x.z); }))
    EXPECT_NEAR(value, 1, 1e-12);
}

TEST(NonlocalFluidity, StaysPositiveAndBoundedOverEightDecades) {
  // Cells of 1, hanging nodes; a length far below them and one above.
  const GivenFlow flow(ChordDomain{.radius = 6, .axis_offset = 0.5, .surface_cell = 1, .surface_zone = 2}, 0,
                       rest);
  const Function local = [](Vec2 x) { return x.z > -2 ? 1 : 1e-8; };
  for (const double length : {0.05, 2.0}) {
    const auto found = factor(flow, length, local);
    const auto [smallest, largest] = std::minmax_element(found.begin(), found.end());
    // g lies between the smallest and the largest g_loc.
    EXPECT_GE(*smallest, 1e-8) << length;
    EXPECT_LE(*largest, 1e8) << length;
  }
}

}  // namespace
}  // namespace drumlin::fluidity_test
