// The flow frame, the frame of the drum, and that the laboratory's axes do not matter.
#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::at;
using testing::filled_drum;
using testing::measurement_of;

constexpr double degrees = 180 / std::numbers::pi;

/// A drum whose surface layer flows and whose grains press on each other somehow.
Snapshot flowing_drum() {
  Snapshot drum = filled_drum(30, 2, 0.35, 0.02);
  drum.velocity_window = 0.3;
  for (std::size_t i = 0; i < drum.x.size(); ++i) {
    const double x = drum.x[i] - drum.container_x, z = drum.z[i] - drum.container_z;
    const double depth = -2 - (z * std::cos(0.35) + x * std::sin(0.35));
    const double speed = std::max(0.0, 0.1 * (10 - depth));
    drum.v_x[i] += speed * std::cos(0.35);
    drum.v_z[i] -= speed * std::sin(0.35);
    drum.spin[i] += 0.05;
    drum.displacement_x.push_back(drum.velocity_window * drum.v_x[i]);
    drum.displacement_z.push_back(drum.velocity_window * drum.v_z[i]);
    const double angle = 0.37 * static_cast<double>(i);
    drum.contacts.push_back({static_cast<std::int32_t>(i), i % 5 == 0 ? -1 : static_cast<std::int32_t>(i / 2),
                             static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                             0.01 + 0.001 * static_cast<double>(i % 7), 0.002 * std::sin(angle)});
  }
  return drum;
}

/// Tolerance: normals are stored in single precision.
void expect_same(const Measurement& a, const Measurement& b) {
  for (const Scalar& scalar : a.scalars.scalars)
    if (std::isfinite(scalar.value)) {
      EXPECT_NEAR(b.scalars.value(scalar.name), scalar.value, 1e-5 * (1 + std::abs(scalar.value)))
          << scalar.name;
    }
  ASSERT_EQ(a.profiles.z.size(), b.profiles.z.size());
  for (const ProfileColumn& column : a.profiles.columns)
    for (std::size_t l = 0; l < a.profiles.z.size(); ++l)
      if (std::isfinite(column.value[l])) {
        EXPECT_NEAR(at(b, column.name, l), column.value[l], 1e-4 + 1e-4 * std::abs(column.value[l]))
            << column.name << ' ' << l;
      }
}

TEST(Drums, SlopeAndDepthOfAStraightSurfaceAreFound) {
  for (double theta : {0.0, 0.2, 0.35}) {
    const Measurement result = measurement_of(filled_drum(40, 3, theta, 0.02));
    // A row of the lattice along the surface: cells of 1 d see it with a ripple of some 0.1 d over 40 d.
    EXPECT_NEAR(result.scalars.value("theta_deg"), theta * degrees, 0.3);
    EXPECT_NEAR(result.scalars.value("theta_com_deg"), theta * degrees, 0.1);
    EXPECT_NEAR(result.axis_depth, 3, 0.5);
    EXPECT_NEAR(result.wall_z, -40 + 3, 0.5);
    EXPECT_NEAR(result.scalars.value("nu_bulk"), std::numbers::pi / (2 * std::sqrt(3.0)), 0.01);
    EXPECT_EQ(result.place.source, FrameSource::isoline);
  }
}

TEST(Drums, RangesAreCutInASmallDrum) {
  const Measurement small = measurement_of(filled_drum(20, 3, 0.3, 0.02));
  const double half_chord = std::sqrt(400.0 - 9.0);
  EXPECT_NEAR(small.place.slice_width, half_chord / 2, 0.1);
  EXPECT_NEAR(small.slope_half_width, half_chord / 2, 0.1);
  const Measurement large = measurement_of(filled_drum(45, 3, 0.3, 0.02));
  EXPECT_EQ(large.place.slice_width, 20);
  EXPECT_EQ(large.slope_half_width, 20);
}

