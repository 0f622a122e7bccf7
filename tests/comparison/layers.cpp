// Flows in layers side by side: where a packing begins and ends, which layers are its bulk, and what is
// refused.
#include "coupling/comparison/layers.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "coupling/core/basics/errors.hpp"
#include "tests/comparison/example.hpp"
#include "tests/comparison/shear_example.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::coupling {
namespace {

using namespace testing;

const FieldErrors& errors_of(const LayerComparison& comparison, const std::string& field,
                             const std::string& zone) {
  for (const FieldComparison& one : comparison.fields)
    for (const ZoneErrors& errors : one.zones)
      if (one.overlay.field == field && errors.zone.name == zone) return errors.errors;
  throw InputError(field + ", " + zone + ": is none");
}

TEST(LayerComparison, APackingEndsWhereTheVolumeFractionOfItsBulkWouldHoldItsGrains) {
  // From -21 to 1: a layer of 0.4 below, one of 0.2 above, 0.8 between: half a layer and a quarter of one.
  const LayerExtent extent = layer_extent(sheared_packing());
  EXPECT_NEAR(extent.base, -20.5, 1e-12);
  EXPECT_NEAR(extent.top, 0.25, 1e-12);
  const LayerExtent continuum = layer_extent(sheared_continuum());
  EXPECT_EQ(continuum.base, -20.75);
  EXPECT_EQ(continuum.top, 0);
}

TEST(LayerComparison, TheBulkKeepsItsDistanceFromWallAndLooseLayers) {
  const std::vector<Zone> zones = layer_zones(sheared_packing());
  EXPECT_EQ(zones[0].name, "bulk");
  EXPECT_DOUBLE_EQ(zones[0].from, -17);
  EXPECT_DOUBLE_EQ(zones[0].to, -4.5);
  EXPECT_EQ(zones[3].name, "all");
  EXPECT_NEAR(zones[3].from, -20, 1e-12);
  EXPECT_NEAR(zones[3].to, -0.25, 1e-12);
}

TEST(LayerComparison, OneFlowOnBothSidesDiffersByNothingWhenItIsCountedFromItsBase) {
  const LayerComparison by_base =
      compare_layers(shear_side(sheared_packing()), shear_side(sheared_continuum()), Registration::axis);
  EXPECT_NEAR(by_base.offset, 0.25, 1e-12);
  for (const char* field : {"v_x", "shear_rate", "sigma_xz", "mu"})
    EXPECT_LT(errors_of(by_base, field, "bulk").rel_l2, 1e-12) << field;
  EXPECT_EQ(errors_of(by_base, "v_x", "bulk").layers, 13);  // from -16.5 to -4.5
  EXPECT_NEAR(scalar_of(by_base, "height", &ScalarPair::particles), 20.75, 1e-12);
  EXPECT_NEAR(scalar_of(by_base, "bulk_I", &ScalarPair::continuum),
              scalar_of(by_base, "bulk_I", &ScalarPair::particles), 1e-12);
  const LayerComparison by_surface =
      compare_layers(shear_side(sheared_packing()), shear_side(sheared_continuum()), Registration::surface);
  EXPECT_EQ(by_surface.offset, 0);
  // The shear rate of 0.1 over the quarter of a layer that the two count differently.
  EXPECT_NEAR(errors_of(by_surface, "v_x", "bulk").rms, 0.025, 1e-12);
}

TEST(LayerComparison, ATenthMoreSpeedIsAnErrorOfATenth) {
  const ProfileSet fast = scaled(sheared_continuum(), "v_x", 1.1);
  const LayerComparison comparison =
      compare_layers(shear_side(sheared_packing()), shear_side(fast), Registration::axis);
  EXPECT_NEAR(errors_of(comparison, "v_x", "bulk").rel_l2, 0.1, 1e-12);
  EXPECT_NEAR(scalar_of(comparison, "surface_speed", &ScalarPair::continuum),
              1.1 * scalar_of(comparison, "surface_speed", &ScalarPair::particles), 1e-12);
}

TEST(LayerComparison, AnotherGeometryIsRefusedWithBothNames) {
  ProfileSet slope = sheared_continuum();
  slope.header.geometry = Geometry::incline;
  const std::string said = message_of<InputError>(
      [&] { compare_layers(shear_side(sheared_packing()), shear_side(slope), Registration::axis); });
  expect_has(said, "plane_shear in the first side, incline in the second");
  ProfileSet old = sheared_packing();
  old.header.geometry.reset();
  expect_has(message_of<InputError>([&] { require_same_geometry(old, slope); }), "none in the first");
}

TEST(LayerComparison, AnotherSlopeOrSizeOrHeightIsRefused) {
  const auto refusal = [](const std::function<void(ProfileSet&)>& change) {
    ProfileSet other = sheared_continuum();
    change(other);
    return message_of<InputError>(
        [&] { compare_layers(shear_side(sheared_packing()), shear_side(other), Registration::axis); });
  };
  expect_has(refusal([](ProfileSet& set) { set.header.theta_deg = 0.1; }), "theta_deg");
  expect_has(refusal([](ProfileSet& set) { set.header.diameter_m = 0.003; }), "diameter_m");
  expect_has(refusal([](ProfileSet& set) { set.header.reduced = false; }), "reduced");
  expect_has(refusal([](ProfileSet& set) { set.header.wall_z = -24; }), "height");
}

TEST(LayerComparison, APackingThinnerThanItsMarginsHasNoBulk) {
  ProfileSet thin = sheared_packing();
  thin.z.resize(7);
  for (ProfileColumn& column : thin.columns) column.value.resize(7), column.ci99.clear();
  expect_has(message_of<InputError>([&] { layer_extent(thin); }), "no layer of a bulk");
}

}  // namespace
}  // namespace drumlin::coupling
