#include "coupling/comparison/field_errors.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "tests/comparison/example.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using namespace testing;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Zone zone(const std::string& name) {
  for (const auto& candidate : zones_of(example_profiles(), example_H))
    if (candidate.name == name) return candidate;
  throw std::runtime_error(name);
}

TEST(Zones, MeetAtTheInterfaceAndKeepOffSurfaceAndWall) {
  const auto z = example_profiles().z;
  int flowing = 0, still = 0, all = 0;
  for (const double at : z) {
    const auto in = [&](const std::string& name) { return at >= zone(name).from && at <= zone(name).to; };
    EXPECT_FALSE(in("flowing") && in("static"));
    EXPECT_EQ(in("all"), in("flowing") || in("static"));
    flowing += in("flowing");
    still += in("static");
    all += in("all");
  }
  EXPECT_EQ(flowing, 12);  // -14.5 .. -3.5
  EXPECT_EQ(still, 42);    // -56.5 .. -15.5
  EXPECT_EQ(all, 54);
}

TEST(Zones, InterfaceBelongsToTheFlowOnce) {
  const auto zones = zones_of(example_profiles(), 14.5);
  EXPECT_LE(zones[0].from, -14.5);
  EXPECT_LT(zones[1].to, -14.5);
}

TEST(Zones, WithoutAFlowingLayerOnlyAllHasErrors) {
  const auto field = overlay("v_x", example_profiles(), example_profiles());
  const auto zones = zones_of(example_profiles(), nan);
  EXPECT_EQ(errors_in(field, zones[0]).layers, 0);
  EXPECT_TRUE(std::isnan(errors_in(field, zones[0]).rel_l2));
  EXPECT_EQ(errors_in(field, zones[1]).layers, 0);
  EXPECT_EQ(errors_in(field, zones[2]).layers, 54);
}

TEST(ProfileErrors, OfAProfileAgainstItselfAreZero) {
  for (const auto& field : compared_fields())
    for (const auto& where : zones_of(example_profiles(), example_H)) {
      const auto errors = errors_in(overlay(field, example_profiles(), example_profiles()), where);
      EXPECT_EQ(errors.rel_l2, 0) << field;
      EXPECT_EQ(errors.rms, 0) << field;
      EXPECT_EQ(errors.max, 0) << field;
      EXPECT_EQ(errors.undefined, 0) << field;
      EXPECT_GT(errors.layers, 0) << field;
      EXPECT_EQ(errors.inside_band, 1) << field;
    }
}

TEST(ProfileErrors, OfAFactorAreRelativeToTheZonesOwnNorm) {
  const auto continuum = scaled(continuum_profiles(), "v_x", 1.1);
  const auto field = overlay("v_x", example_profiles(), continuum);
  // The speeds of the two zones differ; the relative error does not know.
  EXPECT_NEAR(errors_in(field, zone("flowing")).rel_l2, 0.1, 1e-12);
  EXPECT_NEAR(errors_in(field, zone("static")).rel_l2, 0.1, 1e-12);
  EXPECT_GT(errors_in(field, zone("flowing")).max, 4 * errors_in(field, zone("static")).max);
}

TEST(ProfileErrors, OfAnOffsetAreTheOffset) {
  auto continuum = continuum_profiles();
  for (auto& value : column_of(continuum, "sigma_zz").value) value += 0.5;
  const auto errors = errors_in(overlay("sigma_zz", example_profiles(), continuum), zone("flowing"));
  EXPECT_NEAR(errors.rms, 0.5, 1e-12);
  EXPECT_NEAR(errors.max, 0.5, 1e-12);
  double norm = 0;
  for (int i = 3; i < 15; ++i) norm += std::pow(0.75 * (i + 0.5), 2);
  EXPECT_NEAR(errors.rel_l2, std::sqrt(12 * 0.25 / norm), 1e-12);
}

TEST(ProfileErrors, OfTheShearRateAreInDecades) {
  const auto continuum = scaled(continuum_profiles(), "shear_rate", 10);
  const auto errors = errors_in(overlay("log10_shear_rate", example_profiles(), continuum), zone("static"));
  EXPECT_NEAR(errors.rms, 1, 1e-12);
  EXPECT_NEAR(errors.max, 1, 1e-12);
}

TEST(ProfileErrors, BandCountsTheLayersInsideTheInterval) {
  auto continuum = continuum_profiles();
  auto& v = column_of(continuum, "v_x").value;
  for (std::size_t i = 0; i < v.size(); ++i) v[i] *= i % 2 == 0 ? 1.009 : 1.011;  // the interval is 1 %
  EXPECT_DOUBLE_EQ(errors_in(overlay("v_x", example_profiles(), continuum), zone("flowing")).inside_band,
                   0.5);
  auto without = example_profiles();
  column_of(without, "v_x").ci99.clear();
  EXPECT_TRUE(std::isnan(errors_in(overlay("v_x", without, continuum), zone("flowing")).inside_band));
}

