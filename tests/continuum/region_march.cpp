// Flows with a free surface through time.
#include "continuum/fem/region_march.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "continuum/fem/runtime.hpp"
#include "continuum/io/region_state_file.hpp"
#include "continuum/model/outline.hpp"
#include "continuum/model/region_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin::region_march_test {
using namespace continuum;
namespace {

constexpr double right_angle = 1.5707963267948966, nu = 0.8;
const JopLaw lagree{.mu_s = 0.32, .mu_2 = 0.6, .I_0 = 0.4};

RegionPart wall(const char* name, Vec2 from, Vec2 to, RegionPart::Kind kind = RegionPart::Kind::rough) {
  return {.name = name, .curve = SegmentCurve{from, to}, .kind = kind};
}
RegionPart smooth(const char* name, Vec2 from, Vec2 to) {
  return wall(name, from, to, RegionPart::Kind::friction);
}
RegionPart opening(Vec2 from, Vec2 to) { return wall("slot", from, to, RegionPart::Kind::opening); }

std::vector<Vec2> box(double width, double height) {
  return {{0, 0}, {width, 0}, {width, height}, {0, height}};
}

RegionMarch plan(Region region, double cell, double step, double end, const StressLaw& law = lagree) {
  RegionMarch march;
  march.region = std::move(region);
  march.problem.law = law;
  march.problem.density = nu;
  march.problem.regularisation = {1e-4, 0.3};
  march.problem.slope = FixedSlope{0};
  march.size = [cell](Vec2) { return cell; };
  march.step = step;
  march.end = end;
  return march;
}

// A column beside a plane of symmetry.
RegionMarch column(double width, double height, double cell, double end, const StressLaw& law = lagree) {
  return plan({.parts = {wall("floor", {-5, 0}, {500, 0}), smooth("middle", {0, -5}, {0, 100})},
               .fill = box(width, height)},
              cell, 0.25, end, law);
}

struct Flow {
  RegionState state;
  FlowReport report;
  std::vector<RegionStep> steps;

