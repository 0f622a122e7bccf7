// Fields of packings that are known by hand.
#include "particles/measurement/maps/field_maps.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "coupling/core/results/quantities.hpp"
#include "particles/measurement/layers/profile.hpp"
#include "particles/measurement/maps/field_values.hpp"
#include "coupling/core/results/spline_kernel.hpp"
#include "tests/measurement/collected_maps.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::collected_maps;

/// Discs of diameter 1 on a square lattice over 16 x 16: a kernel of width 1 reproduces straight lines on it.
Snapshot square_lattice(const std::function<std::array<double, 2>(double, double)>& velocity) {
  Snapshot snapshot;
  snapshot.time_step = 0.01;
  for (int column = 0; column < 16; ++column)
    for (int row = 0; row < 16; ++row) {
      const double x = column - 7.5, z = row - 7.5;
      testing::add_grain(snapshot, x, z, 0.5);
      const auto v = velocity(x, z);
      snapshot.v_x.back() = v[0];
      snapshot.v_z.back() = v[1];
    }
  return snapshot;
}

/// Calls check(x, z, value of a field by name) at the nodes more than 2.5 d inside the square lattice.
template <class Check>
void each_inner_node(const FieldMap& map, Check check) {
  const auto inside = [](double x, double z) { return std::abs(x) <= 5.5 && std::abs(z) <= 5.5; };
  EXPECT_GT(testing::each_node(map, inside, check), 100);
}

CoarseGraining lattice_graining(double spacing = 1) {
  return coarse_graining(FlowFrame{}, -8, 8, -8, 8, spacing, 1, 0);
}

TEST(FieldMaps, StraightVelocityFieldsHaveTheirGradient) {
  const FieldMap map = collected_maps(lattice_graining(0.5), {square_lattice([](double x, double z) {
                                        return std::array{1 + 0.3 * x + 0.7 * z, -0.2 * x - 0.1 * z};
                                      })});
  each_inner_node(map, [](double x, double z, auto value) {
    EXPECT_NEAR(value("nu"), std::numbers::pi / 4, 1e-12);
    EXPECT_NEAR(value("number_density"), 1, 1e-12);
    EXPECT_NEAR(value("v_x"), 1 + 0.3 * x + 0.7 * z, 1e-12);
    EXPECT_NEAR(value("v_z"), -0.2 * x - 0.1 * z, 1e-12);
    EXPECT_NEAR(value("d_v_x_dx"), 0.3, 1e-12);
    EXPECT_NEAR(value("d_v_x_dz"), 0.7, 1e-12);
    EXPECT_NEAR(value("d_v_z_dx"), -0.2, 1e-12);
    EXPECT_NEAR(value("d_v_z_dz"), -0.1, 1e-12);
    EXPECT_NEAR(value("half_vorticity"), 0.45, 1e-12);
    EXPECT_NEAR(value("strain_rate"), 2 * std::sqrt((0.09 + 2 * 0.0625 + 0.01) / 2), 1e-12);
    // What the kernel sees of the gradient itself: width^2/3 of its squares.
    EXPECT_NEAR(value("sigma_xx_kinetic"), std::numbers::pi / 4 * (0.09 + 0.49) / 3, 1e-12);
  });
}

TEST(FieldMaps, CurvedVelocityFieldsAreSmoothedByTheVarianceOfTheKernel) {
  const FieldMap map = collected_maps(lattice_graining(), {square_lattice([](double, double z) {
                                        return std::array{z * z * z, z * z};
                                      })});
  EXPECT_TRUE(map.field("v_x").ci99.empty());  // of one batch
  each_inner_node(map, [](double, double z, auto value) {
    EXPECT_NEAR(value("v_z"), z * z + 1.0 / 3, 1e-11);
    EXPECT_NEAR(value("d_v_z_dz"), 2 * z, 1e-11);
    EXPECT_NEAR(value("d_v_x_dz"), 3 * z * z + 1, 1e-10);  // 3 (z^2 + 1/3)
  });
}