TEST(ProfileErrors, ExplainedIsWhatLiesWithinTheBandOfEitherSideOrBoth) {
  FieldOverlay field;
  field.field = "v_x";
  field.x = {0, 0};
  field.z = {-5, -6};
  field.particles = {1, 1};
  field.continuum = {5, 1};
  field.ci99 = {3, 1};
  field.continuum_ci99 = {nan, nan};
  field.noise = {0, 0};
  const auto errors = [&] { return errors_at(field, {0, 1}); };
  EXPECT_TRUE(std::isnan(errors().explained_by_calibration)) << "no band";
  EXPECT_DOUBLE_EQ(errors().explained_by_particles, 1 - 1.0 / 16);
  EXPECT_DOUBLE_EQ(errors().max_z, -5);
  field.continuum_ci99 = {2, 2};
  EXPECT_DOUBLE_EQ(errors().explained_by_calibration, 1 - 4.0 / 16);
  EXPECT_DOUBLE_EQ(errors().explained_by_both, 1 - std::pow(4 - std::sqrt(13.0), 2) / 16);
  EXPECT_DOUBLE_EQ(errors().inside_band, 0.5);
  field.continuum_ci99 = {4, 2};
  EXPECT_DOUBLE_EQ(errors().explained_by_calibration, 1);
  EXPECT_DOUBLE_EQ(errors().inside_both, 1);
  field.continuum = field.particles;
  EXPECT_TRUE(std::isnan(errors().explained_by_both)) << "nothing to explain";
}

TEST(ProfileErrors, OfAxesTakeTheNearestTurn) {
  FieldOverlay field;
  field.field = "axis_angle_deg";
  field.x = {0};
  field.z = {-5};
  field.particles = {85};
  field.continuum = {-88};
  field.ci99 = field.continuum_ci99 = {nan};
  field.noise = {0};
  EXPECT_NEAR(errors_at(field, {0}).max, 7, 1e-12);
}

TEST(ProfileErrors, AxisAngleOfSimpleShearIsThatOfItsRatioOfStresses) {
  const auto field = overlay("axis_angle_deg", example_profiles(), example_profiles());
  // tan(2 angle) = (k - 1)/(2 mu), coupling/core/results/plane_invariants.hpp
  const double expected = std::atan2(0.78 / 0.75 - 1, 2 * 0.27 / 0.75) / 2 * 180 / 3.14159265358979;
  for (std::size_t i = 1; i + 1 < field.z.size(); ++i) EXPECT_NEAR(field.particles[i], expected, 1e-9);
  EXPECT_GT(field.ci99[10], 0);
  auto bare = example_profiles();
  std::erase_if(bare.columns, [](const ProfileColumn& column) { return column.name == "half_vorticity"; });
  EXPECT_FALSE(overlay("axis_angle_deg", example_profiles(), bare).present);
}

TEST(ProfileErrors, OfALinearProfileDoNotDependOnTheContinuumsLayers) {
  ProfileSet continuum = continuum_profiles();
  for (auto& column : continuum.columns) column.value.clear();
  continuum.z = {-60, -20, 0};  // two layers, so coarse that only a linear field survives
  for (const double z : continuum.z)
    for (auto& column : continuum.columns) column.value.push_back(-0.75 * z);
  EXPECT_NEAR(errors_in(overlay("sigma_zz", example_profiles(), continuum), zone("all")).max, 0, 1e-12);
}

TEST(ProfileErrors, ContinuumIsNeverExtrapolated) {
  ProfileSet continuum = continuum_profiles();
  const std::size_t cut = 20;  // layers at the bottom
  continuum.z.erase(continuum.z.begin(), continuum.z.begin() + cut);
  for (auto& column : continuum.columns) {
    column.value.erase(column.value.begin(), column.value.begin() + cut);
  }
  const auto errors = errors_in(overlay("sigma_zz", example_profiles(), continuum), zone("all"));
  EXPECT_EQ(errors.undefined, 17);  // the 3 lowest of the 20 lie in the margin above the wall
  EXPECT_EQ(errors.layers, 37);
}

TEST(ProfileErrors, ShearRateBelowItsOwnIntervalIsNoShearRate) {
  auto particles = example_profiles();
  auto& rate = column_of(particles, "shear_rate");
  for (std::size_t i = 0; i < 10; ++i) rate.ci99[i] = 2 * rate.value[i];
  rate.value[10] = nan;
  rate.value[11] = -1e-6;
  const auto field = overlay("log10_shear_rate", particles, example_profiles());
  for (std::size_t i = 0; i < 12; ++i) EXPECT_TRUE(std::isnan(field.particles[i]));
  EXPECT_FALSE(std::isnan(field.particles[12]));
}

TEST(ProfileErrors, MissingColumnIsRefused) {
  auto continuum = continuum_profiles();
  continuum.columns.erase(continuum.columns.begin());
  EXPECT_THROW(overlay("v_x", example_profiles(), continuum), InputError);
}

}  // namespace
}  // namespace drumlin
