// What holds for every binning: its bins add up to the whole, and what is uniform comes out uniform.
#include <gtest/gtest.h>

#include <random>

#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/history/region_history.hpp"
#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/maps/map_sums.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using std::numbers::pi;
constexpr double side = 24;  ///< of the square from (0, 0) on that all binnings cover

/// The moments of each bin, and its area; 0 of a bin that is not wholly inside of the square.
struct Binned {
  std::string name;
  std::vector<Moments<2>> bins;
  std::vector<double> area;
  bool by_density = false;     ///< a grain counts so in the motion, else by its mass
  double whole_error = 1e-12;  ///< relative; rounding
  std::vector<double> error;   ///< relative, of each bin of a uniform packing; empty: rounding
};

template <class Sum, class Binning>
std::vector<Moments<2>> in_bins(const FlowSnapshot& snapshot, const Binning& binning, std::size_t count) {
  std::vector<Sum> sums(count);
  accumulate(snapshot, binning, sums);
  std::vector<Moments<2>> bins;
  for (const Sum& sum : sums) {
    Moments<2> one{sum.solid, sum.grains, sum.contacts, sum.spin, {}, sum.force_branch, sum.fabric};
    one.motion.weight = sum.motion.weight;
    one.motion.first = {sum.motion.first[0], sum.motion.first[1]};
    one.motion.second = {sum.motion.product(0, 0), sum.motion.product(0, 1), sum.motion.product(1, 1)};
    bins.push_back(one);
  }
  return bins;
}

Binned in_layers(const char* name, const FlowSnapshot& snapshot, const LayerGrid& grid) {
  return {name, in_bins<LayerSum>(snapshot, LayerBinning(grid), grid.layers()), grid.area, true, 1e-12, {}};
}

/// About the middle of the square. A circle of r spacings holds its area over that of a cell of the lattice,
/// but for some sqrt(r) (Gauss's circle problem), here 2 for both circles of a ring. Discs are cut by
/// differences of circles' segments, which lose half of the digits.
Binned in_rings(const Snapshot& snapshot, double lattice) {
  const LayerGrid grid = ring_grid(side / 2, side / 2, 2, side, 0);
  const FlowSnapshot seen = in_flow_frame(snapshot, grid.frame);
  Binned rings{"rings", in_bins<LayerSum>(seen, RingBinning(grid), grid.layers()), grid.area, true, 1e-7, {}};
  for (std::size_t l = 0; l < grid.layers(); ++l) {
    const double outer = grid.thickness * static_cast<double>(l + 1);
    if (outer > side / 2) rings.area[l] = 0;
    rings.error.push_back(2 * std::sqrt(outer / lattice) * lattice * lattice / grid.area[l]);
  }
  return rings;
}

/// Kernels whole spacings wide add up to 1.
Binned on_nodes(const char* name, const Snapshot& snapshot, const FlowSnapshot& seen, double spacing) {
  const bool closed = snapshot.cell.has_value();
  const CoarseGraining graining =
      coarse_graining(FlowFrame{}, 0, side, 0, side, spacing, 1, closed ? side : 0, closed);
  MapSums sums = empty_sums(graining);
  add_snapshot(graining, snapshot, seen, sums);
  Binned nodes{name, {}, std::vector<double>(sums.nodes.size(), spacing * spacing), false, 1e-12, {}};
  for (std::size_t node = 0; node < sums.nodes.size(); ++node)
    add_times(spacing * spacing, static_cast<const Moments<2>&>(sums.nodes[node]), nodes.bins.emplace_back());
  return nodes;
}

Binned in_boxes(const Snapshot& snapshot, const FlowSnapshot& seen) {
  Binned boxes{"boxes", {}, {}, false, 1e-12, {}};
  for (double x = 0; x < side; x += 4)
    for (double z = 0; z < side; z += 6) {
      const Rectangle box{x, x + 4, z, z + 6};
      boxes.bins.push_back(in_bins<WholeGrainSum<2, 4>>(seen, BoxBinning(box, period_of(snapshot)), 1)[0]);
      boxes.area.push_back(box.area());
    }
  return boxes;
}