TEST(FieldMaps, PackingAtRestInATurningDrumDoesNotMove) {
  const double spin = 0.02, radius = 12;
  const Snapshot snapshot = testing::filled_drum(radius, 2, 0.3, spin);
  const FlowFrame frame = frame_at_slope(3, -2, 0, -1, 0.3);
  const FieldMap map =
      collected_maps(coarse_graining(frame, -radius, radius, -radius, radius, 1, 1, 0), {snapshot}, radius);
  const auto where = [&](auto inside) {
    return [=](double x, double z) { return inside(std::hypot(x, z), z); };
  };
  testing::each_node(map, where([=](double r, double) { return r > radius; }),
                     [](double, double, auto value) { EXPECT_TRUE(std::isnan(value("nu"))); });
  testing::each_node(map, where([=](double r, double z) { return r <= radius && z > 1.5; }),
                     [](double, double, auto value) {
                       EXPECT_EQ(value("nu"), 0);
                       EXPECT_TRUE(std::isnan(value("v_x")));
                     });
  const int grains =
      testing::each_node(map, where([=](double r, double z) { return r < radius - 3 && z < -4; }),
                         [](double, double, auto value) {
                           EXPECT_NEAR(value("v_x"), 0, 1e-14);
                           EXPECT_NEAR(value("omega"), 0, 1e-14);
                           EXPECT_NEAR(value("strain_rate"), 0, 1e-13);
                           EXPECT_NEAR(value("nu"), std::numbers::pi / (2 * std::sqrt(3.0)), 0.02);
                         });
  EXPECT_GT(grains, 50);
}

/// Columns at rest; every second grain is `heavy` times as dense, and contacts carry what lies above them.
Snapshot layered_columns(double heavy, double slope) {
  Snapshot snapshot = testing::stacked_columns(6, 20, slope);
  std::vector<double> above(21);
  for (int level = 19; level >= 0; --level)
    above[level] = above[level + 1] + (level % 2 == 0 ? 1 : heavy) * std::numbers::pi / 4;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    snapshot.mass.push_back(above[i % 20] - above[i % 20 + 1]);
    const double impulse = above[i % 20] * snapshot.time_step;
    snapshot.contacts[i].impulse_n = impulse * std::cos(slope);
    snapshot.contacts[i].impulse_t = -impulse * std::sin(slope);
  }
  return snapshot;
}

TEST(FieldMaps, ColumnsUnderTheirWeightAreBalancedToRounding) {
  // Across the whole height, floor and surface included: the force of the floor is part of the balance.
  for (const Snapshot& columns : {testing::stacked_columns(6, 20, 0.3), layered_columns(3, 0.3)})
    for (double width : {1.0, 1.7, 3.0}) {
      const FieldMap map =
          collected_maps(coarse_graining(FlowFrame{}, 0, 6, -4, 24, 0.5, width, 6), {columns});
      int nodes = 0;
      for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
        const double x = map.field("residual_x").value[node], z = map.field("residual_z").value[node];
        if (std::isnan(x)) continue;
        ++nodes;
        EXPECT_NEAR(x, 0, 1e-10);
        EXPECT_NEAR(z, 0, 1e-10);
      }
      EXPECT_GT(nodes, 12 * 38);
    }
}

TEST(FieldMaps, EachHeightOfAColumnCarriesTheWeightAbove) {
  const double slope = 0.3;
  const FieldMap map = collected_maps(coarse_graining(FlowFrame{}, 0, 6, 0, 20, 0.5, 1, 6),
                                      {testing::stacked_columns(6, 20, slope)});
  const double weight = std::numbers::pi / 4;
  // The kernel stays among grains with two contacts.
  const auto inside = [](double, double z) { return z >= 3 && z <= 17; };
  testing::each_node(map, inside, [&](double, double z, auto value) {
    const double depth = 20 - z;
    // 1e-3: the quadrature along branches; the jumps of the force from disc to disc average out exactly.
    EXPECT_NEAR(value("sigma_zz") / (weight * depth * std::cos(slope)), 1, 2e-3);
    EXPECT_NEAR(value("sigma_xz") / (weight * depth * std::sin(slope)), 1, 2e-3);
    EXPECT_NEAR(value("fabric_zz"), 1, 1e-12);
    EXPECT_NEAR(value("coordination"), 2, 1e-12);
  });
}

TEST(FieldMaps, VelocitiesThatChangeFromSnapshotToSnapshotAreKineticStress) {
  const double u = 0.4;
  const auto moving = [&](double sign) {
    return square_lattice([=](double, double) { return std::array{sign * u, -sign * u / 2}; });
  };
  const FieldMap map = collected_maps(lattice_graining(), {moving(1), moving(-1)});
  each_inner_node(map, [&](double, double, auto value) {
    EXPECT_NEAR(value("v_x"), 0, 1e-14);
    EXPECT_NEAR(value("sigma_xx_kinetic"), std::numbers::pi / 4 * u * u, 1e-12);
    EXPECT_NEAR(value("sigma_xz_kinetic"), std::numbers::pi / 4 * u * u / 2, 1e-12);
    EXPECT_NEAR(value("sigma_xx"), value("sigma_xx_kinetic"), 1e-14);
  });
}

