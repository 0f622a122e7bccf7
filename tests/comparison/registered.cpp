// The same place of the drum on both sides, slices and maps.
#include <gtest/gtest.h>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/map_sampling.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/comparison/example_maps.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using namespace testing;

/// The same continuum, described from a line `offset` higher: its axis is less far above it.
ComparedSide seen_from_higher(ComparedSide side, double offset) {
  side.profiles = moved(side.profiles, -offset);
  if (side.fields.maps) side.fields.maps = moved(*side.fields.maps, -offset);
  return side;
}

void expect_no_error(const std::vector<FieldComparison>& fields, double tolerance) {
  ASSERT_FALSE(fields.empty());
  for (const auto& field : fields)
    for (const auto& [zone, errors] : field.zones) {
      if (errors.layers == 0) continue;
      EXPECT_LE(errors.max, tolerance) << field.overlay.field << " " << zone.name;
      EXPECT_LE(errors.rms, tolerance) << field.overlay.field << " " << zone.name;
      EXPECT_EQ(errors.undefined, 0) << field.overlay.field << " " << zone.name;
    }
}

TEST(Registration, ByTheAxisDoesNotCareWhereASideCountsFrom) {
  for (const double offset : {0.0, 1.25, -0.7}) {
    const auto comparison = compare(example_side(), seen_from_higher(continuum_side(), offset));
    EXPECT_NEAR(comparison.offset, offset, 1e-12);
    expect_no_error(comparison.fields, 1e-9);
    EXPECT_NEAR(scalar_of(comparison, "H", &ScalarPair::continuum),
                scalar_of(comparison, "H", &ScalarPair::particles),
                offset == 0 ? 0 : 4);  // the example's H is not the straight line's
  }
}

TEST(Registration, BySurfaceComparesOtherPlaces) {
  ComparisonOptions by_surface;
  by_surface.registration = Registration::surface;
  const auto comparison = compare(example_side(), seen_from_higher(continuum_side(), 1.25), by_surface);
  EXPECT_EQ(comparison.offset, 0);
  // sigma_zz = -0.75 z is off by 0.75 * 1.25 wherever one looks.
  for (const auto& field : comparison.fields)
    if (field.overlay.field == "sigma_zz") {
      EXPECT_NEAR(field.zones[2].errors.rms, 0.75 * 1.25, 1e-9);
    }
}

TEST(Registration, KeepsWhatASideSaysFromItsOwnSurface) {
  auto continuum = seen_from_higher(continuum_side(), 1.25);
  const auto comparison = compare(example_side(), continuum);
  EXPECT_EQ(scalar_of(comparison, "H", &ScalarPair::continuum_own), example_H);
  const auto ours = compare(example_side(), seen_from_higher(continuum_side(), 0));
  EXPECT_EQ(scalar_of(ours, "H", &ScalarPair::continuum), example_H) << "what was not moved keeps its words";
  // Read off the same places, the numbers do not depend on where they were counted from.
  const auto further = compare(example_side(), seen_from_higher(continuum_side(), 2.25));
  for (const char* name : {"H", "shear_rate", "lambda", "I_th"})
    EXPECT_NEAR(scalar_of(comparison, name, &ScalarPair::continuum),
                scalar_of(further, name, &ScalarPair::continuum), 1e-9)
        << name;
}

TEST(Registration, RefusesASideWithoutAnAxis) {
  auto continuum = continuum_side();
  continuum.profiles.header.axis_depth.reset();
  EXPECT_THROW(compare(example_side(), continuum), InputError);
}

TEST(Registration, ReadsLambdaInTheWindowOfTheParticlesToo) {
  auto continuum = continuum_side();
  auto& rate = column_of(continuum.profiles, "shear_rate").value;
  const auto& z = continuum.profiles.z;
  for (std::size_t i = 0; i < z.size(); ++i) rate[i] = 0.1 * std::exp(z[i] / 2.5);
  const auto comparison = compare(example_side(), continuum);
  EXPECT_NEAR(scalar_of(comparison, "lambda_same_window", &ScalarPair::continuum), 2.5, 1e-9);
}

TEST(Maps, BilinearTakesNodesExactlyAndNeverExtrapolates) {
  const MapGrid grid{-1, -2, 0.1, 0.5, 21, 5};
  std::vector<double> values;
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      values.push_back(1 + 2 * grid.x_of(column) - 3 * grid.z_of(row));
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      EXPECT_EQ(bilinear(grid, values, grid.x_of(column), grid.z_of(row)),
                values[row * grid.columns + column]);
  EXPECT_NEAR(bilinear(grid, values, 0.237, -1.11), 1 + 2 * 0.237 + 3 * 1.11, 1e-12);
  EXPECT_TRUE(std::isnan(bilinear(grid, values, 1.01, -1)));
  EXPECT_TRUE(std::isnan(bilinear(grid, values, 0, -2.01)));
  values[0] = std::nan("");
  EXPECT_TRUE(std::isnan(bilinear(grid, values, -0.95, -1.9)));
  EXPECT_FALSE(std::isnan(bilinear(grid, values, -0.9, -2))) << "a neighbour without weight does not count";
}

