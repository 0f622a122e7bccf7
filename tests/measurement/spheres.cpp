// Spheres: closed forms of a lattice, of a column under its weight and of a uniform shear; bins that add up
// to the whole; and a slab of discs taken for spheres, which measures as discs do.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/spheres/space_layers.hpp"
#include "tests/measurement/collected_maps.hpp"
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
  SpaceSums sums = empty_space_layers(grid, 1).batches[0];
  add_snapshot(grid, snapshot, in_flow_frame(snapshot, grid.frame), sums);
  return sums;
}

double number(const ProfileSet& profiles, const char* column, std::size_t layer) {
  return profiles.column(column).value.at(layer);
}

ProfileSet profiles_of(const LayerGrid& grid, const Snapshot& snapshot) {
  SpaceLayers layers = empty_space_layers(grid, 1);
  add_snapshot(grid, snapshot, in_flow_frame(snapshot, grid.frame), layers.batches[0]);
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

TEST(Spheres, MapOfACubicLatticeHasTheStressOfItsForces) {
  // Splines with knots as far apart as the planes add up to 1 over them, and spread them by 1/3 d^2.
  Snapshot s = cubic_lattice(4, 12, 1, 2, std::vector<double>(12, 3.0), -0.4);
  for (std::size_t i = 0; i < s.z.size(); ++i) s.spheres->v_y[i] = 0.4 * s.z[i];
  const FieldMap map = testing::collected_maps(coarse_graining(FlowFrame{}, 0, 4, 0, 12, 0.5, 1, 4), {s});
  const double density = pi / 6, k_x = density * 0.3 * 0.3 / 3, k_y = density * 0.4 * 0.4 / 3,
               k_xy = density * 0.3 * 0.4 / 3, p = (6 + k_x + k_y) / 3;
  const double square = (std::pow(1 + k_x - p, 2) + std::pow(2 + k_y - p, 2) + std::pow(3 - p, 2)) / 2 +
                        0.2 * 0.2 + k_xy * k_xy;  // of sigma_xz half is symmetric
  const int checked = testing::each_node(
      map, [](double, double z) { return z > 3 && z < 9; },
      [&](double, double z, const auto& field) {
        for (const auto& [name, expected] : {std::pair("nu", pi / 6),
                                             {"coordination", 6.0},
                                             {"v_y", 0.4 * z},
                                             {"strain_rate", 0.3},
                                             {"sigma_xx", 1 + k_x},
                                             {"sigma_yy", 2 + k_y},
                                             {"sigma_zz", 3.0},
                                             {"sigma_xz", 0.4},
                                             {"sigma_xy", k_xy},
                                             {"sigma_yz", 0.0},
                                             {"sigma_xx_kinetic", k_x},
                                             {"sigma_yy_kinetic", k_y},
                                             {"sigma_xy_kinetic", k_xy},
                                             {"sigma_yz_kinetic", 0.0},
                                             {"fabric_xx", 1.0 / 3},
                                             {"fabric_yy", 1.0 / 3},
                                             {"fabric_zz", 1.0 / 3},
                                             {"fabric_xz", 0.0},
                                             {"fabric_xy", 0.0},
                                             {"fabric_yz", 0.0},
                                             {"k", (1 + k_x) / 3},
                                             {"p_space", p},
                                             {"temperature", (k_x + k_y) / (3 * density)},
                                             {"I_invariant", 0.5 / std::sqrt(p)},
                                             {"mu_invariant", std::sqrt(square) / p},
                                             {"N1_over_p", (k_x - 2) / p},
                                             {"N2_over_p", (1 - k_y) / p}})
          EXPECT_NEAR(field(name), expected, exact) << name;
      });
  EXPECT_GT(checked, 50);
}

TEST(Spheres, FabricOfAShearedPackingIsThatOfItsNormals) {
  // Of each sphere one contact lies along (0.8, 0, 0.6), one along (0, 0.8, 0.6).
  constexpr std::int32_t side = 8, levels = 12, count = side * side * levels;
  Snapshot s = no_spheres(0, side);
  for (std::int32_t i = 0; i < count; ++i) {
    add_sphere(s, i % side + 0.5, i / side % side + 0.5, i / (side * side) + 0.5, 0.5, {0, 0, 0});
    const std::int32_t j = (i + 5) % count;
    s.spheres->contacts.push_back({i, j, {0.8, 0.6, 0}, {0.8, 0.6, 0}});
    s.spheres->contacts.push_back({i, j, {0, 0.6, 0.8}, {0, 0.6, 0.8}});
  }
  const auto expect = [](const std::string& axes, double found, double expected) {
    EXPECT_NEAR(found, expected, exact) << axes;
  };
  const auto expect_fabric = [&](const auto& value) {
    for (const auto& [axes, expected] :
         {std::pair("xx", 0.32), {"yy", 0.32}, {"zz", 0.36}, {"xz", 0.24}, {"xy", 0.0}, {"yz", 0.24}})
      expect(axes, value((std::string("fabric_") + axes).c_str()), expected);
  };
  const ProfileSet layers = profiles_of(layer_grid(FlowFrame{}, side / 2.0, side + 2, 1, 0, levels, 0, 0), s);
  for (std::size_t l = 1; l + 1 < levels; ++l)
    expect_fabric([&](const char* name) { return number(layers, name, l); });
  const FieldMap map =
      testing::collected_maps(coarse_graining(FlowFrame{}, 0, side, 0, levels, 1, 1, 0), {s});
  const int checked = testing::each_node(
      map, [](double x, double z) { return x > 2.5 && x < side - 2.5 && z > 2.5 && z < levels - 2.5; },
      [&](double, double, const auto& field) { expect_fabric(field); });
  EXPECT_EQ(checked, 18);
}

TEST(Spheres, RingsOfAPackingThatTurnsAsOne) {
  constexpr double spin = 0.7;
  Snapshot s = no_spheres(0, 3);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-6, 6);
  for (int i = 0; i < 2000; ++i) {
    const double x = place(random), z = place(random);
    add_sphere(s, x, place(random), z, 0.5, {spin * z, 0.2, -spin * x});  // clockwise
  }
  const ProfileSet rings = profiles_of(ring_grid(0, 0, 1, 6, 0), s);
  for (std::size_t l = 1; l < 5; ++l) {
    EXPECT_NEAR(number(rings, "v_t", l), spin * rings.z[l], exact);
    EXPECT_NEAR(number(rings, "v_y", l), 0.2, exact);
    EXPECT_NEAR(number(rings, "shear_rate", l), 0, exact);
    EXPECT_NEAR(number(rings, "temperature", l), 0, exact);
  }
}

