// Cells of grains: closed forms on lattices, areas that add up, a count of points against each of them.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numeric>
#include <random>

#include "particles/measurement/grains/voronoi_cells.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using std::numbers::pi;
using testing::add_grain;

constexpr double reach = voronoi_reach;

/// Area of a disc about the origin within |x| < half_width, upper half.
double half_strip(double radius, double half_width) {
  return half_width * std::sqrt(radius * radius - half_width * half_width) +
         radius * radius * std::asin(half_width / radius);
}

double sum_of(const std::vector<VoronoiCell>& cells) {
  return std::accumulate(cells.begin(), cells.end(), 0.0,
                         [](double sum, const VoronoiCell& cell) { return sum + cell.area; });
}

/// Discs that do not overlap, thrown one by one into a container, of the radii in turn.
Snapshot thrown(double container_radius, const std::vector<double>& radii, std::size_t count, unsigned seed) {
  Snapshot snapshot;
  snapshot.container_x = 1;
  snapshot.container_z = -2;
  snapshot.container_radius = container_radius;
  std::mt19937 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  for (int attempt = 0; attempt < 200000 && snapshot.x.size() < count; ++attempt) {
    const double r = radii[snapshot.x.size() % radii.size()];
    const double x = container_radius * (2 * uniform() - 1), z = container_radius * (2 * uniform() - 1);
    bool free = std::hypot(x, z) + r <= container_radius;
    for (std::size_t i = 0; i < snapshot.x.size() && free; ++i)
      free = std::hypot(snapshot.x[i] - 1 - x, snapshot.z[i] + 2 - z) >= snapshot.radius[i] + r;
    if (free) add_grain(snapshot, x + 1, z - 2, r);
  }
  return snapshot;
}

/// Areas by the definition itself: each point of a fine grid goes to the grain of least power.
std::vector<double> areas_by_points(const Snapshot& s, double step) {
  std::vector<double> areas(s.x.size(), 0.0);
  const double tangent_squared = reach * reach - 0.25;
  const double radius = s.container_radius;
  for (double z = -radius + step / 2; z < radius; z += step)
    for (double x = -radius + step / 2; x < radius; x += step) {
      if (x * x + z * z > radius * radius) continue;
      double least = tangent_squared;
      std::size_t owner = areas.size();
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        const double to_x = s.x[i] - s.container_x - x, to_z = s.z[i] - s.container_z - z;
        const double power = to_x * to_x + to_z * to_z - s.radius[i] * s.radius[i];
        if (power < least) least = power, owner = i;
      }
      if (owner < areas.size()) areas[owner] += step * step;
    }
  return areas;
}

void expect_areas_by_points(const Snapshot& snapshot) {
  constexpr double step = 0.02;
  const auto cells = voronoi_cells(snapshot);
  const auto expected = areas_by_points(snapshot, step);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Points along a boundary of length L are right by chance: about step^2 sqrt(L/step), three times that.
    const double boundary = 4 * std::sqrt(pi * std::max(expected[i], 0.01));
    EXPECT_NEAR(cells[i].area, expected[i], 3 * step * step * std::sqrt(boundary / step)) << i;
  }
}

TEST(Voronoi, SquareLatticeHasItsVolumeFraction) {
  for (const int columns : {1, 2, 7}) {  // a cell may meet its own images
    const auto cells = voronoi_cells(testing::stacked_columns(columns, 9, 0));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool at_an_end = i % 9 == 0 || i % 9 == 8;
      EXPECT_EQ(cells[i].open, at_an_end);
      // Inside a square of side 1; at the surface half of it and a cap of radius `reach`, a strip 1 wide.
      EXPECT_NEAR(cells[i].area, at_an_end ? 0.5 + half_strip(reach, 0.5) : 1, 1e-12) << i;
    }
  }
}

TEST(Voronoi, GrainsThatLeftThePeriodStayInIt) {
  Snapshot layer = testing::hexagonal_layer(6, 8);
  const auto before = voronoi_cells(layer);
  for (std::size_t i = 0; i < layer.x.size(); ++i) layer.x[i] += 6.0 * (static_cast<int>(i % 7) - 3);
  const auto after = voronoi_cells(layer);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].area, before[i].area, 1e-12);
}

TEST(Voronoi, CellsFillTheContainer) {
  for (const auto& radii : {std::vector{0.5}, std::vector{0.5, 0.3}, std::vector{0.6, 0.04, 0.05, 0.04}}) {
    const Snapshot snapshot = thrown(9, radii, 150, 1);
    const auto cells = voronoi_cells(snapshot, 20);
    for (const VoronoiCell& cell : cells) EXPECT_FALSE(cell.open);
    EXPECT_NEAR(sum_of(cells), pi * 81, 1e-10);
  }
}

TEST(Voronoi, EachCellIsTheSetOfPointsNearestByPower) {
  // Loose, so that many cells end at the reach, at the container and at both.
  expect_areas_by_points(thrown(5, {0.5, 0.3}, 45, 3));
  expect_areas_by_points(thrown(5, {1.2, 0.1, 0.05, 0.2, 0.1, 0.05}, 60, 4));
  Snapshot overlapping = thrown(5, {0.4}, 50, 5);
  for (std::size_t i = 0; i < overlapping.radius.size(); ++i) overlapping.radius[i] = 0.4 + 0.05 * (i % 20);
  expect_areas_by_points(overlapping);
}