TEST(FieldMaps, TurningTheLaboratoryChangesNothing) {
  Snapshot snapshot = testing::filled_drum(10, 1, 0.3, 0.02);
  for (std::size_t i = 0; i + 1 < snapshot.x.size(); i += 3) {
    const auto k = static_cast<std::int32_t>(i);
    snapshot.contacts.push_back({k, k + 1, 0.6f, 0.8f, 0.01 * (1 + static_cast<double>(i)), 0.004});
    snapshot.v_x[i] += 0.1 * std::sin(static_cast<double>(i));
  }
  const auto map_of = [](const Snapshot& s) {
    const FlowFrame frame = frame_at_slope(s.container_x, s.container_z, s.gravity_x, s.gravity_z, 0.3);
    return collected_maps(coarse_graining(frame, -10, 10, -10, 10, 1, 1.5, 0), {s}, 10);
  };
  const FieldMap a = map_of(snapshot), b = map_of(testing::turned(snapshot, 1.1));
  for (std::size_t f = 0; f < a.fields.size(); ++f)
    for (std::size_t node = 0; node < a.grid.nodes(); ++node) {
      const double one = a.fields[f].value[node], other = b.fields[f].value[node];
      ASSERT_EQ(std::isnan(one), std::isnan(other)) << a.fields[f].name;
      // The normals of contacts are stored as floats.
      if (std::isnan(one)) continue;
      ASSERT_NEAR(one, other, 2e-6 * (1 + std::abs(one))) << a.fields[f].name;
    }
}

/// Grains of two densities, one of them moved and pushed against a wall and against its neighbour.
Snapshot few_grains_of_two_densities() {
  Snapshot snapshot;
  snapshot.time_step = 0.5;
  const double places[][3] = {{0.1, -0.2, 0.5}, {0.9, 0.3, 0.45}, {-0.6, 0.4, 0.55}};
  const double velocities[][2] = {{1, 0.5}, {-2, 0.25}, {0.5, -1}};
  for (std::size_t i = 0; i < 3; ++i) {
    testing::add_grain(snapshot, places[i][0], places[i][1], places[i][2]);
    snapshot.v_x.back() = velocities[i][0];
    snapshot.v_z.back() = velocities[i][1];
    const double density = i == 1 ? 7.5 : 1;
    snapshot.mass.push_back(density * std::numbers::pi * places[i][2] * places[i][2]);
  }
  snapshot.contacts = {{1, 0, 0.8f, 0.6f, 0.3, -0.1}, {2, -1, 0, 1, 0.2, 0.05}};
  return snapshot;
}

TEST(FieldMaps, OfSeveralDensitiesAreDirectSumsWithEachGrainsOwnMass) {
  const Snapshot snapshot = few_grains_of_two_densities();
  const CoarseGraining graining = coarse_graining(FlowFrame{}, -1, 1, -1, 1, 0.5, 1, 0);
  const FieldMap map = collected_maps(graining, {snapshot});
  // The contact part alone, of the same grains at rest: it takes no mass.
  Snapshot resting = snapshot;
  resting.v_x.assign(3, 0);
  resting.v_z.assign(3, 0);
  const FieldMap contacts = collected_maps(graining, {resting});
  std::size_t nodes = 0;
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double x = map.grid.x_of(node % map.grid.columns), z = map.grid.z_of(node / map.grid.columns);
    double area = 0, m = 0, m_x = 0, m_z = 0, xx = 0, xz = 0, zz = 0, slope = 0, m_slope = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double phi = spline(x - snapshot.x[i]) * spline(z - snapshot.z[i]);
      const double phi_z = spline(x - snapshot.x[i]) * spline_slope(z - snapshot.z[i]);
      const double own = snapshot.mass[i], v_x = snapshot.v_x[i], v_z = snapshot.v_z[i];
      area += std::numbers::pi * snapshot.radius[i] * snapshot.radius[i] * phi;
      m += own * phi, m_x += own * v_x * phi, m_z += own * v_z * phi;
      xx += own * v_x * v_x * phi, xz += own * v_x * v_z * phi, zz += own * v_z * v_z * phi;
      slope += own * v_x * phi_z, m_slope += own * phi_z;
    }
    if (area < least_map_nu) continue;
    ++nodes;
    const auto value = [&](const char* name) { return map.field(name).value[node]; };
    EXPECT_NEAR(value("nu"), area, 1e-12);
    EXPECT_NEAR(value("density"), m, 1e-12);
    EXPECT_NEAR(value("v_x"), m_x / m, 1e-12);
    EXPECT_NEAR(value("v_z"), m_z / m, 1e-12);
    EXPECT_NEAR(value("d_v_x_dz"), (slope - m_x / m * m_slope) / m, 1e-12);
    EXPECT_NEAR(value("sigma_xx_kinetic"), xx - m_x * m_x / m, 1e-12);
    EXPECT_NEAR(value("sigma_zz_kinetic"), zz - m_z * m_z / m, 1e-12);
    EXPECT_NEAR(value("sigma_xz_kinetic"), -(xz - m_x * m_z / m), 1e-12);
    EXPECT_NEAR(value("sigma_zz"), contacts.field("sigma_zz").value[node] + zz - m_z * m_z / m, 1e-12);
  }
  EXPECT_GT(nodes, 10u);
}

