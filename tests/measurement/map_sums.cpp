// Coarse graining: the kernel, totals, line integrals, and the divergence that belongs to them.
#include "particles/measurement/maps/map_sums.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/spline_kernel.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

MapSums sums_of(const CoarseGraining& graining, const Snapshot& snapshot) {
  MapSums sums = empty_sums(graining);
  add_snapshot(graining, snapshot, in_flow_frame(snapshot, graining.frame), sums);
  return sums;
}

TEST(SplineKernel, AddsUpToOneOnTheNodes) {
  for (double u = -0.5; u < 0.5; u += 0.01) {
    double sum = 0, first = 0, slope = 0;
    for (int node = -3; node <= 3; ++node) {
      sum += spline(u - node);
      first += node * spline(u - node);
      slope += spline_slope(u - node);
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    EXPECT_NEAR(first, u, 1e-14);  // a straight line over the nodes stays one
    EXPECT_NEAR(slope, 0, 1e-14);
  }
}

TEST(SplineKernel, SlopeAndIntegralBelongToIt) {
  const double h = 1e-5;
  for (double u = -2.3; u < 2.3; u += 0.07) {
    EXPECT_NEAR(spline_slope(u), (spline(u + h) - spline(u - h)) / (2 * h), 1e-9);
    EXPECT_NEAR(spline(u), (spline_integral(u + h) - spline_integral(u - h)) / (2 * h), 1e-9);
  }
  EXPECT_EQ(spline_integral(-2), 0);
  EXPECT_EQ(spline_integral(2), 1);
}

TEST(SplineKernel, SharesInACircleAddUpToItsArea) {
  const double radius = 5.3, spacing = 0.5, width = 1.5;  // whole spacings per width: the kernels add up to 1
  double area = 0;
  for (double x = -9; x <= 9; x += spacing)
    for (double z = -9; z <= 9; z += spacing)
      area += spacing * spacing * kernel_share_in_circle(x, z, width, radius);
  const double whole = std::numbers::pi * radius * radius;
  EXPECT_NEAR(area / whole, 1, 1e-4);  // what is promised for each share
  EXPECT_EQ(kernel_share_in_circle(0, 0, width, radius), 1);
  EXPECT_EQ(kernel_share_in_circle(20, 0, width, radius), 0);
  EXPECT_NEAR(kernel_share_in_circle(0, -1000, 1, 1000), 0.5, 1e-3);
}

/// Touching and distant grains at random places with random forces between random pairs: no packing, but what
/// holds for any force network must hold for this one.
Snapshot random_network(unsigned seed) {
  Snapshot snapshot;
  snapshot.time_step = 0.01;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-4, 4), size(0.45, 0.55), any(-1, 1);
  for (int i = 0; i < 40; ++i) {
    testing::add_grain(snapshot, place(random), place(random), size(random));
    snapshot.v_x.back() = any(random);
    snapshot.v_z.back() = any(random);
  }
  for (std::int32_t i = 0; i < 40; ++i) {
    const double angle = 3.2 * any(random);
    snapshot.contacts.push_back({i, i % 4 == 0 ? -1 : (i + 7) % 40, static_cast<float>(std::cos(angle)),
                                 static_cast<float>(std::sin(angle)), 0.01 * any(random),
                                 0.01 * any(random)});
  }
  return snapshot;
}

TEST(MapSums, WallsAndFabricAddUpAndSlopesToNothing) {
  const Snapshot snapshot = random_network(1);
  for (double spacing : {1.0, 0.4}) {
    const CoarseGraining graining =
        coarse_graining(FlowFrame{0.3, -0.2, 0.8, -0.6}, -15, 15, -15, 15, spacing, 5 * spacing, 0);
    const MapSums sums = sums_of(graining, snapshot);
    MapNode total;
    for (std::size_t node = 0; node < sums.nodes.size(); ++node) add_times(1, sums.nodes[node], total);
    const double cell = spacing * spacing;

    const FlowSnapshot in_frame = in_flow_frame(snapshot, graining.frame);
    double wall_force_x = 0, sides = 0;
    in_frame.each_half_branch([&](const HalfBranch<2>& branch) {
      sides += 0.5;
      if (branch.at_wall) wall_force_x += branch.force[0];
    });
    EXPECT_NEAR(cell * total.wall_force[0], wall_force_x, 1e-11);
    EXPECT_NEAR(cell * (total.fabric[0] + total.fabric[2]), sides, 1e-5);  // normals are stored as floats
    EXPECT_NEAR(cell * total.carried.slope_x[0], 0, 1e-11);
  }
}

