// Spheres: closed forms of a lattice, of a column under its weight and of a uniform shear; bins that add up
// to the whole; and a slab of discs taken for spheres, which measures as discs do.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/maps/map_sums.hpp"
#include "particles/measurement/spheres/space_layers.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using std::numbers::pi;
constexpr double exact = 1e-12;

Snapshot no_spheres(double period_x, double depth) {
  Snapshot s;
  s.time_step = 1;
  s.period_x = period_x;
  s.spheres.emplace().depth = depth;
  return s;
}

void add_sphere(Snapshot& s, double x, double y, double z, double radius, const std::array<double, 3>& v) {
  s.x.push_back(x), s.z.push_back(z), s.radius.push_back(radius);
  s.v_x.push_back(v[0]), s.v_z.push_back(v[2]);
  s.spheres->y.push_back(y), s.spheres->v_y.push_back(v[1]);
}

/// Anything between anything: what holds for any network of forces holds for this one.
Snapshot random_spheres(double side, double depth) {
  Snapshot s = no_spheres(side, depth);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(0, side), across(0, depth), height(2, 10), size(0.3, 0.7),
      any(-1, 1);
  constexpr std::int32_t count = 300;
  for (std::int32_t i = 0; i < count; ++i) {
    add_sphere(s, along(random), across(random), height(random), size(random),
               {any(random), any(random), any(random)});
    SphereContact contact{i, i % 5 == 0 ? -1 : (i + 7) % count, {any(random), any(random), any(random)}, {}};
    const auto [a, b, c] = contact.normal;
    for (double& n : contact.normal) n /= std::sqrt(a * a + b * b + c * c);
    for (double& f : contact.force) f = any(random);
    s.spheres->contacts.push_back(contact);
  }
  return s;
}

/// All grains in layers that hold them whole.
LayerGrid whole_grid(double period, double thickness, double z_to) {
  return layer_grid(FlowFrame{}, 0, period, thickness, 0, z_to, 0, period);
}

SpaceSums space_sums(const LayerGrid& grid, const Snapshot& snapshot) {
  SpaceSums sums{std::vector<SpaceSum>(grid.layers())};
  add_snapshot(grid, snapshot, in_flow_frame(snapshot), sums);
  return sums;
}

double number(const ProfileSet& profiles, const char* column, std::size_t layer) {
  return profiles.column(column).value.at(layer);
}

ProfileSet profiles_of(const LayerGrid& grid, const Snapshot& snapshot) {
  SpaceLayers layers = empty_space_layers(grid, 1);
  add_snapshot(grid, snapshot, in_flow_frame(snapshot), layers.batches[0]);
  return space_profiles(layers, 0);
}

/// `above[level]`: force on each grain of a level from its upper neighbour, components x, z, y; from its
/// lower one it is that plus its weight. Along x and y neighbours push with `p_x` and `p_y`.
Snapshot cubic_lattice(int side, int levels, double p_x, double p_y, const std::vector<double>& above,
                       double drag) {
  Snapshot s = no_spheres(side, side);
  const auto index = [&](int a, int b, int c) {
    return (c * side + (b + side) % side) * side + (a + side) % side;
  };
  for (int c = 0; c < levels; ++c)
    for (int b = 0; b < side; ++b)
      for (int a = 0; a < side; ++a) {
        add_sphere(s, a + 0.5, b + 0.5, c + 0.5, 0.5, {0.3 * (c + 0.5), 0, 0});
        auto& contacts = s.spheres->contacts;
        const std::int32_t i = index(a, b, c);
        contacts.push_back({index(a + 1, b, c), i, {1, 0, 0}, {p_x, 0, 0}});
        contacts.push_back({index(a, b + 1, c), i, {0, 0, 1}, {0, 0, p_y}});
        if (c + 1 < levels) contacts.push_back({index(a, b, c + 1), i, {0, 1, 0}, {drag, above[c], 0}});
        if (c == 0) contacts.push_back({i, -1, {0, 1, 0}, {drag, above[0] + pi / 6, 0}});
        if (c + 1 == levels) contacts.push_back({i, -2, {0, -1, 0}, {-drag, -above[c], 0}});
      }
  return s;
}

