// What is read off maps as a whole, on maps made by hand.
#include "particles/measurement/maps/map_findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace drumlin {
using namespace particles;
namespace {

/// A drum of radius 10 about (0, 1), full up to z = 0, in which `value` gives each field.
FindingMap drum_map(const std::function<FindingNode(double x, double z)>& node) {
  FindingMap map{{-10, -9.5, 1, 1, 21, 12}, {}};
  for (std::size_t row = 0; row < map.grid.rows; ++row)
    for (std::size_t column = 0; column < map.grid.columns; ++column)
      map.nodes.push_back(node(map.grid.x_of(column), map.grid.z_of(row)));
  return map;
}

FindingNode depth_law(double x, double z) {
  const double I = std::exp(z), log_I = std::log(I);
  const double nu = std::hypot(x, z - 1) > 10 ? std::nan("") : z < 0 ? 0.8 : 0;
  FindingNode node{
      {nu, 4, I, 0.38 + 0.02 * log_I}, 2 * I, 4 * (0.4 + 0.03 * log_I), 4};  // 2 I: I sqrt(sigma_zz)
  node.residual_x = x > 0 ? 0.01 : -0.01;
  node.residual_z = 0.02;
  return node;
}

constexpr MapBounds drum{10, 1};

TEST(MapFindings, BulkKeepsItsDistanceFromWallAndSurface) {
  const FindingMap map = drum_map(depth_law);
  const auto nodes = bulk_nodes(map, drum, {});
  EXPECT_GT(nodes.size(), 20u);
  std::size_t expected = 0;
  // The surface, nu = 0.7, lies an eighth of the way from the last node below 0 to the first above it.
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double x = map.grid.x_of(node % 21), z = map.grid.z_of(node / 21);
    if (std::hypot(x, z - 1) < 7 && z < -0.5 + 0.125 - 3) ++expected;
  }
  EXPECT_EQ(nodes.size(), expected);
}

TEST(Surface, LiesBetweenTheHighestDenseNodeAndTheNextOrOnItBelowNoValue) {
  const double none = std::nan("");
  const std::vector<double> nu{0.8, 0.8, 0.8, none, 0.6,   //
                               0.8, 0.7, 0.6, none, none,  //
                               0.6, 0.0, 0.9, 0.8,  0.5,   //
                               0.0, 0.0, 0.8, none, none};
  const std::vector<double> z = surface_heights({0, -3, 1, 2, 5, 4}, nu, 0.7);
  EXPECT_NEAR(z[0], 0, 1e-12);   // half of the way from -1 to 1
  EXPECT_NEAR(z[1], -1, 1e-12);  // nu is that of the node
  EXPECT_NEAR(z[2], 3, 1e-12);   // the highest row; a loose node below it does not count
  EXPECT_NEAR(z[3], 1, 1e-12);   // nothing known above
  EXPECT_TRUE(std::isnan(z[4])) << "nowhere dense";
}

TEST(MapFindings, FloorAndSidesTakeThePlaceOfADrum) {
  const FindingMap map = drum_map([](double x, double z) {
    FindingNode node = depth_law(x, z);
    node.nu = 0.8;
    return node;
  });
  MapBounds box;
  box.z_min = -9.5;
  const std::size_t all_columns = bulk_nodes(map, box, {}).size();
  box.x_min = -10;
  box.x_max = 10;
  EXPECT_EQ(bulk_nodes(map, box, {}).size() * 21, all_columns * 13);  // |x| < 10 - 3
}

TEST(MapFindings, ExactLawsAreFoundWithoutScatter) {
  const BulkFriction found = bulk_friction(drum_map(depth_law), drum, {}, 0);
  EXPECT_NEAR(found.invariant.a, 0.38, 1e-12);
  EXPECT_NEAR(found.invariant.b, 0.02, 1e-12);
  EXPECT_NEAR(found.invariant.rms, 0, 1e-12);
  EXPECT_NEAR(found.ratio.a, 0.4, 1e-12);
  EXPECT_NEAR(found.ratio.b, 0.03, 1e-12);
  EXPECT_EQ(found.invariant.nodes, found.ratio.nodes);
  EXPECT_LE(found.invariant.nodes, found.bulk);
}

TEST(MapFindings, ResidualIsCountedByZone) {
  MapFindingOptions options;
  options.flowing_I = std::exp(-4.0);
  const MomentumBalance found = momentum_balance(drum_map(depth_law), drum, options, 0);
  EXPECT_EQ(found.bulk.nodes, found.flowing.nodes + found.slow.nodes);
  EXPECT_GT(found.flowing.nodes, 5u);
  EXPECT_NEAR(found.bulk.rms_x, 0.01, 1e-12);
  EXPECT_NEAR(found.bulk.rms_z, 0.02, 1e-12);
  EXPECT_NEAR(found.bulk.mean_z, 0.02, 1e-12);
  EXPECT_LT(std::abs(found.bulk.mean_x), 0.002);
  EXPECT_TRUE(std::isnan(found.bulk.noise_x));
}

TEST(MapFindings, MeansOverSquaresForgetWhatChangesSignWithinThem) {
  MapFindingOptions options;
  options.block = 2;
  options.margin = 1;
  const FindingMap map = drum_map([](double x, double z) {
    FindingNode node = depth_law(x, z);
    node.residual_x = std::abs(std::remainder(x, 2)) < 0.5 ? 0.01 : -0.01;
    return node;
  });
  const MomentumBalance found = momentum_balance(map, drum, options, 0);
  EXPECT_NEAR(found.bulk.rms_x, 0.01, 1e-12);
  EXPECT_NEAR(found.bulk.rms_x_blocks, 0.003, 0.0031);  // a square at the wall may lack one node
  EXPECT_NEAR(found.bulk.rms_z_blocks, 0.02, 1e-12);
}

}  // namespace
}  // namespace drumlin
