// What is read off maps as a whole, on maps made by hand.
#include "particles/measurement/maps/map_findings.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drumlin {
using namespace particles;
namespace {

/// A drum of radius 10 about (0, 1), full up to z = 0, in which `value` gives each field.
template <class Value>
FieldMap drum_map(Value value) {
  FieldMap map;
  map.grid = {-10, -9.5, 1, 1, 21, 12};
  for (const char* name :
       {"nu", "p", "I", "mu", "d_v_x_dz", "sigma_xz", "sigma_zz", "residual_x", "residual_z",
        "residual_x_without_kinetic", "residual_z_without_kinetic", "inertia_x", "inertia_z"}) {
    MapField field{name, {}, {}};
    for (std::size_t row = 0; row < map.grid.rows; ++row)
      for (std::size_t column = 0; column < map.grid.columns; ++column)
        field.value.push_back(value(std::string(name), map.grid.x_of(column), map.grid.z_of(row)));
    map.fields.push_back(field);
  }
  return map;
}

double depth_law(const std::string& name, double x, double z) {
  const double I = std::exp(z);
  if (name == "nu") return std::hypot(x, z - 1) > 10 ? std::nan("") : z < 0 ? 0.8 : 0;
  if (name == "I") return I;
  if (name == "mu") return 0.38 + 0.02 * std::log(I);
  if (name == "p" || name == "sigma_zz") return 4;
  if (name == "d_v_x_dz") return 2 * I;  // I sqrt(sigma_zz)
  if (name == "sigma_xz") return 4 * (0.4 + 0.03 * std::log(I));
  if (name == "residual_x") return x > 0 ? 0.01 : -0.01;
  if (name == "residual_z") return 0.02;
  return 0;
}

constexpr MapBounds drum{10, 1};

TEST(MapFindings, BulkKeepsItsDistanceFromWallAndSurface) {
  const FieldMap map = drum_map(depth_law);
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

TEST(MapFindings, FloorAndSidesTakeThePlaceOfADrum) {
  const FieldMap map = drum_map(
      [](const std::string& name, double x, double z) { return name == "nu" ? 0.8 : depth_law(name, x, z); });
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
  const FieldMap map = drum_map([](const std::string& name, double x, double z) {
    if (name == "residual_x") return std::abs(std::remainder(x, 2)) < 0.5 ? 0.01 : -0.01;
    return depth_law(name, x, z);
  });
  const MomentumBalance found = momentum_balance(map, drum, options, 0);
  EXPECT_NEAR(found.bulk.rms_x, 0.01, 1e-12);
  EXPECT_NEAR(found.bulk.rms_x_blocks, 0.003, 0.0031);  // a square at the wall may lack one node
  EXPECT_NEAR(found.bulk.rms_z_blocks, 0.02, 1e-12);
}

}  // namespace
}  // namespace drumlin