TEST(Voronoi, UnequalDiscsThatTouchArePartedAtTheContact) {
  Snapshot chain;  // one large and one small disc in turn
  chain.period_x = 1.5;
  add_grain(chain, 0, 0, 0.5);
  add_grain(chain, 0.75, 0, 0.25);
  const auto cells = voronoi_cells(chain);
  const double tangent_squared = reach * reach - 0.25;
  EXPECT_NEAR(cells[0].area, 2 * half_strip(reach, 0.5), 1e-12);
  EXPECT_NEAR(cells[1].area, 2 * half_strip(std::sqrt(0.0625 + tangent_squared), 0.25), 1e-12);
}

TEST(Voronoi, GrainsAloneOrInARowEndAtTheReach) {
  Snapshot alone;
  add_grain(alone, 3, 4, 0.5);
  EXPECT_NEAR(voronoi_cells(alone)[0].area, pi * reach * reach, 1e-12);
  EXPECT_TRUE(voronoi_cells(alone)[0].open);

  Snapshot row;
  for (int i = 0; i < 5; ++i) add_grain(row, i, 2.0 * i, 0.3);  // along no axis
  const double end = std::sqrt(0.09 + reach * reach - 0.25), half = std::sqrt(5.0) / 2;
  const auto cells = voronoi_cells(row);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(cells[i].area, 2 * half_strip(end, half), 1e-12);
  EXPECT_NEAR(cells[0].area, half_strip(end, half) + pi * end * end / 2, 1e-12);

  alone.container_radius = 0.7;  // the container's circle is all there is
  alone.container_x = 3;
  alone.container_z = 4.1;
  EXPECT_NEAR(voronoi_cells(alone)[0].area, pi * 0.49, 1e-12);
  EXPECT_FALSE(voronoi_cells(alone)[0].open);
}

TEST(Voronoi, GrainsInOnePlaceLeaveOneCell) {
  Snapshot pile;
  for (int i = 0; i < 4; ++i) add_grain(pile, 1, 1, 0.5);
  add_grain(pile, 1, 1, 0.6);
  add_grain(pile, 1.001, 1, 0.2);  // deep inside
  const auto cells = voronoi_cells(pile);
  for (int i : {0, 1, 2, 3, 5}) EXPECT_EQ(cells[i].area, 0) << i;
  EXPECT_NEAR(cells[4].area, pi * (0.36 + reach * reach - 0.25), 1e-12);
}

TEST(Voronoi, GrainsOutsideTheContainerTakeNoPart) {
  Snapshot snapshot = thrown(9, {0.5, 0.3}, 150, 7);
  const double sum = sum_of(voronoi_cells(snapshot));
  const std::size_t before = snapshot.x.size();
  add_grain(snapshot, 1, -2 + 9.2, 0.5);
  add_grain(snapshot, 1e9, 0, 0.5);
  add_grain(snapshot, std::numeric_limits<double>::quiet_NaN(), 0, 0.5);
  add_grain(snapshot, 1, -2, 0);
  auto cells = voronoi_cells(snapshot);
  for (std::size_t i = before; i < cells.size(); ++i) EXPECT_TRUE(std::isnan(cells[i].area));
  cells.resize(before);
  EXPECT_EQ(sum_of(cells), sum);
}

TEST(ConvexPolygon, RoundedAreasOfSquaresAndLenses) {
  ConvexPolygon square;
  square.make_square(1);
  const auto within = [&](const std::vector<Circle>& discs) { return area_within(square, discs); };
  EXPECT_NEAR(within({{0, 0, 1}}).area, pi, 1e-14);
  EXPECT_NEAR(within({{0, 0, 1}}).length_on_first, 2 * pi, 1e-14);
  EXPECT_NEAR(within({{0, 0, 2}}).area, 4, 1e-14);
  EXPECT_EQ(within({{0, 0, 2}}).length_on_first, 0);
  EXPECT_NEAR(within({{1, 1, 1}}).area, pi / 4, 1e-14);
  EXPECT_NEAR(within({{5, 5, 1}}).area, 0, 1e-14);
  EXPECT_NEAR(within({{0, 0, 0.5}, {0, 0, 3}}).area, pi / 4, 1e-14);
  EXPECT_NEAR(within({{0, 0, 3}, {0, 0, 0.5}}).area, pi / 4, 1e-14);
  // Two unit discs one apart: the lens 2 pi/3 - sqrt(3)/2.
  EXPECT_NEAR(within({{-0.5, 0, 1}, {0.5, 0, 1}}).area, 2 * pi / 3 - std::sqrt(3.0) / 2, 1e-14);
  // Within a large circle almost a half plane: x < 0 but for a segment of height 0.5^2/1e6.
  EXPECT_NEAR(within({{-1e6, 0, 1e6}}).area, 2 - 2.0 / 3 / 2e6, 1e-9);
}

}  // namespace
}  // namespace drumlin
