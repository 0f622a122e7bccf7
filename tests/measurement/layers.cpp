// Profiles of layers without a container: volume fraction, stresses, velocities.
#include <gtest/gtest.h>

#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::at;
using testing::hexagonal_layer;
using testing::measurement_of;
using testing::stacked_columns;

TEST(Layers, ThinLayersKeepTheMeanStress) {
  const Measurement result = measurement_of(stacked_columns(6, 8, 0), {.layer_thickness = 0.25});
  const auto& sigma_zz = result.profiles.column("sigma_zz").value;
  ASSERT_EQ(sigma_zz.size(), 32u);
  // Lower half of a disc: the force below it; upper half: the force above it.
  for (std::size_t l = 0; l < 32; ++l) {
    const double carried = 8 - std::floor((static_cast<double>(l) + 2) / 4);
    EXPECT_NEAR(sigma_zz[l], carried * std::numbers::pi / 4, 1e-12) << l;
  }
}

TEST(Layers, EachLayerOfAColumnCarriesTheWeightAboveAndPullsTheLowerOneDownTheSlope) {
  for (const double slope : {0.0, 0.3}) {
    const Measurement result = measurement_of(stacked_columns(6, 20, slope));
    EXPECT_EQ(result.place.source, FrameSource::domain);
    EXPECT_NEAR(result.frame_angle_deg, slope * 180 / std::numbers::pi, 1e-10);
    ASSERT_EQ(result.profiles.z.size(), 20u);
    for (std::size_t l = 0; l < 20; ++l) {
      const double weight = std::numbers::pi / 4 * (20 - 0.5 - static_cast<double>(l));
      EXPECT_NEAR(at(result, "sigma_zz", l), weight * std::cos(slope), 1e-12);
      EXPECT_NEAR(at(result, "sigma_xz", l), weight * std::sin(slope), 1e-12);
      EXPECT_NEAR(at(result, "sigma_xx", l), 0, 1e-12);
      EXPECT_NEAR(at(result, "mu", l), std::tan(slope), 1e-12);
    }
  }
}

TEST(Layers, SliceCutsGrainsAndBranchesAtItsSides) {
  Snapshot open = stacked_columns(6, 20, 0);
  open.period_x = 0;
  MeasurementOptions options;
  options.slice_width = 2.5;  // through discs of the second and fifth column off their centres
  const Measurement result = measurement_of(open, options);
  EXPECT_EQ(result.place.source, FrameSource::gravity);
  EXPECT_EQ(result.place.slice_width, 2.5);
  // x = 1.75 .. 4.25: two discs whole and a quarter diameter of two more; the branches of the columns at 2.5
  // and 3.5 only.
  const double cap = std::acos(0.5) / 4 - std::sqrt(3.0) / 16;
  const double two_branches = 2 * std::numbers::pi / 4 / 2.5;
  for (std::size_t l = 0; l < 20; ++l) {
    EXPECT_NEAR(at(result, "nu", l), (std::numbers::pi / 2 + 2 * cap) / 2.5, 1e-12);
    EXPECT_NEAR(at(result, "sigma_zz", l), two_branches * (19.5 - static_cast<double>(l)), 1e-12);
  }
}

TEST(Layers, BranchAcrossTheSideOfTheSliceCountsWithItsShareInside) {
  // Two discs side by side pressed together with force 3 along x; the slice holds 0.75 of the branch of
  // length 1.
  Snapshot pair;
  pair.time_step = 0.5;
  for (double x : {-0.5, 0.5}) testing::add_grain(pair, x, 0.5, 0.5);
  pair.contacts.push_back({1, 0, 1, 0, 1.5, 0});
  const Measurement result = measurement_of(pair, {.position = 0.25, .slice_width = 1});
  EXPECT_NEAR(at(result, "sigma_xx", 0), 3 * 0.75, 1e-12);
}

TEST(Layers, ShearWithinALayerIsNoFluctuation) {
  // Grains spread evenly over the height: layer means stand in the middles.
  Snapshot cloud;
  cloud.period_x = 10;
  cloud.time_step = 1;
  for (int i = 0; i < 4000; ++i) {
    const double z = (i + 0.5) / 400;
    testing::add_grain(cloud, i % 10, z, 0.05);
    cloud.v_x.back() = 0.5 * z + (i % 2 == 0 ? 0.03 : -0.03);
    cloud.v_z.back() = i % 4 < 2 ? 0.04 : -0.04;
  }
  const Measurement result = measurement_of(cloud);
  for (std::size_t l = 2; l + 2 < result.profiles.z.size(); ++l) EXPECT_NEAR(at(result, "dv", l), 0.05, 1e-5);
}

