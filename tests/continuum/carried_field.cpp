// What the material carries along and forgets, in velocities that are given.
#include "continuum/fem/detail/carried_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "given_flow.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using testing_given_flow::errors_on_three_meshes, testing_given_flow::GivenFlow, testing_given_flow::ring;
using testing_given_flow::TwoObservers;
using Function = std::function<double(Vec2)>;

struct Carried {
  std::vector<double> values;
  double overshoot = 0;
};

Carried carried(const GivenFlow& flow, const Function& rate, const Function& target) {
  const auto rates = flow.at_points(rate), targets = flow.at_points(target);
  const fem::CarriedField found =
      fem::carried_by_flow(flow.problem, flow.d, flow.solution, {rates, targets}, 1e-8);
  return {fem::at_quadrature(*found.field, flow.d), found.overshoot};
}

constexpr auto everywhere = [](double value) { return [value](Vec2) { return value; }; };

TEST(CarriedField, ForgetsAlongItsWayExponentially) {
  // Enters without any; from x = 0 on it tends to one over a length of 1/0.7.
  const double rate = 0.7;
  const Function target = [](Vec2 x) { return x.x > 0 ? 1.0 : 0.0; };
  const Function exact = [&](Vec2 x) { return x.x > 0 ? 1 - std::exp(-rate * x.x) : 0; };
  const BoxDomain box{.width = 8, .height = 2, .cells_x = 8, .cells_z = 2};
  const auto along = [](Vec2) { return Vec2{1, 0}; };
  const auto errors = errors_on_three_meshes(box, along, [&](const GivenFlow& flow) {
    const Carried found = carried(flow, everywhere(rate), target);
    EXPECT_EQ(found.overshoot, 0);
    return flow.error(found.values, exact);
  });
  expect_orders(errors, {1.8, 1.9});
  EXPECT_LT(errors[2], 1e-3);
}

TEST(CarriedField, LagsBehindItsTargetOnClosedWays) {
  // Rigid rotation: b = A cos + B sin of the angle, with the amplitude and the lag of a relaxation.
  const double Omega = 0.5;
  for (const double rate : {1.0, 0.05}) {
    const double A = rate * rate / (rate * rate + Omega * Omega),
                 B = -Omega * rate / (rate * rate + Omega * Omega);
    const auto turning = [=](Vec2 x) { return rigid_rotation(Omega, 0, x); };
    const auto errors = errors_on_three_meshes(ring, turning, [&](const GivenFlow& flow) {
      const Carried found =
          carried(flow, everywhere(rate), [](Vec2 x) { return x.x / std::hypot(x.x, x.z); });
      return flow.error(found.values, [=](Vec2 x) { return (A * x.x + B * x.z) / std::hypot(x.x, x.z); });
    });
    expect_orders(errors, {1.7, 1.8});
    EXPECT_LT(errors[2], 4e-3) << rate;
  }
}

TEST(CarriedField, IsTheMeanOverTheWayWhereHardlyAnythingRelaxes) {
  // As in the rigid part of a drum: ten thousand turns to forget. The targets are r plus what has no mean.
  const double Omega = 0.5, rate = 1e-4 * Omega / (2 * std::numbers::pi);
  const AnnulusDomain fine{.inner_radius = 2, .layers = {0.5, 0.5, 0.5, 0.5}, .cells_around = 32};
  const auto turning = [=](Vec2 x) { return rigid_rotation(Omega, 0, x); };
  const auto errors = errors_on_three_meshes(fine, turning, [&](const GivenFlow& flow) {
    const Carried found = carried(flow, everywhere(rate),
                                  [](Vec2 x) { return std::hypot(x.x, x.z) + x.x / std::hypot(x.x, x.z); });
    return flow.error(found.values, [](Vec2 x) { return std::hypot(x.x, x.z); });
  });
  // What each turn mixes across the ways, of third order, meets next to no relaxation: 1 % on the last mesh.
  expect_orders(errors, {1.4, 1.4});
  EXPECT_LT(errors[2], 0.015);
}

TEST(CarriedField, StaysWithinItsTargetsAndWhereTheyAreOne) {
  // Vortices askew to the mesh, hanging nodes, targets that jump.
  const auto velocity = [](Vec2 x) {
    return Vec2{std::sin(x.x) * std::cos(x.z), -std::cos(x.x) * std::sin(x.z)};
  };
  GivenFlow flow(ChordDomain{.radius = 6, .axis_offset = 0.5, .surface_cell = 1, .surface_zone = 2}, 0,
                 velocity);
  const Function rate = [](Vec2 x) { return x.z > -2 ? 1 : 1e-4; };
  const Carried jumps = carried(flow, rate, [](Vec2 x) { return x.x + 0.3 * x.z > 0 ? 1.0 : -0.5; });
  EXPECT_LE(*std::max_element(jumps.values.begin(), jumps.values.end()), 1 + 1e-12);
  EXPECT_GE(*std::min_element(jumps.values.begin(), jumps.values.end()), -0.5 - 1e-12);
  EXPECT_GT(jumps.overshoot, 0);  // so that something was to be brought back
  // The same everywhere, though the elements leave some div v and let some material through the sides.
  EXPECT_LT(flow.error(carried(flow, rate, everywhere(0.3)).values, everywhere(0.3)), 1e-10);
}

TEST(CarriedField, IsTheSameForATurningObserver) {
  const TwoObservers observers;
  const Function target = [](Vec2 x) { return x.x + std::sin(x.z); };
  const auto here = carried(observers.laboratory, everywhere(0.2), target).values,
             there = carried(observers.turning, everywhere(0.2), target).values;
  for (std::size_t q = 0; q < here.size(); ++q) EXPECT_NEAR(here[q], there[q], 1e-9);
}

}  // namespace
}  // namespace drumlin