/// The same snapshot by every binning; bins end between the rows of the lattice.
std::vector<Binned> by_every_binning(const Snapshot& snapshot, double lattice) {
  const FlowSnapshot seen = in_flow_frame(snapshot);
  const Rectangle reach{0, side, 0, side};
  const std::size_t grains = snapshot.x.size();
  std::vector<Binned> all{
      in_layers("layers", seen, height_grid(0, side, reach, 1)),
      in_layers("thin layers", seen, height_grid(0, side, reach, 0.5)),
      in_rings(snapshot, lattice),
      on_nodes("nodes", snapshot, seen, 1),
      on_nodes("near nodes", snapshot, seen, 0.5),
      in_boxes(snapshot, seen),
      {"everywhere", in_bins<GrainSum>(seen, Everywhere{}, 1), {side * side}, false, 1e-12, {}},
      {"cells of grains", in_bins<GrainSum>(seen, EachGrain{}, grains), {}, false, 1e-12, {}}};
  for (const VoronoiCell& cell : voronoi_cells(snapshot)) all.back().area.push_back(cell.area);
  if (snapshot.cell) all.push_back(in_layers("closed", seen, closed_grid(FlowFrame{}, 1.5, 0, side, side)));
  return all;
}

/// Grains anywhere but near the sides, of many sizes and densities, and forces between any two of them: no
/// packing, but what holds for any network of forces holds for this one.
Snapshot random_network() {
  Snapshot snapshot;
  snapshot.time_step = 0.01;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(4, side - 4), size(0.3, 0.9), any(-1, 1);
  constexpr std::int32_t count = 400;
  for (std::int32_t i = 0; i < count; ++i) {
    testing::add_grain(snapshot, place(random), place(random), size(random));
    snapshot.v_x.back() = any(random), snapshot.v_z.back() = any(random);
    snapshot.spin.back() = any(random);
    snapshot.mass.push_back((2 + any(random)) * pi * std::pow(snapshot.radius.back(), 2));
    const double angle = pi * any(random);
    snapshot.contacts.push_back({i, i % 4 == 0 ? -1 : (i + 7) % count, static_cast<float>(std::cos(angle)),
                                 static_cast<float>(std::sin(angle)), any(random), any(random)});
  }
  return snapshot;
}

constexpr double spacing = 0.5, pressure = 3, couple_stress = 0.8;

/// A square lattice of touching discs in a cell without borders, in one motion. All contacts carry the same
/// force, so that the stress is pressure times the unit matrix and `couple_stress` times the matrix of a
/// quarter turn: the same in all axes.
Snapshot uniform_lattice() {
  Snapshot snapshot;
  snapshot.time_step = 0.01;
  snapshot.period_x = side;
  snapshot.cell = SnapshotCell{0, 0, side, 0, 0, 0, 0};
  constexpr auto count = static_cast<std::int32_t>(side / spacing);
  const double normal = pressure * spacing * snapshot.time_step,
               shear = couple_stress * spacing * snapshot.time_step;
  for (std::int32_t column = 0; column < count; ++column)
    for (std::int32_t row = 0; row < count; ++row) {
      const std::int32_t i = column * count + row;
      testing::add_grain(snapshot, (column + 0.5) * spacing, (row + 0.5) * spacing, spacing / 2);
      snapshot.v_x.back() = 0.7, snapshot.v_z.back() = -0.4, snapshot.spin.back() = 0.2;
      snapshot.contacts.push_back({column * count + (row + 1) % count, i, 0, 1, normal, shear});
      snapshot.contacts.push_back({(column + 1) % count * count + row, i, 1, 0, normal, shear});
    }
  return snapshot;
}

double trace(const Tensor<2>& t) { return t[0][0] + t[1][1]; }
double moment_of(const Tensor<2>& t) { return t[0][1] - t[1][0]; }  // with the trace, what no axes change
double energy(const Spread<2>& motion) { return motion.product(0, 0) + motion.product(1, 1); }

