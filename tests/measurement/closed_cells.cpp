// Cells that are periodic in x and z, at rest and moving: whatever is measured knows no border. The right
// values are those of lattices and of affine motion.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/history/region_history.hpp"
#include "particles/measurement/maps/map_measurement.hpp"
#include "tests/measurement/collected_maps.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin::closed_cells {
using namespace particles;
namespace {

using std::numbers::pi;
constexpr double side = 15, row_height = 1.5, bottom = -4, left = 2;

/// The cell of 15 d x 15 d with its lower left corner in (2, -4).
Snapshot empty_cell() {
  Snapshot s;
  s.time_step = 0.01;
  s.gravity_z = 0;
  s.period_x = side;
  s.cell = SnapshotCell{left, bottom, side, 0, 0, 0, 0};
  return s;
}

/// 150 discs of 1 d in it, in 10 rows a quarter of their distance above the bottom.
Snapshot rows() {
  Snapshot s = empty_cell();
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 15; ++column)
      testing::add_grain(s, left + column + 0.3 * (row % 3), bottom + (row + 0.25) * row_height, 0.5);
  return s;
}

/// Grains that have left the cell, as one at rest lets them.
Snapshot scattered(Snapshot s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    s.x[i] += side * (static_cast<int>(i % 5) - 2);
    s.z[i] += side * (static_cast<int>(i % 7) - 3);
  }
  return s;
}

/// The same after a time in the flow of the cell, v = (rate_x x + shear z, rate_z z) about its middle at the
/// beginning, with every grain in the cell.
Snapshot after(const Snapshot& s, double time, double rate_z, double shear, double rate_x = 0) {
  Snapshot now = s;
  const SnapshotCell& from = *s.cell;
  SnapshotCell& to = *now.cell;
  const double x_c = from.x + s.period_x / 2, z_c = from.z + from.height / 2;
  const double wider = 1 + rate_x * time, higher = 1 + rate_z * time, askew = shear * time;
  now.time += time;
  now.period_x = wider * s.period_x, to.height = higher * from.height;
  to.x = x_c - now.period_x / 2, to.z = z_c - to.height / 2;
  to.offset = wider * from.offset + askew * from.height;
  to.offset -= now.period_x * std::round(to.offset / now.period_x);
  to.rate_x = rate_x / wider, to.rate_z = rate_z / higher,
  to.shear = (shear - rate_x * askew / wider) / higher;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double x = s.x[i] - x_c, z = s.z[i] - z_c;
    const Point first = period_of(now).first({x_c + wider * x + askew * z, z_c + higher * z});
    now.x[i] = first.x, now.z[i] = first.z;
    now.v_x[i] = to.rate_x * (first.x - x_c) + to.shear * (first.z - z_c);
    now.v_z[i] = to.rate_z * (first.z - z_c);
  }
  return now;
}

void expect_all_near(const std::vector<double>& values, double right, double tolerance) {
  for (std::size_t l = 0; l < values.size(); ++l) EXPECT_NEAR(values[l], right, tolerance) << l;
}