TEST(Layers, KineticPartCountsLikeAnIdealGas) {
  Snapshot cloud;
  cloud.period_x = 10;
  cloud.time_step = 1;
  for (int i = 0; i < 400; ++i) {
    testing::add_grain(cloud, i % 10, (i + 0.5) / 40, 0.1);
    // Grains that go up bring less v_x than the mean: the upper layer drags the lower one forwards.
    cloud.v_x.back() = i % 2 == 0 ? -0.3 : 0.3;
    cloud.v_z.back() = i % 2 == 0 ? 0.2 : -0.2;
  }
  const Measurement result = measurement_of(cloud);
  const std::size_t middle = 5;
  const double nu = at(result, "nu", middle);
  EXPECT_NEAR(nu, 40 * std::numbers::pi * 0.01 / 10, 1e-3);
  EXPECT_NEAR(at(result, "sigma_xx_kinetic", middle), nu * 0.09, 1e-4);
  EXPECT_NEAR(at(result, "sigma_zz", middle), nu * 0.04, 1e-4);
  EXPECT_NEAR(at(result, "sigma_xz", middle), nu * 0.06, 1e-4);
}

TEST(Layers, SceneWithoutSpinHasNoColumnOfIt) {
  Snapshot layer = hexagonal_layer(8, 12);
  layer.spin.clear();
  const Measurement result = measurement_of(layer);
  EXPECT_EQ(result.profiles.find("omega"), nullptr);
  EXPECT_EQ(result.profiles.find("domega"), nullptr);
  EXPECT_TRUE(std::isnan(result.scalars.value("spin_over_half_vorticity")));
}

TEST(Layers, GravityTellsWhichContinuumTheyHave) {
  EXPECT_EQ(geometry_of_layers(0, 0), Geometry::plane_shear);
  EXPECT_EQ(geometry_of_layers(std::sin(0.3), -std::cos(0.3)), Geometry::incline);
  EXPECT_EQ(geometry_of_layers(1, 0), Geometry::chute);
  EXPECT_EQ(geometry_of_layers(1, -1e-16), Geometry::chute);
  EXPECT_EQ(geometry_of_layers(1e-16, -1), std::nullopt);  // a level bed
  EXPECT_EQ(geometry_of_layers(-0.3, -1), std::nullopt);   // down towards -x
}

TEST(Layers, GrainsOfSeveralDensitiesCountByTheirMasses) {
  Snapshot snapshot = stacked_columns(6, 20, 0);
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    // Columns in turn: density 1 at the speed 1, density 3 at the speed -1.
    const bool heavy = static_cast<int>(std::floor(snapshot.x[i])) % 2 != 0;
    snapshot.v_x[i] = heavy ? -1 : 1;
    snapshot.mass.push_back((heavy ? 3 : 1) * std::numbers::pi / 4);
  }
  const Measurement result = measurement_of(snapshot);
  const double nu = std::numbers::pi / 4;
  // About the speed of the centre of mass, -1/2: (1 * 1.5^2 + 3 * 0.5^2)/2 per unit of nu.
  EXPECT_NEAR(at(result, "sigma_xx_kinetic", 10), nu * 1.5, 1e-12);
  EXPECT_NEAR(at(result, "nu", 10), nu, 1e-12);
  EXPECT_NEAR(at(result, "density", 10), 2 * nu, 1e-12);
  EXPECT_NEAR(at(result, "v_x", 10), 0, 1e-12);
}

TEST(Layers, OneDensityHasNoColumnOfItAndOneThatIsSaidChangesNothing) {
  Snapshot snapshot = stacked_columns(6, 20, 0);
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) snapshot.v_x[i] = 0.1 * static_cast<double>(i % 7);
  const Measurement plain = measurement_of(snapshot);
  EXPECT_EQ(plain.profiles.find("density"), nullptr);
  snapshot.mass.assign(snapshot.x.size(), std::numbers::pi / 4);
  const Measurement said = measurement_of(snapshot);
  for (const ProfileColumn& column : plain.profiles.columns) {
    const auto& same = said.profiles.column(column.name).value;
    for (std::size_t l = 1; l + 1 < same.size(); ++l) {
      EXPECT_EQ(std::isfinite(same[l]), std::isfinite(column.value[l])) << column.name;
      if (std::isfinite(same[l])) {
        EXPECT_NEAR(same[l], column.value[l], 1e-12) << column.name;
      }
    }
  }
}

}  // namespace
}  // namespace drumlin