TEST(FieldMaps, AreasAreToldApartFromTheFirstDenseSnapshotOn) {
  const Snapshot dense = few_grains_of_two_densities();
  Snapshot plain = dense;
  plain.mass.clear();
  const CoarseGraining graining = coarse_graining(FlowFrame{}, -1, 1, -1, 1, 0.5, 1, 0);
  const FieldMap both = collected_maps(graining, {plain, dense}),
                 turned = collected_maps(graining, {dense, plain}),
                 none = collected_maps(graining, {plain, plain});
  EXPECT_EQ(none.find("density"), nullptr);
  for (std::size_t node = 0; node < both.grid.nodes(); ++node) {
    EXPECT_NEAR(both.field("nu").value[node], none.field("nu").value[node], 1e-12);
    if (both.field("nu").value[node] < least_map_nu) continue;
    EXPECT_NEAR(both.field("density").value[node], turned.field("density").value[node], 1e-12);
    EXPECT_NEAR(both.field("nu").ci99[node], 0, 1e-9);
    EXPECT_GT(both.field("density").value[node], both.field("nu").value[node]);
  }
}

TEST(Quantities, HaveWordsInTheTableWhateverIsMeasured) {
  for (const auto& list : {layer_quantities(), ring_quantities(), height_quantities(), width_quantities()})
    for (const LayerQuantity& column : list)
      EXPECT_NE(quantity_words(column.name).meaning, "") << column.name;
  for (const MapQuantity& field : known_fields({1, 1, 1, 1, 0, 0, 1, 1})) {
    EXPECT_NE(quantity_words(field.name).meaning, "") << field.name;
    EXPECT_EQ(field.period, std::string(field.name).ends_with("axis_angle_deg") ? 180 : 0) << field.name;
  }
  for (const Quantity& row : quantities()) {
    EXPECT_NE(row.meaning, "") << row.name;
    EXPECT_EQ(row.name.find("NAME") == row.name.npos, row.meaning.find("NAME") == row.meaning.npos)
        << row.name;
  }
  const QuantityWords made = quantity_words("log10_I_particles");
  EXPECT_EQ(made.unit, "decades");
  EXPECT_EQ(made.meaning, "decimal logarithm of the inertial number, of the particles");
  EXPECT_EQ(quantity_words("weight_particles").meaning, "");
}

TEST(Temperature, OverThePressureOfAGasIsOneOverNuAndUnderAWeightItsShare) {
  const FieldMap gas = collected_maps(lattice_graining(), {square_lattice([](double x, double z) {
                                        return std::array{0.3 * x, z};
                                      })});
  each_inner_node(gas, [](double, double, auto value) {
    EXPECT_NEAR(value("temperature_over_p"), 1 / value("nu"), 1e-12);
  });
  Snapshot columns = testing::stacked_columns(6, 20, 0);
  const double u = 0.5, w = 2;
  for (std::size_t i = 0; i < columns.x.size(); ++i)
    columns.v_x[i] = (i / 20 % 2 == 0 ? u : -u), columns.v_z[i] = (i / 20 % 2 == 0 ? w : -w);
  const Measurement layers = testing::measurement_of(columns);
  // T = (u^2 + w^2)/2, p = nu T + half of the weight above, nu = pi/4.
  for (std::size_t l = 0; l < 20; ++l)
    EXPECT_NEAR(testing::at(layers, "temperature_over_p", l),
                (u * u + w * w) / (std::numbers::pi / 4 * (u * u + w * w + 19.5 - static_cast<double>(l))),
                1e-12);
  for (Snapshot still : {testing::stacked_columns(6, 20, 0), testing::hexagonal_layer(4, 4)}) {
    const double expected = still.contacts.empty() ? std::nan("") : 0;  // no pressure, no temperature over it
    const double found = testing::at(testing::measurement_of(still), "temperature_over_p", 2);
    EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected))) << found;
  }
}

}  // namespace
}  // namespace drumlin