void expect_all(const Measurement& measured, const char* name, double right, double tolerance) {
  expect_all_near(measured.profiles.column(name).value, right, tolerance);
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(ClosedCell, AtRestTheProfileSpansTheCellWithOneVolumeFraction) {
  const Measurement measured = testing::measurement_of(scattered(rows()), {.layer_thickness = row_height});
  ASSERT_EQ(measured.profiles.z.size(), 10u);
  EXPECT_NEAR(measured.profiles.z.front(), -side + row_height / 2, 1e-12);
  EXPECT_NEAR(measured.profiles.z.back(), -row_height / 2, 1e-12);
  EXPECT_NEAR(measured.surface_z, bottom + side, 1e-12);
  EXPECT_NEAR(measured.wall_z, -side, 1e-12);
  expect_all(measured, "nu", 150 * pi / 4 / 225, 1e-12);
  expect_all(measured, "count", 15, 0);
  expect_all(measured, "shear_rate", 0, 1e-12);
}

TEST(ClosedCell, MeansOverItsLayersAreThoseOfTheCell) {
  Snapshot s = rows();
  testing::add_grain(s, left, bottom + 0.2, 1.7);   // larger than a layer, across the border
  for (const double thickness : {1.0, 0.4, 2.2}) {  // the last one fits 6.8 times: 7 layers
    const Measurement measured = testing::measurement_of(scattered(s), {.layer_thickness = thickness});
    const double nu = (150 * 0.25 + 1.7 * 1.7) * pi / 225;
    EXPECT_EQ(measured.profiles.z.size(), static_cast<std::size_t>(std::round(side / thickness)));
    EXPECT_NEAR(mean_of(measured.profiles.column("nu").value), nu, 1e-12);
    EXPECT_NEAR(measured.scalars.value("bulk_nu"), nu, 1e-12);
    EXPECT_NEAR(measured.scalars.value("nu_bulk"), nu, 1e-12);
    EXPECT_NEAR(measured.layer_thickness * static_cast<double>(measured.profiles.z.size()), side, 1e-12);
  }
}

TEST(ClosedCell, ASmallPartOfTheCellIsMeasuredWhereItIs) {
  // A dilute cell, larger than the window that open scenes are cut to.
  Snapshot s = empty_cell();
  s.period_x = 400;
  s.cell = SnapshotCell{0, 0, 400, 0, 0, 0, 0};
  testing::add_grain(s, 1, 399.9, 0.5);
  testing::add_grain(s, 200, 3, 0.5);
  const Measurement measured = testing::measurement_of(s);
  EXPECT_EQ(measured.profiles.z.size(), 400u);
  EXPECT_NEAR(measured.scalars.value("bulk_nu"), 2 * pi / 4 / 160000, 1e-15);
}

TEST(ClosedCell, MovingItKeepsItsVolumeFractionAndHasItsShearRateUpToTheEnds) {
  const double shear = 0.3, rate = -0.01, rate_x = 0.02;
  const Snapshot first = after(rows(), 0, rate, shear), later = after(rows(), 6, rate, shear, rate_x);
  const Measurement measured = [&] {
    MeasurementOptions options;
    options.layer_thickness = row_height;
    return testing::measurement_of(first, options);
  }();
  expect_all(measured, "shear_rate", shear, 1e-12);
  // Two heights: rows stand at the same shares of both.
  Snapshot same_rate = first;
  same_rate.cell->shear = later.cell->shear;
  const Measurement both =
      measurement(testing::source_of({same_rate, later}), {.layer_thickness = row_height});
  const double area = side * side + later.period_x * later.cell->height;
  expect_all(both, "nu", 2 * 150 * pi / 4 / area, 1e-12);
  EXPECT_NEAR(both.layer_thickness, (side + later.cell->height) / 20, 1e-12);
  EXPECT_NEAR(both.place.slice_width, (side + later.period_x) / 2, 1e-12);
}

TEST(ClosedCell, SnapshotsOfAnotherShearAreLeftOut) {
  const Snapshot still = rows(), sheared = after(rows(), 1, 0, 0.3);
  const Measurement measured = measurement(testing::source_of({still, still, sheared}), {});
  EXPECT_EQ(measured.first_snapshot, 2u);
}

TEST(ClosedCell, ForcesAcrossItsBorderCountInFull) {
  // A chain right through the cell carries the force 3 in every layer, whichever image its grains are.
  Snapshot s = empty_cell();
  for (int i = 0; i < 15; ++i) testing::add_grain(s, left + 1, bottom + i + 0.2, 0.5);
  for (std::int32_t i = 0; i < 15; ++i)
    s.contacts.push_back({(i + 1) % 15, i, 0, 1, 3 * s.time_step, s.time_step});
  const Measurement measured = testing::measurement_of(scattered(s));
  expect_all(measured, "sigma_zz", 3 / side, 1e-12);
  expect_all(measured, "sigma_xz", -1 / side, 1e-12);
  const RegionState state = RegionHistory({left, left + side, bottom, bottom + side}).add(scattered(s));
  EXPECT_NEAR(state.pressure.zz, 3 / side, 1e-12);
  EXPECT_EQ(state.grains, 15u);
  EXPECT_NEAR(RegionHistory({left, left + side, bottom + 2.3, bottom + 8.1}).add(scattered(s)).pressure.zz,
              3 / side, 1e-12);
}

TEST(ClosedCell, ABoxOfItsSizeHoldsEveryGrainWhereverItBegins) {
  for (const double from_x : {0.0, 2.0, 7.3})
    for (const double from_z : {0.0, -4.0, 0.7}) {
      const Rectangle box{from_x, from_x + side, from_z, from_z + side};
      const RegionState state = RegionHistory(box).add(scattered(rows()));
      EXPECT_EQ(state.grains, 150u);
      EXPECT_NEAR(state.nu, 150 * pi / 4 / 225, 1e-12);
    }
  EXPECT_THROW(RegionHistory({0, 15, 0, 16}).add(rows()), InputError);
}

TEST(ClosedCell, HistoriesKnowTheGradientOfAMovingCell) {
  const double shear = 0.3, rate = -0.02, rate_x = 0.01, time = 2;
  Snapshot s = after(rows(), 0, rate, shear, rate_x);
  for (int step = 0; step < 6; ++step) {  // the image above passes more than two lengths
    const SnapshotCell& c = *s.cell;
    const Snapshot next = after(s, time, c.rate_z, c.shear, c.rate_x);
    // Displacements are over the place half-way.
    const double wide = 1 + c.rate_x * time / 2, high = 1 + c.rate_z * time / 2;
    for (const Rectangle& box : {Rectangle{2, 17, -2, 8}, Rectangle{4, 11, 3, 7}}) {
      const auto G = mean_gradient(box, s, next);
      ASSERT_TRUE(G);
      EXPECT_NEAR(G->xz, c.shear / high * (1 - c.rate_x * time / 2 / wide), 1e-12) << step;
      EXPECT_NEAR(G->zz, c.rate_z / high, 1e-12) << step;
      EXPECT_NEAR(G->xx, c.rate_x / wide, 1e-12) << step;
      EXPECT_NEAR(G->zx, 0, 1e-12) << step;
    }
    s = next;
  }
}

TEST(ClosedCell, HistoriesFollowGrainsThatLeaveACellAtRest) {
  Snapshot before = rows();
  Snapshot now = before;
  now.time = 10;
  for (std::size_t i = 0; i < now.x.size(); ++i) now.x[i] += 40, now.z[i] -= 23;  // no velocity tells of it
  const auto G = mean_gradient({0, 15, 0, 15}, before, now);
  ASSERT_TRUE(G);
  for (const double value : {G->xx, G->xz, G->zx, G->zz}) EXPECT_NEAR(value, 0, 1e-13);
}

TEST(ClosedCell, VoronoiCellsFillIt) {
  std::mt19937 engine(3);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  for (const double offset : {0.0, 4.3, -7.5})
    for (const int grains : {1, 2, 17, 150, 700}) {
      Snapshot s = empty_cell();
      s.cell->offset = offset;
      for (int i = 0; i < grains; ++i)
        testing::add_grain(s, 60 * uniform() - 30, 60 * uniform() - 30,
                           i % 9 == 0 ? 0.5 : 0.06 + 0.1 * uniform());
      double sum = 0;
      for (const VoronoiCell& cell : voronoi_cells(s)) {
        EXPECT_FALSE(cell.open);
        sum += cell.area;
      }
      EXPECT_NEAR(sum, 225, 1e-9) << grains;
    }
}

TEST(ClosedCell, VoronoiCellsOfALatticeAreOneAndTheSame) {
  // Rows of 15 that a sheared cell shifts by 0.5 from its top to its bottom: the lattice of the rows goes on.
  Snapshot s = empty_cell();
  s.cell->offset = 0.5 * 15;
  for (int row = 0; row < 15; ++row)
    for (int column = 0; column < 15; ++column)
      testing::add_grain(s, left + column + 0.5 * row, bottom + row + 0.1, 0.5);
  for (const VoronoiCell& cell : voronoi_cells(s)) EXPECT_NEAR(cell.area, 1, 1e-12);
  expect_all_near(testing::measurement_of(s, {.voronoi = true}).profiles.column("nu_voronoi").value, pi / 4,
                  1e-12);
}

/// 900 small discs in a square lattice.
Snapshot fine_lattice() {
  Snapshot s = empty_cell();
  for (int row = 0; row < 30; ++row)
    for (int column = 0; column < 30; ++column)
      testing::add_grain(s, left + column / 2.0, bottom + (row + 0.3) / 2, 0.2);
  return s;
}

FieldMap map_of(const std::vector<Snapshot>& snapshots) {
  const MeasurementFrame place = measurement(testing::source_of(snapshots), {}).place;
  return testing::collected_maps(begun_maps(place, 1, 1, std::make_shared<ScratchFile>()).graining,
                                 snapshots);
}

TEST(ClosedCell, MapsHaveNoBorder) {
  // Kernels that are half a width apart add up to a constant, and with their places to a straight line.
  const Snapshot s = after(fine_lattice(), 2, 0, 0.3);
  const FieldMap map = map_of({s, after(s, 0.2, 0, 0.3)});
  ASSERT_EQ(map.grid.rows, 15u);
  ASSERT_EQ(map.grid.columns, 15u);
  EXPECT_NEAR(map.grid.z_first, bottom + 0.5, 1e-12);
  expect_all_near(map.field("nu").value, 900 * 0.04 * pi / 225, 1e-12);
  expect_all_near(map.field("d_v_x_dz").value, 0.3, 1e-12);
  expect_all_near(map.field("displacement_d_v_x_dz").value, 0.3, 1e-12);
}

TEST(ClosedCell, MapsFollowACellWhoseLengthsChange) {
  const double rate = 0.02, time = 0.2;
  const Snapshot s = after(fine_lattice(), 0, -rate, 0, rate);
  const FieldMap map = map_of({s, after(s, time, -rate, 0, rate)});
  // The stretched lattice is no more that of the nodes: its sums are constant to a few 1e-5.
  expect_all_near(map.field("nu").value, 900 * 0.04 * pi / 225, 2e-4);
  for (const char* of : {"", "displacement_"}) {
    expect_all_near(map.field(std::string(of) + "d_v_x_dx").value, rate, 1e-3);
    expect_all_near(map.field(std::string(of) + "d_v_z_dz").value, -rate, 1e-3);
  }
}

}  // namespace
}  // namespace drumlin::closed_cells
