// Rings about a point, and the axes of a silo: packings that are known by hand.
#include <gtest/gtest.h>

#include <random>

#include "particles/measurement/layers/slice.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

LayerSums sums_of(const LayerGrid& grid, const Snapshot& snapshot) {
  LayerSums sums = empty_slice(grid, 1).batches[0];
  add_snapshot(grid, in_flow_frame(snapshot, grid.frame, VelocityKind::instantaneous), sums);
  return sums;
}

ProfileSet ring_profiles(const LayerGrid& grid, const Snapshot& snapshot) {
  return table_of(profile_of(grid, sums_of(grid, snapshot), 0), ring_quantities());
}

double value_of(const ProfileSet& profiles, const char* name, std::size_t layer) {
  return profiles.column(name).value[layer];
}

/// Discs at random about (3, -2) that turn about it clockwise with angular velocity w(r).
template <class AngularVelocity>
Snapshot turning(AngularVelocity w) {
  Snapshot snapshot;
  snapshot.time_step = 0.01;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-9, 9), size(0.4, 0.6);
  for (int i = 0; i < 2000; ++i) {
    const double x = place(random), z = place(random);
    testing::add_grain(snapshot, 3 + x, -2 + z, size(random));
    const double here = w(std::hypot(x, z));
    snapshot.v_x.back() = here * z;
    snapshot.v_z.back() = -here * x;
    snapshot.spin.back() = here;
  }
  return snapshot;
}

TEST(Rings, SolidBodyTurnsWithOmegaTimesRAndWithoutShear) {
  const double omega = 0.7;
  Snapshot plain = turning([&](double) { return omega; });
  for (const bool dense : {false, true}) {
    if (dense)
      for (std::size_t i = 0; i < plain.x.size(); ++i)
        plain.mass.push_back((i % 3 == 0 ? 4 : 1) * std::numbers::pi * plain.radius[i] * plain.radius[i]);
    const LayerGrid grid = ring_grid(3, -2, 1, 8, 0);
    const ProfileSet profiles = ring_profiles(grid, plain);
    ASSERT_EQ(profiles.z.size(), 8u);
    const auto value = [&](const char* name, std::size_t l) { return value_of(profiles, name, l); };
    for (std::size_t l = 0; l < 8; ++l) {
      EXPECT_NEAR(value("v_t", l), omega * profiles.z[l], 1e-12);
      EXPECT_NEAR(value("v_r", l), 0, 1e-12);
      EXPECT_NEAR(value("omega", l), omega, 1e-12);
      for (const char* name : {"sigma_rr_kinetic", "sigma_tt_kinetic", "sigma_rt_kinetic"})
        EXPECT_NEAR(value(name, l), 0, 1e-10) << name << l;
      if (l == 0 || l == 7) continue;
      EXPECT_NEAR(value("shear_rate", l), 0, 1e-12);
      EXPECT_NEAR(value("half_vorticity", l), omega, 1e-12);
    }
    EXPECT_EQ(profiles.find("density") != nullptr, dense);
  }
}

TEST(Rings, VortexHasItsShearRate) {
  // v_t = 5/r: r d(v_t/r)/dr = -10/r^2. Grains at the middles of the rings, so that only the difference
  // quotient is left.
  const double thickness = 0.25;
  Snapshot snapshot;
  for (int ring = 8; ring < 32; ++ring)
    for (int i = 0; i < 5; ++i) {
      const double r = (ring + 0.5) * thickness, angle = i + 0.1 * ring;
      testing::add_grain(snapshot, 3 + r * std::cos(angle), -2 + r * std::sin(angle), 0.1);
      snapshot.v_x.back() = 5 / r * std::sin(angle);
      snapshot.v_z.back() = -5 / r * std::cos(angle);
    }
  const LayerGrid grid = ring_grid(3, -2, thickness, 8, 0);
  const ProfileSet profiles = ring_profiles(grid, snapshot);
  for (std::size_t l = 9; l < 31; ++l) {
    const double r = profiles.z[l];
    const auto w = [](double at) { return 5 / (at * at); };
    const double quotient = r * (w(r + thickness) - w(r - thickness)) / (2 * thickness);
    EXPECT_NEAR(value_of(profiles, "v_t", l), 5 / r, 1e-12);
    EXPECT_NEAR(value_of(profiles, "shear_rate", l), quotient, 1e-12);
    EXPECT_NEAR(quotient / (-10 / (r * r)), 1, 0.03);
  }
}

TEST(Rings, AreasAreThoseOfTheDiscs) {
  EXPECT_NEAR(disc_area_in_circle(0.3, 0.5, 2), std::numbers::pi / 4, 1e-15);
  EXPECT_EQ(disc_area_in_circle(3, 0.5, 2), 0);
  EXPECT_NEAR(disc_area_in_circle(0.3, 2, 0.5), std::numbers::pi / 4, 1e-15);
  // Two circles of radius 1, 1 apart: 2 pi/3 - sqrt(3)/2.
  EXPECT_NEAR(disc_area_in_circle(1, 1, 1), 2 * std::numbers::pi / 3 - std::sqrt(3.0) / 2, 1e-14);
  double whole = 0;
  for (const double one : ring_grid(0, 0, 1, 50, 7.3).area) whole += one;
  EXPECT_NEAR(whole, std::numbers::pi * 7.3 * 7.3, 1e-10);
}

