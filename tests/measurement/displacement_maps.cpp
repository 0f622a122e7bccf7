// Motion from displacements between snapshots, of packings whose motion is known by hand.
#include <gtest/gtest.h>

#include "particles/measurement/maps/displacement_sums.hpp"
#include "particles/measurement/maps/field_maps.hpp"
#include "tests/measurement/collected_maps.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin::displacement_maps {
using namespace particles;
namespace {

using testing::collected_maps;

struct Gradient {
  double xx, xz, zx, zz;
};

/// Two snapshots of a square lattice of middles, whose grains move by a straight line of their middle: in
/// axes that turn clockwise from -`angle` to `angle` about the origin meanwhile.
std::vector<Snapshot> stretched_lattice(const Gradient& rate, double interval, double angle) {
  std::vector<Snapshot> ends(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = k == 0 ? -0.5 : 0.5, turn = k == 0 ? -angle : angle;
    ends[k].time_step = 0.01;
    ends[k].time = k == 0 ? 3 : 3 + interval;
    if (angle != 0) {
      ends[k].container_radius = 40;
      ends[k].wall_spin = 2 * angle / interval;
      ends[k].wall_angle = turn;
    }
    for (int column = 0; column < 16; ++column)
      for (int row = 0; row < 16; ++row) {
        const double x = column - 7.5, z = row - 7.5;
        const double end_x = x + side * interval * (rate.xx * x + rate.xz * z);
        const double end_z = z + side * interval * (rate.zx * x + rate.zz * z);
        testing::add_grain(ends[k], end_x * std::cos(turn) + end_z * std::sin(turn),
                           end_z * std::cos(turn) - end_x * std::sin(turn), 0.5);
      }
  }
  return ends;
}

void expect_gradient(const FieldMap& map, const Gradient& rate) {
  const auto inside = [](double x, double z) { return std::abs(x) <= 4.5 && std::abs(z) <= 4.5; };
  const int checked = testing::each_node(map, inside, [&](double x, double z, auto value) {
    EXPECT_NEAR(value("displacement_v_x"), rate.xx * x + rate.xz * z, 1e-12);
    EXPECT_NEAR(value("displacement_v_z"), rate.zx * x + rate.zz * z, 1e-12);
    EXPECT_NEAR(value("displacement_d_v_x_dx"), rate.xx, 1e-12);
    EXPECT_NEAR(value("displacement_d_v_x_dz"), rate.xz, 1e-12);
    EXPECT_NEAR(value("displacement_d_v_z_dx"), rate.zx, 1e-12);
    EXPECT_NEAR(value("displacement_D_zz"), rate.zz, 1e-12);
    EXPECT_NEAR(value("displacement_D_xz"), (rate.xz + rate.zx) / 2, 1e-12);
    EXPECT_NEAR(value("displacement_dilation"), rate.xx + rate.zz, 1e-12);
    EXPECT_NEAR(value("displacement_half_vorticity"), (rate.xz - rate.zx) / 2, 1e-12);
    EXPECT_NEAR(
        value("displacement_strain_rate"),
        2 * std::sqrt(
                (rate.xx * rate.xx + rate.zz * rate.zz + (rate.xz + rate.zx) * (rate.xz + rate.zx) / 2) / 2),
        1e-12);
  });
  EXPECT_GT(checked, 60);
}

const CoarseGraining lattice_graining = coarse_graining(FlowFrame{}, -8, 8, -8, 8, 1, 1, 0);

TEST(DisplacementMaps, StraightDisplacementsHaveTheirGradientWithoutTheTurnOfTheDrum) {
  const Gradient rate{0.01, 0.02, -0.005, 0.003};
  for (const double angle : {0.0, 0.4})
    expect_gradient(collected_maps(lattice_graining, stretched_lattice(rate, 2, angle)), rate);
}

TEST(DisplacementMaps, GrainsAreFollowedAcrossAPeriodicBoundary) {
  // 2.25 periods in one interval: the velocity says how often a grain went round.
  Snapshot from = testing::hexagonal_layer(12, 12), to;
  for (double& v : from.v_x) v = 0.27;
  to = from;
  to.time = 100;
  for (double& x : to.x) x = std::fmod(x + 27, 12);
  CoarseGraining wide = coarse_graining(FlowFrame{}, 0, 12, 0, 10, 1, 15, 12);
  DisplacementDepositor follower(wide);
  MapSums sums = empty_sums(wide);
  follower.add(from, sums);
  follower.add(to, sums);
  ASSERT_EQ(sums.snapshots.pairs, 1);
  for (std::size_t node = 0; node < sums.nodes.size(); ++node)
    EXPECT_NEAR(sums.nodes[node].displaced.mean(1), 0.27, 1e-12);
}

TEST(DisplacementMaps, MotionOverMoreThanHalfAWidthIsNotCalledLocal) {
  const FieldMap map = collected_maps(lattice_graining, stretched_lattice({0, 0.1, 0, 0}, 2, 0));
  const auto at = [&](double z) {
    const auto row = static_cast<std::size_t>(std::lround(z - map.grid.z_first));
    return map.field("displacement_v_x").value[row * map.grid.columns + 8];
  };
  EXPECT_TRUE(std::isfinite(at(2.5)));  // moves by 0.5 d
  EXPECT_TRUE(std::isnan(at(3.5)));     // by 0.7 d
}

TEST(DisplacementMaps, OneSnapshotOrOtherGrainsGiveNoFields) {
  std::vector<Snapshot> ends = stretched_lattice({0.01, 0, 0, 0}, 2, 0);
  EXPECT_EQ(collected_maps(lattice_graining, {ends[0]}).find("displacement_v_x"), nullptr);
  testing::add_grain(ends[1], 0, 0, 0.5);
  EXPECT_EQ(collected_maps(lattice_graining, ends).find("displacement_v_x"), nullptr);
}

}  // namespace
}  // namespace drumlin::displacement_maps