TEST(Spheres, CubicLatticeHasTheStressOfItsForces) {
  // Each layer is one level, each cell 1 x 1 x 1: sums of F_a b_b are the stress. The forces along z are 3
  // and 3 + weight, of which a level bears the mean.
  const std::vector<double> above(5, 3.0);
  const Snapshot s = cubic_lattice(4, 5, 1, 2, above, -0.4);
  const ProfileSet p = profiles_of(whole_grid(4, 1, 5), s);
  ASSERT_EQ(p.z.size(), 5u);
  for (std::size_t l = 1; l < 4; ++l) {
    EXPECT_NEAR(number(p, "nu", l), pi / 6, exact);
    EXPECT_NEAR(number(p, "coordination", l), 6, exact);
    EXPECT_NEAR(number(p, "sigma_xx", l), 1, exact);
    EXPECT_NEAR(number(p, "sigma_yy", l), 2, exact);
    EXPECT_NEAR(number(p, "sigma_zz", l), 3, exact);
    EXPECT_NEAR(number(p, "sigma_xz", l), 0.4, exact);  // dragged forward by its upper neighbour
    EXPECT_NEAR(number(p, "sigma_xy", l), 0, exact);
    EXPECT_NEAR(number(p, "N1_over_p", l), -1, exact);
    EXPECT_NEAR(number(p, "N2_over_p", l), 0.5, exact);
    for (const char* fabric : {"fabric_xx", "fabric_yy", "fabric_zz"})
      EXPECT_NEAR(number(p, fabric, l), 1.0 / 3, exact);
  }
}

TEST(Spheres, ColumnBearsItsWeight) {
  constexpr int levels = 8;
  std::vector<double> above;
  for (int c = 0; c < levels; ++c) above.push_back(pi / 6 * (levels - 1 - c));
  Snapshot s = cubic_lattice(3, levels, 0, 0, above, 0);
  const ProfileSet p = profiles_of(whole_grid(3, 1, levels), s);
  for (std::size_t l = 0; l < levels; ++l) {
    const double depth = levels - (static_cast<double>(l) + 0.5);
    // Its half branches bear what lies above it, and that with its own weight: in the mean the weight above
    // the middle of the layer.
    EXPECT_NEAR(number(p, "sigma_zz", l), pi / 6 * depth, exact) << l;
  }
}

TEST(Spheres, UniformShearIsNoFluctuation) {
  const Snapshot s = cubic_lattice(4, 6, 1, 1, std::vector<double>(6, 1.0), 0);
  const ProfileSet p = profiles_of(whole_grid(4, 2, 6), s);  // two levels in each layer
  EXPECT_NEAR(number(p, "shear_rate", 1), 0.3, exact);
  EXPECT_NEAR(number(p, "temperature", 1), 0, exact);
  EXPECT_NEAR(number(p, "I_invariant", 1), 0.3 / std::sqrt(number(p, "p_space", 1)), exact);
  EXPECT_NEAR(number(p, "mu_invariant", 1), 0, 1e-6);
}

