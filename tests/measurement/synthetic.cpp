// Packings whose stresses, derivatives and statistics are known beforehand, through the whole measurement.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "particles/measurement/grains/grain_fields.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using std::numbers::pi;
using testing::add_grain;
using testing::at;
using testing::measurement_of;
using testing::source_of;

/// Small grains spread evenly over [-12, 12] x [0, 16], so that means over layers and slices are integrals.
/// Heights and places follow unrelated rules: each layer holds all places evenly.
Snapshot even_cloud() {
  Snapshot cloud;
  cloud.time_step = 1;
  constexpr int columns = 96, rows = 256;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      add_grain(cloud, -12 + (column + (row % 16 + 0.5) / 16) * 24 / columns, (row + 0.5) * 16 / rows, 0.02);
  return cloud;
}

/// The layer of a profile whose middle lies at the height z of the laboratory; the cloud has no surface, so
/// that z = 0 is the origin of the frame.
double value_at(const Measurement& result, const char* column, double z) {
  for (std::size_t l = 0; l < result.profiles.z.size(); ++l)
    if (std::abs(result.profiles.z[l] - z) < 1e-6) return at(result, column, l);
  ADD_FAILURE() << "no layer at " << z;
  return 0;
}

TEST(Derivatives, ShearRateIsOfSecondOrderInTheThickness) {
  Snapshot cloud = even_cloud();
  for (std::size_t i = 0; i < cloud.x.size(); ++i) cloud.v_x[i] = std::pow(cloud.z[i] / 4, 3);
  std::vector<double> error;
  for (const double thickness : {2.0, 1.0, 0.5}) {
    const double z = 8 + thickness / 2;
    error.push_back(value_at(measurement_of(cloud, {.layer_thickness = thickness}), "shear_rate", z) -
                    3 * z * z / 64);
    // v''' h^2 (1/6 + 1/24): the difference over two layers, and the mean over each (by 8 rows of grains or
    // more).
    const double expected = 6.0 / 64 * 5 / 24 * thickness * thickness;
    EXPECT_NEAR(error.back(), expected, 0.005 * expected);
  }
  EXPECT_NEAR(error[0] / error[1], 4, 0.02);
  EXPECT_NEAR(error[1] / error[2], 4, 0.02);
}

TEST(Derivatives, VorticityIsOfSecondOrderInTheWidth) {
  Snapshot cloud = even_cloud();
  for (std::size_t i = 0; i < cloud.x.size(); ++i) cloud.v_z[i] = std::pow(cloud.x[i] / 4, 3);
  for (const double width : {16.0, 8.0, 4.0}) {
    // Straight line through x^3 over -+w/2: its slope is 3/20 w^2, that of the curve in the middle 0.
    EXPECT_NEAR(value_at(measurement_of(cloud, {.slice_width = width}), "half_vorticity", 8.5),
                -0.5 * 3.0 / 20 * width * width / 64, 2e-3 * width * width / 64);
  }
}

TEST(Derivatives, AlongTheSurfaceTheyAreOfSecondOrderInWidthAndStep) {
  Snapshot cloud = even_cloud();
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    cloud.v_x[i] = cloud.x[i] / 8 + std::pow(cloud.x[i] / 4, 3);
    cloud.v_z[i] = cloud.x[i] * cloud.x[i] / 16;
  }
  for (const double width : {8.0, 4.0, 2.0}) {
    MeasurementOptions options;
    options.slice_width = width;
    options.gradient_step = width / 2;
    const Measurement result = measurement_of(cloud, options);
    const double step = *options.gradient_step;
    EXPECT_NEAR(value_at(result, "d_v_x_dx", 8.5) - 1.0 / 8, (step * step + width * width / 4) / 64, 1e-3);
    EXPECT_NEAR(value_at(result, "d_v_z_dx", 8.5), 0, 1e-10);  // a parabola has none in the middle
  }
}

/// Contacts of a hexagonal lattice, periodic in x: along x, up to the right and up to the left with the
/// normal forces and the friction (force along the tangent) of each direction.
Snapshot loaded_lattice(int columns, int rows, const std::array<double, 3>& normal,
                        const std::array<double, 3>& friction) {
  Snapshot lattice = testing::hexagonal_layer(columns, rows);
  const auto at = [&](int column, int row) { return row * columns + (column + columns) % columns; };
  const auto add = [&](int i, int j, double angle, int direction) {  // j lies at `angle` from i
    lattice.contacts.push_back({j, i, static_cast<float>(std::cos(angle)),
                                static_cast<float>(std::sin(angle)), normal[direction] * lattice.time_step,
                                friction[direction] * lattice.time_step});
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      add(at(column, row), at(column + 1, row), 0, 0);
      if (row + 1 == rows) continue;
      const int right = row % 2 == 0 ? column : column + 1;  // of the row above
      add(at(column, row), at(right, row + 1), pi / 3, 1);
      add(at(column, row), at(right - 1, row + 1), 2 * pi / 3, 2);
    }
  return lattice;
}