TEST(MapSums, LineIntegralsAreExactToAThousandthOfTheKernel) {
  Snapshot snapshot;
  snapshot.time_step = 1;
  testing::add_grain(snapshot, 0.13, -0.29, 0.55);
  for (double angle = 0; angle < 6.2; angle += 0.37)
    for (double width : {0.5, 0.75, 1.0, 2.0}) {
      snapshot.contacts = {
          {0, -1, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 1, 0}};
      const CoarseGraining graining = coarse_graining(FlowFrame{}, -6, 6, -6, 6, 0.25, width, 0);
      const MapSums sums = sums_of(graining, snapshot);
      const HalfBranch<2> branch{0,  {0.13, -0.29}, {-0.55 * std::cos(angle), -0.55 * std::sin(angle)}, {},
                                 {}, true};
      const double trace = 0.55;  // F.b: a force of 1 along a branch of 0.55
      for (std::size_t node = 0; node < sums.nodes.size(); ++node) {
        const double x = graining.grid.x_of(node % graining.grid.columns),
                     z = graining.grid.z_of(node / graining.grid.columns);
        double exact = 0;
        constexpr int steps = 400;
        for (int step = 0; step < steps; ++step) {
          const double t = (step + 0.5) / steps;
          exact += spline((x - branch.at[0] - t * branch.toward[0]) / width) *
                   spline((z - branch.at[1] - t * branch.toward[1]) / width) / (width * width * steps);
        }
        const double found =
            (sums.nodes[node].force_branch[0][0] + sums.nodes[node].force_branch[1][1]) / trace;
        const double greatest = std::pow(spline(0) / width, 2);
        ASSERT_NEAR(found, exact, 1e-3 * greatest) << width << " " << angle;
      }
    }
}

/// Greatest difference between the divergence as it is summed and central differences of the stress.
double divergence_error(double spacing) {
  const CoarseGraining graining = coarse_graining(FlowFrame{}, -9, 9, -9, 9, spacing, 2, 0);
  const MapSums sums = sums_of(graining, random_network(2));
  const std::size_t columns = graining.grid.columns;
  double greatest = 0;
  for (std::size_t row = 1; row + 1 < graining.grid.rows; ++row)
    for (std::size_t column = 1; column + 1 < columns; ++column) {
      const std::size_t at = row * columns + column;
      const auto branch = [&](std::size_t node, std::size_t c) {
        return sums.nodes[node].force_branch[c / 2][c % 2];
      };
      for (std::size_t c : {0, 1}) {  // forces along x and z
        const double divergence =
            (branch(at + 1, 2 * c) - branch(at - 1, 2 * c)) / (2 * spacing) +
            (branch(at + columns, 2 * c + 1) - branch(at - columns, 2 * c + 1)) / (2 * spacing);
        const MapNode& node = sums.nodes[at];
        const double summed = node.contact_force[c] - node.force[c];
        greatest = std::max(greatest, std::abs(divergence - summed));
      }
    }
  return greatest;
}

TEST(MapSums, DivergenceIsThatOfTheMappedStressToSecondOrder) {
  const double coarse = divergence_error(0.4), fine = divergence_error(0.2);
  EXPECT_LT(fine, 5e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.6);
}

TEST(MapSums, PeriodicMapsDoNotCareWhereThePeriodBegins) {
  Snapshot snapshot = testing::stacked_columns(6, 5, 0.2), moved = snapshot;
  for (double& x : moved.x) x += 6 * 3;
  const CoarseGraining graining = coarse_graining(FlowFrame{}, 0, 6, -1, 6, 1, 1.5, 6);
  const MapSums a = sums_of(graining, snapshot), b = sums_of(graining, moved);
  ASSERT_EQ(graining.grid.columns, 6u);
  for (std::size_t node = 0; node < a.nodes.size(); ++node) {
    EXPECT_NEAR(a.nodes[node].motion.weight, b.nodes[node].motion.weight, 1e-12);
    EXPECT_NEAR(a.nodes[node].force_branch[1][1], b.nodes[node].force_branch[1][1], 1e-11);
  }
}

TEST(MapSums, AKernelThatLosesGrainsBetweenNodesIsRefused) {
  EXPECT_THROW(coarse_graining(FlowFrame{}, 0, 1, 0, 1, 1, 0.9, 0), InputError);
  EXPECT_THROW(coarse_graining(FlowFrame{}, 0, 1, 0, 1, 0.1, 2, 0), InputError);
  EXPECT_THROW(coarse_graining(FlowFrame{}, 0, 1, 0, 1, 0, 1, 0), InputError);
}

}  // namespace
}  // namespace drumlin
