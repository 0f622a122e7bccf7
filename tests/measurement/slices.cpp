// Derivatives, slices of their own, and scalars by other windows.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::add_grain;
using testing::measurement_of;

constexpr int columns = 61, rows = 12;

/// Discs of diameter 1 on a square lattice about x = 0. Contacts between columns push with 2 + 0.01 x, those
/// between rows with 3; v_x = 0.02 x + 0.03 z, v_z = 0.
Snapshot pressed_block() {
  Snapshot block;
  block.time_step = 0.01;
  const auto grain_at = [](int column, int row) { return static_cast<std::int32_t>(row * columns + column); };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = column - (columns - 1) / 2.0, z = row + 0.5;
      add_grain(block, x, z, 0.5);
      block.v_x.back() = 0.02 * x + 0.03 * z;
      if (column > 0)
        block.contacts.push_back(
            {grain_at(column, row), grain_at(column - 1, row), 1, 0, 0.01 * (2 + 0.01 * (x - 0.5)), 0});
      if (row > 0)
        block.contacts.push_back({grain_at(column, row), grain_at(column, row - 1), 0, 1, 0.01 * 3, 0});
    }
  return block;
}

MeasurementOptions with_gradients() {
  MeasurementOptions options;
  options.gradient_step = 5;
  options.slice_width = 21;  // sides between the columns of the lattice
  return options;
}

TEST(Gradients, LinearFieldsGiveTheirSlopes) {
  const Measurement result = measurement_of(pressed_block(), with_gradients());
  const auto expect = [&](const std::string& name, double value, double tolerance) {
    const auto& column = result.profiles.column(name).value;
    for (std::size_t l = 2; l + 2 < column.size(); ++l) EXPECT_NEAR(column[l], value, tolerance) << name << l;
  };
  expect("d_sigma_xx_dx", 0.01, 1e-4);  // forces 2 + 0.01 x over layers of height 1
  expect("d_sigma_zz_dx", 0, 1e-9);
  expect("d_sigma_xz_dx", 0, 1e-9);
  expect("d_nu_dx", 0, 1e-9);
  expect("d_v_x_dx", 0.02, 1e-9);
  expect("d_v_z_dx", 0, 1e-12);
  expect("d_k_dx", 0.01 / 3, 1e-4);
  expect("d_sigma_xx_dz", 0, 1e-9);
}

TEST(Gradients, LinearFieldsDoNotMindTheStep) {
  MeasurementOptions options = with_gradients();
  options.sensitivity = true;
  const Measurement result = measurement_of(pressed_block(), options);
  int found = 0;
  for (const ScalarVariant& variant : result.variants) {
    if (variant.change.find("derivatives") == std::string::npos) continue;
    ++found;
    EXPECT_EQ(variant.scalars.find("H"), nullptr);
    EXPECT_NEAR(variant.scalars.value("dv_dx_flowing"), result.scalars.value("dv_dx_flowing"), 1e-9);
  }
  EXPECT_EQ(found, 2);
}

TEST(Gradients, StressOfAColumnFallsByItsWeightPerLayer) {
  const Measurement result = measurement_of(testing::stacked_columns(8, 20, 0), with_gradients());
  EXPECT_EQ(result.profiles.find("d_sigma_zz_dx"), nullptr);  // nothing varies along a period
  EXPECT_EQ(result.scalars.find("dk_dx"), nullptr);
}

TEST(Gradients, AreNotThereUnlessAskedFor) {
  const Measurement result = measurement_of(pressed_block());
  EXPECT_EQ(result.profiles.find("d_k_dx"), nullptr);
  EXPECT_EQ(result.scalars.find("dk_dx"), nullptr);
  EXPECT_TRUE(result.slices.empty());
  EXPECT_TRUE(result.variants.empty());
}

TEST(Slices, StandWhereTheyAreAskedForAndKnowTheirOwnSurface) {
  const Snapshot drum = testing::filled_drum(30, 2, 0.35, 0.02);
  const Measurement result = measurement_of(drum, {.slices = SlicesRequest{{-10, 12.5}, 4}});
  ASSERT_EQ(result.slices.size(), 2u);
  EXPECT_EQ(result.slices[1].position, 12.5);
  EXPECT_NEAR(result.slices[1].axis_depth, result.axis_depth, 0.3);  // the surface is straight
  EXPECT_NEAR(result.slices[1].wall_z, -std::sqrt(30 * 30 - 12.5 * 12.5) + result.slices[1].axis_depth, 1e-9);
  EXPECT_NEAR(result.slices[0].profiles.column("nu").value[20], std::numbers::pi / std::sqrt(12.0), 0.03);
}

TEST(Slices, SpreadOverTheSurfaceByThemselves) {
  const Measurement result =
      measurement_of(testing::filled_drum(30, 2, 0.35, 0.02), {.slices = SlicesRequest{}});
  ASSERT_EQ(result.slices.size(), 5u);
  EXPECT_NEAR(result.slices[4].position, 0.6 * std::sqrt(30.0 * 30 - 2 * 2), 0.2);
  EXPECT_NEAR(result.slices[2].position, 0, 1e-12);
}

TEST(Sensitivity, EveryVariantChangesOnlyWhatItsWindowReaches) {
  Snapshot drum = testing::filled_drum(30, 2, 0.35, 0.02);
  for (std::size_t i = 0; i < drum.x.size(); ++i) {
    const double x = drum.x[i] - drum.container_x, z = drum.z[i] - drum.container_z;
    const double depth = -2 - (z * std::cos(0.35) + x * std::sin(0.35));
    const double speed =
        0.02 * std::pow(std::max(0.0, 10 - depth), 2);  // curved: the range of the fit matters
    drum.v_x[i] += speed * std::cos(0.35);
    drum.v_z[i] -= speed * std::sin(0.35);
  }
  const Measurement result = measurement_of(drum, {.sensitivity = true});
  const auto value = [&](const std::string& change, const std::string& name) {
    for (const ScalarVariant& variant : result.variants)
      if (variant.change == change) return variant.scalars.value(name);
    ADD_FAILURE() << change;
    return 0.0;
  };
  const double H = result.scalars.value("H"), nu = result.scalars.value("nu_bulk");
  EXPECT_GT(value("straight line where v_x > 0.2 v_x(0)", "H"), H);
  EXPECT_EQ(value("straight line where v_x > 0.2 v_x(0)", "nu_bulk"), nu);
  EXPECT_NE(value("bulk 8 d from surface and wall", "nu_bulk"), nu);
  EXPECT_EQ(value("bulk 8 d from surface and wall", "H"), H);
  EXPECT_NEAR(value("slope over |x| < 10 d", "theta_deg"), 0.35 * 180 / std::numbers::pi, 1);
  EXPECT_NEAR(value("instantaneous velocity", "H"), H, 1e-9);  // no window is stored
}

}  // namespace
}  // namespace drumlin