TEST(Binnings, AddUpToTheWhole) {
  for (const Snapshot& snapshot : {random_network(), uniform_lattice()}) {
    const FlowSnapshot seen = in_flow_frame(snapshot);
    Moments<2> whole;
    Spread<2> by_density;
    for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
      const GrainSample<2> grain = seen.grain(i);
      whole.solid += grain.area();
      whole.add_centre(1, grain);
      whole.motion.add(grain.mass(), grain.velocity);
      by_density.add(grain.density, grain.velocity);
    }
    for (const SnapshotContact& contact : snapshot.contacts) {  // both sides of it
      const double n_x = contact.normal_x, n_z = contact.normal_z, n = contact.impulse_n,
                   t = contact.impulse_t;
      const double reach = snapshot.radius[contact.i] + (contact.j < 0 ? 0 : snapshot.radius[contact.j]);
      const Vector<2> force{(n * n_x + t * n_z) / snapshot.time_step,
                            (n * n_z - t * n_x) / snapshot.time_step};
      whole.add_share(-reach, {0, {}, {n_x, n_z}, force, {}, false});
    }
    for (const Binned& binned : by_every_binning(snapshot, spacing)) {
      SCOPED_TRACE(binned.name);
      Moments<2> sum;
      for (const Moments<2>& bin : binned.bins) add_times(1, bin, sum);
      const Spread<2>& motion = binned.by_density ? by_density : whole.motion;
      const auto expect = [](double found, double right, double error, double size) {
        EXPECT_NEAR(found, right, error * size);
      };
      const double count = whole.grains, forces = std::abs(trace(whole.force_branch)) * 10;
      expect(sum.solid, whole.solid, binned.whole_error, whole.solid);
      expect(sum.grains, count, 1e-12, count);
      expect(sum.contacts, whole.contacts, 1e-12, whole.contacts);
      expect(sum.spin, whole.spin, 1e-12, count);
      expect(sum.motion.weight, motion.weight, 1e-12, motion.weight);
      expect(energy(sum.motion), energy(motion), 1e-12, energy(motion));
      expect(trace(sum.force_branch), trace(whole.force_branch), 1e-12, forces);
      expect(moment_of(sum.force_branch), moment_of(whole.force_branch), 1e-12, forces);
    }
  }
}

TEST(Binnings, LeaveAUniformPackingUniform) {
  constexpr double rounding = 1e-12;
  for (const Binned& binned : by_every_binning(uniform_lattice(), spacing)) {
    std::size_t checked = 0;
    for (std::size_t bin = 0; bin < binned.bins.size(); ++bin) {
      const Moments<2>& m = binned.bins[bin];
      const double area = binned.area[bin], error = binned.error.empty() ? rounding : binned.error[bin];
      if (!(area > 0)) continue;
      SCOPED_TRACE(binned.name + " " + std::to_string(bin));
      const Fields<2> f = derive(m, Background<2>{area});
      EXPECT_NEAR(f.nu, pi / 4, error);
      EXPECT_NEAR(f.omega, 0.2, rounding);
      EXPECT_NEAR(f.coordination, 4, rounding);
      EXPECT_NEAR(energy(m.motion) / m.motion.weight, 0.7 * 0.7 + 0.4 * 0.4, rounding);
      if (binned.name != "rings") {  // whose axes are those of each place
        EXPECT_NEAR(m.motion.mean(0), 0.7, rounding);
        EXPECT_NEAR(m.motion.mean(1), -0.4, rounding);
        EXPECT_NEAR(trace(f.kinetic), 0, rounding);
      }
      EXPECT_NEAR(f.contact[0][0] / pressure, 1, error);
      EXPECT_NEAR(f.contact[1][1] / pressure, 1, error);
      EXPECT_NEAR(f.contact[0][1] / couple_stress, 1, error * pressure / couple_stress);
      EXPECT_NEAR(f.contact[1][0] / couple_stress, -1, error * pressure / couple_stress);
      ++checked;
    }
    EXPECT_EQ(checked, binned.name == "rings" ? 6 : binned.bins.size());
  }
}

TEST(Moments, OfSpheresAreThoseOfTheirVolumes) {
  // One sphere of a cubic lattice, pressed by 1, 2 and 3 along the axes and dragged along x by its upper
  // neighbour.
  std::array<WholeGrainSum<3>, 1> sums;
  const Everywhere lattice;
  const GrainSample<3> sphere{0, {}, {1, -2, 3}, 0.5, 2, 6, 0.25};
  add_grain(sphere, lattice, sums);
  for (const double to : {-0.5, 0.5})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      HalfBranch<3> half;
      half.toward[axis] = to;
      half.force[axis] = -2 * to * static_cast<double>(axis + 1);
      if (axis == 2) half.force[0] = 2 * to * 0.1;
      add_branch(half, lattice, sums);
    }
  const Fields<3> fields = derive(sums[0], Background<3>{1});
  EXPECT_NEAR(fields.nu, pi / 6, 1e-15);
  EXPECT_NEAR(sums[0].motion.weight, pi / 3, 1e-15);
  EXPECT_NEAR(sums[0].motion.mean(2), 3, 1e-15);
  EXPECT_EQ(fields.coordination, 6);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(fields.kinetic[a][b], 0, 1e-14);
      EXPECT_NEAR(fields.contact[a][b], a == b ? 1.0 + a : a == 0 && b == 2 ? -0.1 : 0, 1e-15);
    }
}

}  // namespace
}  // namespace drumlin