TEST(Maps, ProfileThroughALinearFieldIsTheField) {
  const ProfileSet through = profile_through(example_map(), 10, 4, {-30.5, -10.25}, 1);
  for (std::size_t i = 0; i < 2; ++i) {
    const double z = through.z[i];
    EXPECT_NEAR(through.column("sigma_zz").value[i], -0.75 * z, 1e-12);
    EXPECT_NEAR(through.column("mu").value[i], 0.27 / 0.75, 1e-12);
    EXPECT_NEAR(through.column("k").value[i], 0.78 / 0.75, 1e-12);
  }
  EXPECT_EQ(through.header.position, 10);
}

TEST(Maps, ZonesKeepOffSurfaceAndWallAndMeetAtTheFlow) {
  const FieldMap map = example_map();
  const auto zones = map_zones(map, {});
  const auto nodes = [&](const std::string& name) {
    for (const auto& zone : zones)
      if (zone.name == name) return zone.nodes;
    throw std::runtime_error(name);
  };
  EXPECT_EQ(nodes("flowing").size() + nodes("static").size(), nodes("all").size());
  EXPECT_EQ(nodes("upstream").size() + nodes("middle").size() + nodes("downstream").size(),
            nodes("all").size());
  EXPECT_EQ(nodes("upstream").size(), nodes("downstream").size()) << "the example is symmetric";
  for (const std::size_t node : nodes("all")) {
    const double x = map.grid.x_of(node % map.grid.columns), z = map.grid.z_of(node / map.grid.columns);
    EXPECT_LE(z, -3);
    EXPECT_LE(std::hypot(x, z - 4), 68.18 - 3);
  }
  for (const std::size_t node : nodes("flowing")) EXPECT_GE(map.field("I").value[node], 0.01);
  for (const std::size_t node : nodes("static")) EXPECT_LT(map.field("I").value[node], 0.01);
}

TEST(Parts, OfARunAgainstItselfAreExactlyZero) {
  ComparedSide particles = example_side(), continuum = continuum_side();
  particles.fields.maps = example_map();
  for (const double position : {-20.0, 0.0, 20.0}) {
    particles.fields.slices[position] = particles.profiles;
    particles.fields.slices[position].header.position = position;
  }
  continuum.fields.maps = example_map("continuum");
  for (const ComparedSide* side : {&particles, &continuum}) {
    const auto comparison = compare(*side, *side);
    expect_no_error(comparison.fields, 0);
    ASSERT_TRUE(comparison.slices.missing.empty());
    EXPECT_EQ(comparison.slices.part.size(), side == &particles ? 3u : 5u);
    for (const auto& slice : comparison.slices.part) expect_no_error(slice.fields, 0);
    ASSERT_TRUE(comparison.maps.missing.empty());
    expect_no_error(comparison.maps.part.fields, 0);
    for (const auto& pair : comparison.scalars)
      if (pair.name != "lambda_same_window" && !std::isnan(pair.particles)) {
        EXPECT_EQ(pair.particles, pair.continuum) << pair.name;
      }
    for (const auto& target : comparison.targets) EXPECT_EQ(target.outcome, Outcome::met) << target.quantity;
  }
}

TEST(Parts, ThatASideDoesNotHaveAreMissingWithAReasonAndNothingFails) {
  ComparedSide particles = example_side();
  const auto bare = compare(particles, continuum_side());
  expect_has(bare.slices.missing, "first");
  expect_has(bare.maps.missing, "first");
  particles.fields.maps = example_map();
  particles.fields.slices[0] = particles.profiles;
  const auto half = compare(particles, continuum_side());
  expect_has(half.slices.missing, "second");
  expect_has(half.maps.missing, "second");
  EXPECT_TRUE(half.slices.part.empty());
}

TEST(Parts, OfAContinuumSeenFromElsewhereAreComparedAtTheSamePlace) {
  ComparedSide particles = example_side(), continuum = continuum_side();
  particles.fields.maps = example_map();
  particles.fields.slices[0] = particles.profiles;
  continuum.fields.maps = example_map("continuum");
  const auto comparison = compare(particles, seen_from_higher(continuum, 1.5));  // a multiple of the spacing
  EXPECT_NEAR(comparison.maps.part.offset, 1.5, 1e-12);
  expect_no_error(comparison.maps.part.fields, 1e-9);
  ASSERT_EQ(comparison.slices.part.size(), 1u);
  for (const auto& field : comparison.slices.part[0].fields)
    if (field.overlay.field.starts_with("sigma_")) {
      EXPECT_LE(field.zones[2].errors.max, 1e-9);
    }
}

}  // namespace
}  // namespace drumlin
