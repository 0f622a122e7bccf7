// Fields per grain, and the profiles that are means over them.
#include "particles/measurement/grains/grain_fields.hpp"

#include <gtest/gtest.h>

#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using std::numbers::pi;

TEST(GrainFields, WhatNobodyKnowsIsNotThere) {
  Snapshot column = testing::stacked_columns(4, 6, 0.2);
  column.spin.clear();
  const GrainFields fields = grain_fields(column, in_flow_frame(column));
  for (const auto* empty : {&fields.spin, &fields.rotational, &fields.kinetic.xx})
    EXPECT_TRUE(empty->empty());
  EXPECT_EQ(fields.nu.size(), 24u);
}

TEST(GrainFields, UnknownContactsGiveNoStress) {
  Snapshot column = testing::stacked_columns(4, 6, 0);
  column.contacts.clear();
  column.contacts_known = false;
  const GrainFields fields = grain_fields(column, in_flow_frame(column));
  EXPECT_EQ(fields.nu.size(), 24u);
  EXPECT_TRUE(fields.contact.zz.empty());
  EXPECT_TRUE(fields.coordination.empty());
}

TEST(GrainFields, ContactWithTheFloorCarriesStressToo) {
  const int height = 6;
  const Snapshot column = testing::stacked_columns(4, height, 0);
  const GrainFields fields = grain_fields(column, in_flow_frame(column));
  for (int level = 0; level < height; ++level) {
    const auto i = static_cast<std::size_t>(level);
    // Half a branch each below and above, with the weights of what rests on them.
    const double force = pi / 4 * (height - level + (level + 1 < height ? height - level - 1 : 0));
    EXPECT_NEAR(fields.contact.zz[i] * fields.cell_area[i], 0.5 * force, 1e-12);
    EXPECT_EQ(fields.coordination[i], level + 1 < height ? 2 : 1);
  }
  EXPECT_NEAR(fields.contact.zz[2], pi / 4 * 3.5,
              1e-12);  // in the cell of area 1 the weight above the centre
}

TEST(GrainFields, GrainWithoutACellHasNoStressButAVelocity) {
  Snapshot column = testing::stacked_columns(4, 6, 0);
  column.radius[3] = 0;
  const GrainFields fields = grain_fields(column, in_flow_frame(column));
  EXPECT_TRUE(std::isnan(fields.nu[3]));
  EXPECT_TRUE(std::isnan(fields.contact.zz[3]));
  EXPECT_TRUE(std::isnan(fields.rotational[3]));
  EXPECT_EQ(fields.v_x[3], 0);
}

TEST(GrainFields, KineticAndRotationalPartsOfAnIdealGas) {
  // Two classes of grains on every place in turn: the mean velocity is known, and so is what remains.
  Snapshot gas = testing::hexagonal_layer(20, 12);
  std::vector<Snapshot> both(2, gas);
  VelocityMap mean({0, 20, 0, 12}, 20);
  for (int s = 0; s < 2; ++s)
    for (std::size_t i = 0; i < gas.x.size(); ++i) {
      const double sign = s == 0 ? 1 : -1;
      both[s].v_x[i] = 0.5 + sign * 0.3;
      both[s].v_z[i] = -sign * 0.2;
      both[s].spin[i] = 0.4;
    }
  for (int repeat = 0; repeat < 5; ++repeat)
    for (const Snapshot& snapshot : both) mean.add(in_flow_frame(snapshot));
  const GrainFields fields = grain_fields(both[0], in_flow_frame(both[0]), &mean);
  for (std::size_t i = 0; i < gas.x.size(); ++i) {
    EXPECT_NEAR(fields.kinetic.xx[i], fields.nu[i] * 0.09, 1e-12);
    EXPECT_NEAR(fields.kinetic.zz[i], fields.nu[i] * 0.04, 1e-12);
    EXPECT_NEAR(fields.kinetic.xz[i], fields.nu[i] * 0.06, 1e-12);
    // J = m r^2/2 = m/8: J spin^2/2 = m/100.
    EXPECT_NEAR(fields.rotational[i], fields.nu[i] * 0.01, 1e-12);
  }
}

