// Scalars that are read off profiles: of known profiles, and refused where a profile is too short.
#include "particles/measurement/layers/scalars.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/results/profile_scalars.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
namespace {

constexpr double rate = 0.13, depth = 18.0, decay = 3.2;

/// Straight above z = -depth + decay, exponential below, continuous with its slope; layers of 1 d from -0.4
/// downwards.
double speed_at(double z) {
  const double border = -depth + decay;
  return z > border ? rate * (z + depth) : rate * decay * std::exp((z - border) / decay);
}

ProfileSet drum_profile(double bottom) {
  ProfileSet profiles;
  ProfileColumn v_x{"v_x", {}, {}}, nu{"nu", {}, {}}, shear{"shear_rate", {}, {}}, inertial{"I", {}, {}};
  for (double z = -0.4 - std::floor(-0.4 - bottom); z < 4; z += 1) {
    profiles.z.push_back(z);
    v_x.value.push_back(speed_at(z));
    nu.value.push_back(0.8 * std::clamp(0.5 - z, 0.0, 1.0));  // the surface layer is partly empty
    shear.value.push_back((speed_at(z + 0.01) - speed_at(z - 0.01)) / 0.02);
    inertial.value.push_back(0.01 - 0.001 * z);
  }
  profiles.columns = {v_x, nu, shear, inertial};
  return profiles;
}

TEST(ProfileScalars, ReadBackWhatTheProfileWasMadeOf) {
  const ProfileScalars scalars = profile_scalars(drum_profile(-60));
  EXPECT_NEAR(scalars.shear_rate, rate, 1e-6);
  EXPECT_NEAR(scalars.H, depth, 1e-4);
  EXPECT_NEAR(scalars.lambda, decay, 1e-4);
  EXPECT_NEAR(std::exp(scalars.decay_log_rate), rate * std::exp((depth - decay) / decay), 1e-3 * rate * 100);
  EXPECT_NEAR(scalars.I_th, 0.028, 1e-6);
  EXPECT_NEAR(scalars.surface_speed, rate * (depth - 1), 1e-9);
  // 0.8 (straight triangle with its foot cut off + exponential tail).
  const double straight = 0.5 * rate * (depth * depth - decay * decay), tail = rate * decay * decay;
  EXPECT_NEAR(scalars.Q, 0.8 * (straight + tail), 0.01 * scalars.Q);
}

TEST(ProfileScalars, ALayerBesideAMissingOneKeepsItsValue) {
  const std::vector<double> z{-3, -2, -1}, value{1, 3, std::nan("")};
  EXPECT_EQ(interpolated(z, value, -3), 1);
  EXPECT_EQ(interpolated(z, value, -2.5), 2);
  EXPECT_EQ(interpolated(z, value, -2), 3);
  for (const double at : {-3.1, -1.5, -1.0, 0.0}) EXPECT_TRUE(std::isnan(interpolated(z, value, at))) << at;
}

TEST(ProfileScalars, WindowOutsideThePackingGivesNoDecayLength) {
  const ProfileScalars scalars = profile_scalars(drum_profile(-24));  // -H - 8 = -26
  EXPECT_NEAR(scalars.H, depth, 1e-4);
  EXPECT_TRUE(std::isnan(scalars.lambda));
}

TEST(ProfileScalars, PackingAtRestHasNoFlowingLayer) {
  ProfileSet profiles = drum_profile(-60);
  for (double& v : profiles.columns[0].value) v = 0;
  const ProfileScalars scalars = profile_scalars(profiles);
  EXPECT_EQ(scalars.Q, 0);
  EXPECT_TRUE(std::isnan(scalars.H));
  EXPECT_TRUE(std::isnan(scalars.shear_rate));
  EXPECT_TRUE(std::isnan(scalars.I_th));
}

TEST(ProfileScalars, EmptyLayersAtTheEndsCarryNothingAHoleInsideIsNoData) {
  const double none = ProfileScalars::none;
  ProfileSet profiles = drum_profile(-60);
  const double flow = profile_scalars(profiles).Q;
  profiles.columns[0].value.front() = none;
  profiles.columns[0].value.back() = none;
  EXPECT_NEAR(profile_scalars(profiles).Q, flow, 1e-6);
  profiles.columns[0].value[50] = none;
  EXPECT_TRUE(std::isnan(profile_scalars(profiles).Q));
}

TEST(ProfileScalars, ColumnsThatAreMissingCostOnlyTheirOwnScalar) {
  ProfileSet profiles = drum_profile(-60);
  profiles.columns.resize(1);
  const ProfileScalars scalars = profile_scalars(profiles);
  EXPECT_NEAR(scalars.H, depth, 1e-4);
  EXPECT_TRUE(std::isnan(scalars.Q));
  EXPECT_TRUE(std::isnan(scalars.lambda));
  EXPECT_TRUE(std::isnan(scalars.I_th));
}

TEST(BulkScalars, ColumnsOnAnInclineHaveTheirFrictionAndNoDrum) {
  // 12 discs high: a layer holds one disc of each column, so nu is pi/4; mu is the slope's tangent at any
  // depth.
  const particles::Snapshot columns = testing::stacked_columns(8, 12, 0.3);
  const particles::Measurement result = testing::measurement_of(columns);
  EXPECT_NEAR(result.scalars.value("bulk_nu"), std::numbers::pi / 4, 1e-9);
  EXPECT_NEAR(result.scalars.value("bulk_mu"), std::tan(0.3), 1e-6);
  EXPECT_NEAR(result.scalars.value("bulk_shear_rate"), 0, 1e-12);
  EXPECT_EQ(testing::measurement_of(testing::filled_drum(20, 3, 0.3, 0.02)).scalars.find("bulk_nu"), nullptr);
  EXPECT_TRUE(particles::belongs_to_a_drum("coordination_static"));
  EXPECT_FALSE(particles::belongs_to_a_drum("bulk_mu"));
}

}  // namespace
}  // namespace drumlin