  double energy_error() const { return std::abs(state.totals.energy_error) / state.totals.weight_work; }
  double fastest() const {
    double speed = 0;
    for (const auto& step : steps) speed = std::max(speed, step.fastest);
    return speed;
  }
  Outline outline() const { return outlines_of(state.mesh).front(); }
  double height() const {
    double z = 0;
    for (const Vec2& x : state.mesh.vertices) z = std::max(z, x.z);
    return z;
  }
  double front() const {
    double x = 0;
    for (const Vec2& at : state.mesh.vertices) x = std::max(x, at.x);
    return x;
  }
};

Flow gone_on(const RegionMarch& march, RegionState state, const FlowSolverOptions& options = {}) {
  Flow flow{.state = std::move(state), .report = {}, .steps = {}};
  RegionObserver observer;
  observer.stepped = [&](const RegionStep& step) { flow.steps.push_back(step); };
  flow.report = march_region(march, flow.state, options, observer);
  return flow;
}

// From the fill to the end; the mass is kept.
Flow ended(const RegionMarch& march) {
  Flow flow = gone_on(march, filled(march));
  EXPECT_TRUE(flow.report.converged) << flow.report.failure;
  EXPECT_LT(flow.state.totals.mass_error, 1e-3);
  return flow;
}

TEST(RegionFlow, OfAFullBoxIsAtRest) {
  RegionMarch march = plan({.parts = {wall("floor", {0, 0}, {20, 0}), smooth("left", {0, 0}, {0, 20}),
                                      smooth("right", {20, 0}, {20, 20})},
                            .fill = box(20, 10)},
                           3, 2, 20);
  const Flow flow = ended(march);
  const std::vector<Vec2>& loads = flow.steps.back().loads;
  EXPECT_NEAR(loads[0].z / (-nu * 200), 1, 1e-6);
  EXPECT_NEAR(loads[1].x / (-nu * 50), 1, 1e-6);
  EXPECT_NEAR(loads[2].x / (nu * 50), 1, 1e-6);
  EXPECT_LT(flow.fastest(), 1e-8);
  EXPECT_NEAR(flow.height(), 10, 1e-7);
}

// Nothing shears: the law has no say, and the implicit Euler method has u = g t exactly.
TEST(RegionFlow, OfABlockFallsFreely) {
  const RegionMarch free = plan({.parts = {}, .fill = box(8, 6)}, 3, 0.5, 5);
  RegionMarch between = plan(
      {.parts = {smooth("left", {0, -50}, {0, 50}), smooth("right", {8, -50}, {8, 50})}, .fill = box(8, 6)},
      3, 0.5, 5);
  RegionMarch along_incline = between;
  along_incline.region.parts = {smooth("below", {-50, 0}, {50, 0}), smooth("above", {-50, 6}, {50, 6})};
  along_incline.problem.slope = FixedSlope{right_angle};
  for (const RegionMarch& march : {free, between, along_incline}) {
    const Flow flow = ended(march);
    const bool sideways = std::get<FixedSlope>(march.problem.slope).theta != 0;
    for (const PointState& at : flow_of(march, flow.state).at(flow.state.mesh.vertices)) {
      EXPECT_NEAR(at.velocity.x, sideways ? 5 : 0, 1e-6);
      EXPECT_NEAR(at.velocity.z, sideways ? 0 : -5, 1e-6);
    }
    EXPECT_NEAR(area(flow.outline()), 48, 1e-6);
  }
}

// Material in the air, which still moves as a column that spreads: a uniform weight deforms nothing, to the
// first order of the step.
TEST(RegionFlow, OfAFreeBodyDeformsInTheSameWayWhicheverWayItFalls) {
  const RegionMarch spreads = column(8, 6, 2, 2);
  RegionState start = ended(spreads).state;
  for (auto& edge : start.mesh.boundary) edge.part = Outline::free;
  start.time = 0;
  start.rates.clear(), start.corner_rates.clear();  // those of another weight
  const auto falls = [&](double direction) {
    RegionMarch march = plan({.parts = {}, .fill = box(8, 6)}, 2, 0.02, 1);
    march.problem.slope = FixedSlope{direction};
    Flow flow = gone_on(march, start);
    EXPECT_TRUE(flow.report.converged) << flow.report.failure;
    return flow;
  };
  const Flow one = falls(0), two = falls(right_angle);
  const auto& x = one.state.mesh.vertices;
  const auto& y = two.state.mesh.vertices;
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i].x - x[0].x, y[i].x - y[0].x, 0.02);
    EXPECT_NEAR(x[i].z - x[0].z, y[i].z - y[0].z, 0.02);
  }
}

// Hardly any friction: weight becomes motion. What passes the surface, which follows the material in the mean
// over its sides, is an error of the cells.
TEST(RegionFlow, OfAFluidThatSloshesKeepsItsEnergy) {
  const auto error = [](double cell, double step) {
    const RegionMarch march =
        plan({.parts = {smooth("floor", {-5, 0}, {17, 0}), smooth("left", {0, -5}, {0, 50}),
                        smooth("right", {12, -5}, {12, 50})},
              .fill = {{0, 0}, {12, 0}, {12, 5}, {0, 7}}},
             cell, step, 3, NewtonianLaw{1e-3});
    return ended(march).energy_error();
  };
  const double fine = error(1, 0.125);
  EXPECT_LT(fine, 0.5 * error(2, 0.25));
  EXPECT_LT(fine, 6e-3);
}

TEST(RegionFlow, OfAColumnKeepsItsMassAndItsEnergy) {
  const Flow flow = ended(column(20, 10, 2, 8));
  EXPECT_LT(flow.energy_error(), 0.1);
  EXPECT_GT(flow.front(), 25);
}