TEST(Spheres, RingsHaveTheAxesOfEachPlace) {
  // On the x axis the tangent is -z, on the z axis x. Spheres so small that axes do not turn along a branch.
  constexpr double r = 1e-6, depth = 2, area = pi * (11 * 11 - 10 * 10);
  Snapshot s = no_spheres(0, depth);
  add_sphere(s, 10.5, 0, 0, r, {0, 0, 0});
  s.spheres->contacts = {{0, -1, {1, 0, 0}, {1, 2, 3}}, {0, -1, {0, 0, 1}, {5, 7, 11}}};
  ProfileSet rings = profiles_of(ring_grid(0, 0, 1, 11, 0), s);
  for (const auto& [name, expected] : {std::pair("sigma_rr", 1.0),
                                       {"sigma_tt", 0.0},
                                       {"sigma_yy", 11.0},
                                       {"sigma_rt", 2.0},
                                       {"sigma_ry", -3.0},
                                       {"sigma_ty", -7.0}})
    EXPECT_NEAR(number(rings, name, 10) / r * area * depth, expected, 1e-6) << name;
  add_sphere(s, 0, 0, 10.5, r, {0, 0, 0});
  s.spheres->contacts = {{0, 1, {0.6, 0, 0.8}, {0, 0, 0}}};
  rings = profiles_of(ring_grid(0, 0, 1, 11, 0), s);
  for (const auto& [name, expected] : {std::pair("fabric_rr", 0.18),
                                       {"fabric_tt", 0.18},
                                       {"fabric_yy", 0.64},
                                       {"fabric_rt", 0.0},
                                       {"fabric_ry", 0.24},
                                       {"fabric_ty", 0.24}})
    EXPECT_NEAR(number(rings, name, 10), expected, 1e-6) << name;
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
  std::array<double, 6> fabric{}, at_walls{};  // n_a n_b
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double v = 4 * pi / 3 * std::pow(s.radius[i], 3);
    volume += v, momentum += v * s.v_x[i], momentum_y += v * s.spheres->v_y[i];
  }
  for (const SphereContact& c : s.spheres->contacts) {
    const double reach =
        s.radius[static_cast<std::size_t>(c.i)] + (c.j < 0 ? 0 : s.radius[static_cast<std::size_t>(c.j)]);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) force_branch[a][b] += c.force[a] * reach * c.normal[b];
    for (int a = 0, k = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) (c.j < 0 ? at_walls : fabric)[k++] += c.normal[a] * c.normal[b];
  }
  for (const LayerGrid& grid :
       {whole_grid(side, 1, 12.2), whole_grid(side, 0.37, 12.2), ring_grid(side / 2, 6, 1.3, 40, 0)}) {
    SpaceSum whole;
    for (const SpaceSum& layer : space_sums(grid, s).layers) add_times(1, layer, whole);
    EXPECT_NEAR(whole.solid * depth, volume, (grid.rings ? 1e-7 : exact) * volume);
    EXPECT_NEAR(whole.grains, 300, exact);
    // Rings have the axes of each place: of the plane they keep the trace.
    const auto expect = [&](double found, double right) { EXPECT_NEAR(found, right, 1e-11); };
    const auto& of = whole.force_branch;
    expect(of[2][2] * depth, force_branch[2][2]);
    expect((of[0][0] + of[1][1]) * depth, force_branch[0][0] + force_branch[1][1]);
    expect(whole.fabric[5], 2 * fabric[5]);  // both sides of each
    expect(whole.fabric[0] + whole.fabric[3], 2 * (fabric[0] + fabric[3]));
    for (int a = 0; a < 3 && !grid.rings; ++a)
      for (int b = 0; b < 3; ++b) expect(of[a][b] * depth, force_branch[a][b]);
    for (std::size_t k = 0; k < 6 && !grid.rings; ++k) expect(whole.fabric[k], 2 * fabric[k]);
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
  SpaceNode space;
  for (std::size_t node = 0; node < maps.nodes.size(); ++node) {
    add_times(0.25, maps.space[node], space);
    solid += maps.nodes[node].solid / 4, moved += maps.nodes[node].motion.first[0] / 4;
    trace += (maps.nodes[node].force_branch[0][0] + maps.nodes[node].force_branch[1][1]) / 4;
  }
  EXPECT_NEAR(solid, volume / depth, exact * volume);
  EXPECT_NEAR(moved, momentum / depth, exact * volume);
  EXPECT_NEAR(trace, (force_branch[0][0] + force_branch[1][1]) / depth, 1e-10);
  EXPECT_NEAR(space.solid, volume / depth, exact * volume);
  EXPECT_NEAR(space.motion.first[2], momentum_y / depth, exact * volume);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(space.force_branch[a][b], force_branch[a][b] / depth, 1e-10);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(space.fabric[k], fabric[k] + at_walls[k] / 2, exact * 300);  // walls have one side
}