TEST(ForceNetwork, StressOfALoadedLatticeIsExact) {
  const std::array<double, 3> normal{0.7, 1.3, 0.4}, friction{0.1, -0.2, 0.05};
  const Snapshot lattice = loaded_lattice(8, 12, normal, friction);
  // Per grain one contact of each direction, length 1, cell sqrt(3)/2. The force on the upper or right grain
  // is N n + T t with t = (n_z, -n_x); b along n.
  double xx = 0, zz = 0, xz = 0;
  for (int direction = 0; direction < 3; ++direction) {
    const double n_x = std::cos(direction * pi / 3), n_z = std::sin(direction * pi / 3);
    const double f_x = normal[direction] * n_x + friction[direction] * n_z;
    const double f_z = normal[direction] * n_z - friction[direction] * n_x;
    const double cell = std::sqrt(3.0) / 2;
    xx += f_x * n_x / cell;
    zz += f_z * n_z / cell;
    xz -= f_x * n_z / cell;
  }
  constexpr double rounding = 1e-6;  // normals are stored in single precision
  const Measurement result =
      measurement_of(lattice, {.layer_thickness = std::sqrt(3.0) / 2, .voronoi = true});
  ASSERT_EQ(result.profiles.z.size(), 14u);  // slivers of the outer rows stand out of their layers
  for (std::size_t l = 2; l < 12; ++l)
    for (const char* suffix : {"", "_grains"}) {
      const auto value = [&](const char* name) { return at(result, std::string(name) + suffix, l); };
      EXPECT_NEAR(value("sigma_xx"), xx, rounding) << l << suffix;
      EXPECT_NEAR(value("sigma_zz"), zz, rounding) << l << suffix;
      EXPECT_NEAR(value("sigma_xz"), xz, rounding) << l << suffix;
    }

  const GrainFields fields = grain_fields(lattice, in_flow_frame(lattice));
  for (std::size_t i = 8; i < 88; ++i) {  // without the first and the last row
    EXPECT_NEAR(fields.contact.xx[i], xx, rounding);
    EXPECT_NEAR(fields.contact.zz[i], zz, rounding);
    EXPECT_NEAR(fields.contact.xz[i], xz, rounding);
    EXPECT_EQ(fields.coordination[i], 6);
  }
}

Snapshot sheared_layer(double rate, double depth) {
  Snapshot layer = testing::hexagonal_layer(3, 14);
  for (std::size_t i = 0; i < layer.x.size(); ++i)
    layer.v_x[i] = (0.1 + 0.02 * rate) * (layer.z[i] - 4 - 0.5 * depth);
  return layer;
}

/// A flow whose shear rate and depth wander about their means from snapshot to snapshot, each with the memory
/// of an AR(1) process, and whose grains have noise of their own.
std::vector<Snapshot> wandering_flow(std::size_t snapshots, double memory, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  std::vector<Snapshot> flow;
  double rate = normal(engine), depth = normal(engine);
  for (std::size_t s = 0; s < snapshots; ++s) {
    flow.push_back(sheared_layer(rate, depth));
    for (double& v : flow.back().v_x) v += 0.05 * normal(engine);
    const double kick = std::sqrt(1 - memory * memory);
    rate = memory * rate + kick * normal(engine);
    depth = memory * depth + kick * normal(engine);
  }
  return flow;
}

TEST(Coverage, IntervalsOfProfilesAndScalarsHoldTheTruthWhenSnapshotsAreCorrelated) {
  constexpr int runs = 200;
  constexpr std::size_t snapshots = 200, middle = 8;
  std::mt19937 engine(11);
  struct Tally {
    const char* name;
    double truth;
    std::vector<double> value, ci99;
  };
  // The mean flow has the mean rate and depth, which wander on their own.
  const Measurement mean_flow = measurement_of(sheared_layer(0, 0));
  Tally tallies[] = {{"v_x", at(mean_flow, "v_x", middle), {}, {}},
                     {"shear_rate", mean_flow.scalars.value("shear_rate"), {}, {}},
                     {"H", mean_flow.scalars.value("H"), {}, {}}};
  for (int run = 0; run < runs; ++run) {
    const Measurement result = measurement(source_of(wandering_flow(snapshots, 0.6, engine)), {});
    const ProfileColumn& v_x = result.profiles.column("v_x");
    tallies[0].value.push_back(v_x.value[middle]);
    tallies[0].ci99.push_back(v_x.ci99[middle]);
    for (int t : {1, 2}) {
      const Scalar* scalar = result.scalars.find(tallies[t].name);
      tallies[t].value.push_back(scalar->value);
      tallies[t].ci99.push_back(*scalar->ci99);
    }
  }
  for (const Tally& tally : tallies) {
    double spread = 0, width = 0;
    int inside = 0;
    for (int run = 0; run < runs; ++run) {
      inside += std::abs(tally.value[run] - tally.truth) <= tally.ci99[run] ? 1 : 0;
      spread += std::pow(tally.value[run] - tally.truth, 2) / (runs - 1);
      width += tally.ci99[run] / runs;
    }
    RecordProperty(tally.name, inside);
    // 99 % of 200 within three standard errors of a binomial count: 198 - 3 * 1.4.
    EXPECT_GE(inside, 194) << tally.name;
    // And not by being wide: a perfect interval has 2.58 standard deviations, Student's t for 10 - 1
    // degrees 3.25.
    EXPECT_LT(width / std::sqrt(spread), 4.0) << tally.name;
  }
}

}  // namespace
}  // namespace drumlin