TEST(Drums, PackingThatTurnsWithTheDrumIsAtRest) {
  Snapshot drum = filled_drum(30, 2, 0.35, 0.02);
  const auto expect_rest = [](const Measurement& result) {
    for (const char* name : {"v_x", "v_z", "shear_rate", "half_vorticity", "omega", "dv", "domega",
                             "sigma_xx_kinetic", "sigma_zz_kinetic", "sigma_xz_kinetic", "sigma_rotational"})
      for (double value : result.profiles.column(name).value)
        if (std::isfinite(value)) {
          EXPECT_NEAR(value, 0, 1e-7) << name;  // root of a difference of equal squares
        }
  };
  expect_rest(measurement_of(drum));
  // The same from displacements over a long window, in which the drum turns by 2 degrees.
  drum.velocity_window = 1.7;
  const double angle = drum.wall_spin * drum.velocity_window;
  for (std::size_t i = 0; i < drum.x.size(); ++i) {
    const double x = drum.x[i] - drum.container_x, z = drum.z[i] - drum.container_z;
    drum.displacement_x.push_back(x - (x * std::cos(angle) - z * std::sin(angle)));
    drum.displacement_z.push_back(z - (z * std::cos(angle) + x * std::sin(angle)));
  }
  expect_rest(measurement_of(drum));
}

TEST(Drums, SpinOfGrainsThatRollWithTheFlowIsHalfTheVorticity) {
  Snapshot drum = filled_drum(40, 3, 0.3, 0.02);
  for (std::size_t i = 0; i < drum.x.size(); ++i) {
    const double x = drum.x[i] - drum.container_x, z = drum.z[i] - drum.container_z;
    const double speed = 0.1 * (20 + z * std::cos(0.3) + x * std::sin(0.3));
    if (speed < 0) continue;
    drum.v_x[i] += speed * std::cos(0.3);
    drum.v_z[i] -= speed * std::sin(0.3);
    drum.spin[i] += 0.05;
  }
  const Measurement result = measurement_of(drum);
  // Spin and vorticity both lose the drum's turn; rows of the lattice make the differences of layers uneven.
  EXPECT_NEAR(result.scalars.value("spin_over_half_vorticity"), 1, 0.03);
  EXPECT_NEAR(result.scalars.value("shear_rate"), 0.1, 0.003);
  EXPECT_NEAR(result.scalars.value("H"), 20 - result.axis_depth, 0.5);
}

TEST(Drums, AxesOfTheLaboratoryDoNotMatter) {
  const Snapshot drum = flowing_drum();
  const Measurement upright = measurement_of(drum);
  EXPECT_TRUE(std::isfinite(upright.scalars.value("H")));
  for (double angle : {0.7, -2.0}) expect_same(upright, measurement_of(testing::turned(drum, angle)));
}

TEST(Drums, DrumThatTurnsTheOtherWayIsSeenInAMirror) {
  const Snapshot drum = flowing_drum();
  const Measurement mirror_image = measurement_of(mirrored(drum));
  EXPECT_TRUE(mirror_image.place.in_mirror);
  expect_same(measurement_of(drum), mirror_image);
}

TEST(Drums, OnlyTheLastMotionOfTheWallIsMeasured) {
  std::vector<Snapshot> all;
  for (int s = 0; s < 9; ++s) {
    all.push_back(filled_drum(20, 2, 0.3, s < 4 ? 0.0 : 0.02));
    all.back().time = s;
    all.back().scales.time_s = 0.5;
  }
  const Measurement result = measurement(testing::source_of(all), {});
  EXPECT_EQ(result.first_snapshot, 4u);
  EXPECT_EQ(result.place.snapshots, 5u);
  EXPECT_EQ(result.first_time(), 4);
  EXPECT_EQ(result.place.batches, 5u);
  const double second = all.front().scales.time_s;
  EXPECT_EQ(measurement(testing::source_of(all), {.since_s = 6 * second}).first_time(), 6);
  EXPECT_EQ(measurement(testing::source_of(all), {.since_s = 1 * second}).first_time(), 4);
  EXPECT_THROW(measurement(testing::source_of(all), {.since_s = 8.5 * second}), InputError);
}

TEST(Drums, NothingToMeasureIsSaid) {
  EXPECT_THROW(measurement(SnapshotSource{0, {}}, {}), InputError);
  EXPECT_THROW(measurement_of(Snapshot{}), InputError);
  EXPECT_THROW(measurement_of(filled_drum(20, 2, 0.3, 0.02), {.position = 18}), InputError);
}

}  // namespace
}  // namespace drumlin