TEST(Spheres, TheViewHasTheStressOfSpace) {
  const Snapshot s = random_spheres(12, 5);
  const LayerGrid grid = whole_grid(12, 1, 12);
  const SpaceSums space = space_sums(grid, s);
  LayerSums view{std::vector<LayerSum>(grid.layers()), {}};
  add_snapshot(grid, in_flow_frame(s), view);
  for (std::size_t l = 0; l < grid.layers(); ++l) {
    EXPECT_NEAR(view.layers[l].solid, space.layers[l].solid, 1e-11);
    EXPECT_EQ(view.layers[l].contacts, space.layers[l].contacts);
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(view.layers[l].motion.first[a], space.layers[l].motion.first[a], 1e-11);
      for (int b = 0; b < 2; ++b)
        EXPECT_NEAR(view.layers[l].force_branch[a][b], space.layers[l].force_branch[a][b], 1e-11);
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
  }
  const FieldMap of_disc = testing::collected_maps(graining, {discs}),
                 of_sphere = testing::collected_maps(graining, {spheres});
  for (const MapField& field : of_disc.fields) {
    if (field.name == "omega") continue;
    const std::vector<double>& same = of_sphere.field(field.name).value;
    for (std::size_t node = 0; node < same.size(); ++node) {
      const double right = field.value[node];
      EXPECT_TRUE(std::isnan(right) ? std::isnan(same[node])
                                    : std::abs(same[node] - right) <= 1e-9 * std::max(1.0, std::abs(right)))
          << field.name << " " << same[node] << " " << right;
    }
  }
  for (const char* across : {"v_y", "sigma_yy", "sigma_xy", "fabric_yy", "fabric_xy", "fabric_yz"})
    for (const double value : of_sphere.field(across).value)
      EXPECT_TRUE(!(std::abs(value) > exact)) << across << " " << value;
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