TEST(VelocityMap, IsLinearBetweenCellsAndSilentWhereGrainsAreFew) {
  Snapshot cloud;
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 80; ++column) {
      testing::add_grain(cloud, (column + 0.5) / 8, (row + 0.5) / 8, 0.05);
      cloud.v_x.back() = 3 * cloud.z.back() - cloud.x.back();
      cloud.v_z.back() = 0.5;
    }
  VelocityMap map({0, 10, 0, 5});
  EXPECT_TRUE(std::isnan(map.at(3, 3)[0]));
  map.add(in_flow_frame(cloud));
  for (const double x : {0.5, 3.3, 7.9, 9.5})
    for (const double z : {0.5, 1.7, 4.4}) {
      EXPECT_NEAR(map.at(x, z)[0], 3 * z - x, 1e-12);
      EXPECT_NEAR(map.at(x, z)[1], 0.5, 1e-12);
    }
  EXPECT_TRUE(std::isnan(map.at(30, 3)[0]));
  EXPECT_TRUE(std::isnan(map.at(std::nan(""), 3)[0]));
}

TEST(CellProfiles, LayersOfALatticeHaveItsVolumeFraction) {
  MeasurementOptions options;
  options.voronoi = true;
  options.layer_thickness = std::sqrt(3.0) / 2;
  const Measurement result = testing::measurement_of(testing::hexagonal_layer(8, 12), options);
  for (std::size_t l = 2; l < 12; ++l)
    for (const char* name : {"nu", "nu_voronoi", "nu_grains"})
      EXPECT_NEAR(testing::at(result, name, l), pi / (2 * std::sqrt(3.0)), 1e-12) << name;
  EXPECT_TRUE(std::isnan(testing::at(result, "nu_voronoi", 0)));  // no centre in it
  options.voronoi = false;
  EXPECT_EQ(testing::measurement_of(testing::hexagonal_layer(8, 12), options).profiles.find("nu_voronoi"),
            nullptr);
}

TEST(CellProfiles, CellsOfUnequalGrainsCountByTheirArea) {
  // Rows of large and of small discs in turn, one layer: the layer's nu is disc area over cell area.
  Snapshot rows;
  rows.time_step = 1;
  rows.period_x = 6;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 6; ++column)
      testing::add_grain(rows, column + 0.5, 1.6 * (row / 2) + (row % 2 == 0 ? 0.5 : 1.3),
                         row % 2 == 0 ? 0.5 : 0.3);
  const Measurement result = testing::measurement_of(rows, {.layer_thickness = 1.6, .voronoi = true});
  const double large = pi / 4, small = pi * 0.09;
  // The radical line between rows touching at 1.0 lies there: cells 1 high, and 0.6.
  EXPECT_NEAR(testing::at(result, "nu_voronoi", 1), (large + small) / 1.6, 1e-12);
  EXPECT_NEAR(testing::at(result, "nu_grains", 1), (large + small / 0.6) / 2, 1e-12);
}

TEST(CellProfiles, IntervalsStandBesideThem) {
  std::vector<Snapshot> all;
  for (int s = 0; s < 30; ++s) {
    all.push_back(testing::stacked_columns(6, 10, 0));
    for (SnapshotContact& contact : all.back().contacts) contact.impulse_n *= 1 + 0.1 * std::sin(s);
  }
  const Measurement result = measurement(testing::source_of(all), {.voronoi = true});
  const ProfileColumn& stress = result.profiles.column("sigma_zz_grains");
  EXPECT_GT(stress.ci99[4], 0);
  EXPECT_NEAR(stress.ci99[4] / stress.value[4],
              result.profiles.column("sigma_zz").ci99[4] / testing::at(result, "sigma_zz", 4), 1e-9);
}

}  // namespace
}  // namespace drumlin