TEST(Spheres, BinsAddUpToTheWhole) {
  const double side = 12, depth = 5;
  const Snapshot s = random_spheres(side, depth);
  double volume = 0, momentum = 0, momentum_y = 0;
  Tensor<3> force_branch{};
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double v = 4 * pi / 3 * std::pow(s.radius[i], 3);
    volume += v, momentum += v * s.v_x[i], momentum_y += v * s.spheres->v_y[i];
  }
  for (const SphereContact& c : s.spheres->contacts) {
    const double reach =
        s.radius[static_cast<std::size_t>(c.i)] + (c.j < 0 ? 0 : s.radius[static_cast<std::size_t>(c.j)]);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) force_branch[a][b] += c.force[a] * reach * c.normal[b];
  }
  for (const double thickness : {1.0, 0.37}) {
    const SpaceSums sums = space_sums(whole_grid(side, thickness, 12.2), s);
    SpaceSum whole;
    for (const SpaceSum& layer : sums.layers) add_times(1, layer, whole);
    EXPECT_NEAR(whole.solid, volume, exact * volume);
    EXPECT_NEAR(whole.grains, 300, exact);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) EXPECT_NEAR(whole.force_branch[a][b], force_branch[a][b], 1e-11);
  }
  // Seen along y: per depth, in layers, rings and at nodes.
  const FlowSnapshot seen = in_flow_frame(s);
  for (const LayerGrid& grid : {whole_grid(side, 0.61, 12.2), ring_grid(side / 2, 6, 1.3, 40, 0)}) {
    const FlowSnapshot in_grid = in_flow_frame(s, grid.frame);
    LayerSums sums{std::vector<LayerSum>(grid.layers()), {}};
    add_snapshot(grid, in_grid, sums);
    double solid = 0, trace = 0;
    for (const LayerSum& layer : sums.layers)
      solid += layer.solid, trace += layer.force_branch[0][0] + layer.force_branch[1][1];
    EXPECT_NEAR(solid, volume / depth, (grid.rings ? 1e-7 : exact) * volume);
    EXPECT_NEAR(trace, (force_branch[0][0] + force_branch[1][1]) / depth, 1e-11);
  }
  const CoarseGraining graining = coarse_graining(FlowFrame{}, 0, side, -3, 15, 0.5, 1, side);
  MapSums maps = empty_sums(graining);
  add_snapshot(graining, s, seen, maps);
  double solid = 0, moved = 0, trace = 0;
  AcrossNode across;
  for (std::size_t node = 0; node < maps.nodes.size(); ++node) {
    add_times(0.25, maps.across[node], across);
    solid += maps.nodes[node].solid / 4, moved += maps.nodes[node].motion.first[0] / 4;
    trace += (maps.nodes[node].force_branch[0][0] + maps.nodes[node].force_branch[1][1]) / 4;
  }
  EXPECT_NEAR(solid, volume / depth, exact * volume);
  EXPECT_NEAR(moved, momentum / depth, exact * volume);
  EXPECT_NEAR(trace, (force_branch[0][0] + force_branch[1][1]) / depth, 1e-10);
  EXPECT_NEAR(across.motion.first[2], momentum_y / depth, exact * volume);
  EXPECT_NEAR(across.yy, force_branch[2][2] / depth, 1e-10);
  EXPECT_NEAR(across.xy, force_branch[0][2] / depth, 1e-10);
  EXPECT_NEAR(across.yz, force_branch[2][1] / depth, 1e-10);
}

TEST(Spheres, TheViewHasTheStressOfSpace) {
  const Snapshot s = random_spheres(12, 5);
  const LayerGrid grid = whole_grid(12, 1, 12);
  const SpaceSums space = space_sums(grid, s);
  LayerSums view{std::vector<LayerSum>(grid.layers()), {}};
  add_snapshot(grid, in_flow_frame(s), view);
  for (std::size_t l = 0; l < grid.layers(); ++l) {
    EXPECT_NEAR(view.layers[l].solid * 5, space.layers[l].solid, 1e-11);
    EXPECT_EQ(view.layers[l].contacts, space.layers[l].contacts);
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(view.layers[l].motion.first[a], space.layers[l].motion.first[a], 1e-11);
      for (int b = 0; b < 2; ++b)
        EXPECT_NEAR(view.layers[l].force_branch[a][b] * 5, space.layers[l].force_branch[a][b], 1e-11);
    }
  }
}