RegionMarch silo(double slot, double cell, double end) {
  return plan({.parts = {wall("floor left", {0, 0}, {10 - slot / 2, 0}),
                         wall("floor right", {10 + slot / 2, 0}, {20, 0}),
                         opening({10 - slot / 2, 0}, {10 + slot / 2, 0}), smooth("left", {0, 0}, {0, 40}),
                         smooth("right", {20, 0}, {20, 40})},
               .fill = box(20, 20)},
              cell, 0.5, end);
}

TEST(RegionFlow, OfASiloKeepsItsMassAndItsEnergy) {
  const Flow flow = ended(silo(8, 2.5, 4));
  EXPECT_GT(flow.state.discharged, 10);
  EXPECT_LT(flow.energy_error(), 0.1);
}

TEST(RegionFlow, GoesOnFromAFileToTheLastBit) {
  const testing::TemporaryFolder folder;
  const RegionMarch whole = column(12, 6, 2.5, 6);
  RegionMarch half = whole;
  half.end = 3;
  const Flow middle = ended(half);
  write_region_state(folder / "a.h5",
                     {.state = middle.state, .step = middle.steps.back(), .scene = "", .law = ""});
  const Flow one = gone_on(whole, middle.state),
             two = gone_on(whole, read_region_state(folder / "a.h5").state);
  EXPECT_TRUE(one.report.converged && two.report.converged);
  EXPECT_EQ(one.state.values, two.state.values);
  EXPECT_EQ(one.state.time, two.state.time);
  EXPECT_EQ(one.state.totals.energy_error, two.state.totals.energy_error);
  EXPECT_EQ(0, std::memcmp(one.state.mesh.vertices.data(), two.state.mesh.vertices.data(),
                           one.state.mesh.vertices.size() * sizeof(Vec2)));
}

// One that recedes at first faster than the material falls is met again, not passed.
TEST(RegionFlow, FollowsAGateThatLeaves) {
  const auto front = [](Vec2 velocity, double ends) {
    RegionMarch march = column(12, 8, 2, 6);
    RegionPart gate = smooth("gate", {12, 0}, {12, 20});
    gate.velocity = velocity;
    gate.begins = 1;
    gate.ends = ends;
    march.region.parts.push_back(gate);
    return ended(march).front();
  };
  constexpr double stays = INFINITY;
  EXPECT_GT(front({}, 1), 15);                      // leaves at once
  EXPECT_NEAR(front({0.3, 0}, stays), 13.5, 1e-9);  // the material lags, then follows it to where it is
  EXPECT_GT(front({0, 1}, stays), 12.5);            // rises
}

TEST(RegionFlow, OfASlotNarrowerThanThreeCells) { ended(silo(4, 3, 2)); }

// The surface comes down to the slot, and two heaps are left that stand for themselves.
TEST(RegionFlow, OfASiloThatBreaksInTwo) {
  RegionMarch march = silo(8, 2, 5);
  march.region.fill = box(20, 5);
  march.step = 0.2;
  const Flow flow = ended(march);
  const std::vector<Outline> heaps = outlines_of(flow.state.mesh);
  ASSERT_EQ(heaps.size(), 2u);
  EXPECT_NEAR(area(heaps[0]) / area(heaps[1]), 1, 0.05);
  EXPECT_NEAR(area(heaps[0]) + area(heaps[1]), flow.state.area, 0.1);
  EXPECT_NEAR(flow.state.area + flow.state.discharged, 100, 1e-9);
}

// At mu_s = 1 the corner of the column pulls: it takes a larger p_min than others, and stands.
TEST(RegionFlow, WithoutFrictionAndWithMuch) {
  EXPECT_GT(ended(column(16, 8, 2, 4, JopLaw{.mu_s = 0, .mu_2 = 0.3, .I_0 = 0.4})).front(), 20);
  RegionMarch stands = column(16, 8, 2, 4, JopLaw{.mu_s = 1, .mu_2 = 1.3, .I_0 = 0.4});
  stands.problem.regularisation = {1e-3, 1};
  const Flow flow = ended(stands);
  EXPECT_LT(flow.fastest(), 0.01);
  EXPECT_NEAR(flow.height(), 8, 0.01);
}