TEST(Rings, StressesAreThoseOfTheBranches) {
  // A row of discs along the radius at 40 degrees, pressed with 2 along it and 0.5 across it.
  Snapshot snapshot;
  snapshot.time_step = 0.5;
  const double angle = 40 * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  for (int i = 0; i < 8; ++i) testing::add_grain(snapshot, 1 + (i + 0.5) * c, 2 + (i + 0.5) * s, 0.5);
  for (std::int32_t i = 0; i < 7; ++i)
    snapshot.contacts.push_back({i + 1, i, static_cast<float>(c), static_cast<float>(s), 1.0, 0.25});
  const LayerGrid grid = ring_grid(1, 2, 1, 8, 0);
  const ProfileSet profiles = ring_profiles(grid, snapshot);
  for (std::size_t l = 1; l < 7; ++l) {
    const double area = std::numbers::pi * (2 * static_cast<double>(l) + 1);
    // 1e-6: snapshots hold normals as floats. On the outer grain act 2 outwards and 0.5 along the tangent,
    // which for a normal that points outwards is the clockwise one.
    EXPECT_NEAR(value_of(profiles, "sigma_rr", l), 2 / area, 1e-6) << l;
    EXPECT_NEAR(value_of(profiles, "sigma_rt", l), -0.5 / area, 1e-6) << l;
    EXPECT_NEAR(value_of(profiles, "sigma_tt", l), 0, 1e-6) << l;
    EXPECT_NEAR(value_of(profiles, "mu", l), -0.25, 1e-6) << l;
  }
}

/// Columns of touching discs in a box; no period.
Snapshot silo_at_rest() {
  Snapshot snapshot = testing::stacked_columns(8, 20, 0);
  snapshot.period_x = 0;
  return snapshot;
}

TEST(Silo, UniformColumnHasTheHydrostaticStressOverItsHeight) {
  const Rectangle reach{0, 8, 0, 20};
  const LayerGrid grid = height_grid(2, 6, reach, 1);
  const ProfileSet profiles =
      table_of(profile_of(grid, sums_of(grid, silo_at_rest()), 0), height_quantities());
  ASSERT_EQ(profiles.z.size(), 20u);
  const double nu = std::numbers::pi / 4;
  for (std::size_t l = 0; l < 20; ++l) {
    EXPECT_NEAR(profiles.z[l], static_cast<double>(l) + 0.5, 1e-12);  // from the scene's z = 0
    EXPECT_NEAR(value_of(profiles, "nu", l), nu, 1e-12);
    EXPECT_NEAR(value_of(profiles, "sigma_zz", l), nu * (20 - profiles.z[l]), 1e-12);
    EXPECT_NEAR(value_of(profiles, "sigma_xx", l), 0, 1e-12);
  }
  for (const char* foreign : {"shear_rate", "I", "mu", "half_vorticity"})
    EXPECT_EQ(profiles.find(foreign), nullptr) << foreign;
}

TEST(Silo, WidthHasTheScenesComponents) {
  // It falls faster to the right, leans on shear forces, and drifts to the right.
  Snapshot snapshot = silo_at_rest();
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    snapshot.v_z[i] = -0.1 * snapshot.x[i];
    snapshot.v_x[i] = 0.05;
  }
  for (SnapshotContact& contact : snapshot.contacts) contact.impulse_t = 0.2 * contact.impulse_n;
  const Rectangle reach{0, 8, 0, 20};
  const LayerGrid grid = width_grid(4, 8, reach, 1), upright = height_grid(0, 8, reach, 1);
  const ProfileSet profiles = table_of(profile_of(grid, sums_of(grid, snapshot), 0), width_quantities());
  const ProfileSet over_height =
      table_of(profile_of(upright, sums_of(upright, snapshot), 0), height_quantities());
  ASSERT_EQ(profiles.z.size(), 8u);
  const double nu = std::numbers::pi / 4;
  for (std::size_t l = 0; l < 8; ++l) {
    EXPECT_NEAR(profiles.z[l], static_cast<double>(l) + 0.5, 1e-12);
    EXPECT_NEAR(value_of(profiles, "v_z", l), -0.1 * profiles.z[l], 1e-12);
    EXPECT_NEAR(value_of(profiles, "v_x", l), 0.05, 1e-12);
    EXPECT_NEAR(value_of(profiles, "nu", l), nu, 1e-12);
    EXPECT_NEAR(value_of(profiles, "sigma_zz", l), nu * (20 - 6), 1e-12);  // at z = 6, in the mean
    // Branches are upright, so that forces across them show in sigma_xz of the height alone.
    EXPECT_NEAR(value_of(profiles, "sigma_xx", l), 0, 1e-12);
    if (l > 0 && l < 7) {
      EXPECT_NEAR(value_of(profiles, "d_v_z_dx", l), -0.1, 1e-12);
    }
  }
  EXPECT_NEAR(value_of(over_height, "sigma_xz", 5), -0.2 * nu * (20 - 5.5), 1e-12);
  for (const char* foreign : {"shear_rate", "I", "mu", "half_vorticity", "k"})
    EXPECT_EQ(profiles.find(foreign), nullptr) << foreign;
}

}  // namespace
}  // namespace drumlin