TEST(Spheres, SlabOfDiscsTakenForSpheresMeasuresAsDiscs) {
  // Discs of one radius r, and spheres in their places in a slab 4r/3 deep, whose mass per depth is theirs.
  constexpr double radius = 0.5, depth = 4 * radius / 3;
  Snapshot discs;
  discs.time_step = 1;
  discs.period_x = 10;
  Snapshot spheres = no_spheres(10, depth);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(0, 10), height(1, 9), any(-1, 1), turn(0, 2 * pi);
  for (std::int32_t i = 0; i < 120; ++i) {
    const double x = along(random), z = height(random), v_x = any(random), v_z = any(random);
    testing::add_grain(discs, x, z, radius);
    discs.v_x.back() = v_x, discs.v_z.back() = v_z, discs.spin.back() = 0;
    add_sphere(spheres, x, 0, z, radius, {v_x, 0, v_z});
    const double angle = turn(random), n = any(random), t = any(random);
    const auto n_x = static_cast<float>(std::cos(angle)), n_z = static_cast<float>(std::sin(angle));
    const SnapshotContact contact{i, (i + 3) % 120, n_x, n_z, n, t};
    discs.contacts.push_back(contact);
    const auto [f_x, f_z] = impulse_on_i(contact);
    spheres.spheres->contacts.push_back({i, contact.j, {n_x, n_z, 0}, {f_x * depth, f_z * depth, 0}});
  }
  const LayerGrid grid = whole_grid(10, 1, 10);
  Slice of_discs = empty_slice(grid, 1), of_spheres = empty_slice(grid, 1);
  add_snapshot(grid, in_flow_frame(discs), of_discs.batches[0]);
  add_snapshot(grid, in_flow_frame(spheres), of_spheres.batches[0]);
  double disc_area = 0, sphere_area = 0;
  for (std::size_t l = 0; l < grid.layers(); ++l) {
    const LayerSum &a = of_discs.batches[0].layers[l], &b = of_spheres.batches[0].layers[l];
    disc_area += a.solid, sphere_area += b.solid;
    EXPECT_NEAR(a.motion.first[0], b.motion.first[0], 1e-11);
    for (int u = 0; u < 2; ++u)
      for (int v = 0; v < 2; ++v) EXPECT_NEAR(a.force_branch[u][v], b.force_branch[u][v], exact);
  }
  EXPECT_NEAR(disc_area, sphere_area, 1e-11);
  const CoarseGraining graining = coarse_graining(FlowFrame{}, 0, 10, 0, 10, 1, 1, 10);
  MapSums disc_maps = empty_sums(graining), sphere_maps = empty_sums(graining);
  add_snapshot(graining, discs, in_flow_frame(discs), disc_maps);
  add_snapshot(graining, spheres, in_flow_frame(spheres), sphere_maps);
  for (std::size_t node = 0; node < disc_maps.nodes.size(); ++node) {
    const MapNode &a = disc_maps.nodes[node], &b = sphere_maps.nodes[node];
    EXPECT_NEAR(a.solid, b.solid, exact);
    EXPECT_NEAR(a.motion.first[0], b.motion.first[0], exact);
    EXPECT_NEAR(a.motion.product(0, 1), b.motion.product(0, 1), exact);
    for (int u = 0; u < 2; ++u)
      for (int v = 0; v < 2; ++v) EXPECT_NEAR(a.force_branch[u][v], b.force_branch[u][v], exact);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.fabric[k], b.fabric[k], 1e-6);  // of single precision
  }
}

TEST(Spheres, PartsOfASphereAddUp) {
  EXPECT_NEAR(sphere_volume_left_of(0.7, 0), 2 * pi / 3 * std::pow(0.7, 3), 1e-15);
  EXPECT_NEAR(sphere_volume_left_of(0.7, 2), 4 * pi / 3 * std::pow(0.7, 3), 1e-15);
  GrainSample<3> sphere;
  sphere.radius = 0.7;
  EXPECT_NEAR(part_in(sphere, 0.3, 0.2, Rectangle{-5, 5, -5, 5}), sphere.area(), 1e-14);
  // The half of it in x > 0.3, by the rule: its error where the edge cuts cross sections off.
  EXPECT_NEAR(part_in(sphere, 0.3, 0.2, Rectangle{0.3, 5, -5, 5}), sphere.area() / 2, 1e-14);
  EXPECT_NEAR(part_in(sphere, 0.0, 0.0, Rectangle{0.2, 5, -5, 5}),
              sphere.area() - sphere_volume_left_of(0.7, 0.2), 2e-3 * sphere.area());
}

}  // namespace
}  // namespace drumlin