TEST(RegionFlow, OfColumnsLowAndHigh) {
  EXPECT_GT(ended(column(40, 10, 4, 3)).front(), 41);  // a = 0.25
  EXPECT_LT(ended(column(4, 40, 2, 2)).height(), 39);  // a = 10
}

TEST(RegionFlow, DoesNotDependOnTheAxes) {
  const RegionMarch upright = column(12, 8, 2, 4);
  RegionMarch turned = upright;
  const double c = std::cos(0.7), s = std::sin(0.7);
  const auto turn = [&](Vec2 x) { return Vec2{c * x.x - s * x.z, s * x.x + c * x.z}; };
  for (RegionPart& part : turned.region.parts) {
    auto& segment = std::get<SegmentCurve>(part.curve);
    segment = {turn(segment.from), turn(segment.to)};
  }
  for (Vec2& x : turned.region.fill) x = turn(x);
  turned.problem.slope = FixedSlope{0.7};
  const Flow one = ended(upright), two = ended(turned);
  EXPECT_NEAR(one.steps.back().sums.kinetic_energy, two.steps.back().sums.kinetic_energy,
              1e-2 * one.steps.back().sums.kinetic_energy);
}

TEST(RegionFlow, AHeapBelowItsAngleOfReposeDoesNotCreep) {
  const double height = 20 * std::tan(std::atan(0.6) - 0.2618);
  RegionMarch march = plan({.parts = {wall("floor", {-50, 0}, {50, 0}), smooth("middle", {0, -5}, {0, 50})},
                            .fill = {{0, 0}, {20, 0}, {0, height}}},
                           2, 1, 10, JopLaw{.mu_s = 0.6, .mu_2 = 0.9, .I_0 = 0.4});
  const Flow flow = ended(march);
  EXPECT_LT(std::abs(flow.height() - height), 1e-2);
  EXPECT_LT(std::abs(flow.front() - 20), 1e-2);
}

// As a rigid body, as long as its surface is below the angle of repose.
TEST(RegionFlow, OfADrumThatStarts) {
  constexpr double R = 15, rotation = 0.02;
  const RegionPart drum{.name = "drum", .curve = CircleCurve{{0, 0}, R}, .rotation = rotation};
  std::vector<Vec2> fill;
  for (int i = 0; i <= 30; ++i) {
    const double angle = (i / 30.0 - 1) * 2 * right_angle;
    fill.push_back({R * std::cos(angle), R * std::sin(angle)});
  }
  RegionMarch march = plan({.parts = {drum}, .fill = fill}, 5, 0.5, 3);
  march.problem.regularisation.shear_rate = 1e-5;
  const Flow flow = ended(march);
  // From rest eps is lowered step by step; then each flow is near the next. Two systems a step.
  for (std::size_t k = 2; k < flow.steps.size(); ++k) EXPECT_LE(flow.steps[k].iterations, 2 * 5) << k;
  const Vec2 inside{0, -8};
  const PointState at = flow_of(march, flow.state).at(std::span(&inside, 1)).front();
  EXPECT_NEAR(at.velocity.x, rotation * inside.z, 1e-3);
  EXPECT_NEAR(at.velocity.z, 0, 1e-3);
  EXPECT_LT(at.rate, 1e-5);  // rotation^2 step / 2 = 1e-4, were the velocity not taken along
}

TEST(RegionFlow, OfAStepThatCannotConvergeSaysWhy) {
  const RegionMarch march = column(12, 6, 2.5, 6);
  FlowSolverOptions options;
  options.max_iterations = 1;
  const Flow flow = gone_on(march, filled(march), options);
  EXPECT_FALSE(flow.report.converged);
  EXPECT_NE(flow.report.failure.find("time 0, step 1"), std::string::npos) << flow.report.failure;
  EXPECT_NE(flow.report.failure.find("residual"), std::string::npos) << flow.report.failure;
}

}  // namespace
}  // namespace drumlin::region_march_test
