// Grains that fly far away cost no memory: a window around the packing is measured, and they are counted.
#include <gtest/gtest.h>

#include <random>

#include "particles/measurement/frame/dense_window.hpp"
#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/maps/map_measurement.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::add_grain;
using testing::at;
using testing::measurement_of;
using testing::source_of;

/// 40 x 12 discs in an open heap: a box of 40 d by 11 d.
Snapshot open_block() {
  Snapshot block = testing::hexagonal_layer(40, 12);
  block.period_x = 0;
  return block;
}

/// Places that no two machines disagree about.
Snapshot thrown_over(double size, std::size_t count) {
  Snapshot spray;
  spray.time_step = 0.01;
  std::mt19937 engine(7);
  const auto place = [&] { return size * (static_cast<double>(engine()) / 4294967296.0 - 0.5); };
  for (std::size_t i = 0; i < count; ++i) {
    const double x = place();
    add_grain(spray, x, place(), 0.5);
  }
  return spray;
}

std::size_t nodes_of_maps(const Measurement& measured) {
  return begun_maps(measured.place, 1, 1, std::make_shared<ScratchFile>()).graining.grid.nodes();
}

/// What the limits leave of nodes 1 d apart, with the rim of a map around them.
double most_nodes_for(std::size_t grains) {
  const WindowLimits limits = window_limits(grains);
  return limits.area + 6 * (limits.height + limits.area / limits.height) + 36;
}

MeasurementOptions everything() {
  MeasurementOptions options;
  options.voronoi = options.sensitivity = true;
  options.gradient_step = 5;
  options.slices.emplace();
  return options;
}

TEST(Scattered, OneGrainFarAwayChangesNoProfileOfTheBlock) {
  const Measurement alone = measurement_of(open_block(), everything());
  EXPECT_FALSE(alone.scattered);
  Snapshot with_stray = open_block();
  add_grain(with_stray, 1e6, -1e6, 0.5);
  const Measurement measured = measurement_of(with_stray, everything());
  ASSERT_TRUE(measured.scattered);
  EXPECT_EQ(measured.scattered->last, 1u);
  EXPECT_DOUBLE_EQ(measured.scattered->mean, 1);
  EXPECT_NEAR(measured.place.reach.width(), alone.place.reach.width(), 1e-9);
  EXPECT_NEAR(measured.place.reach.height(), alone.place.reach.height(), 1e-9);
  EXPECT_NEAR(measured.wall_z, alone.wall_z, 1e-9);
  ASSERT_EQ(measured.profiles.z.size(), alone.profiles.z.size());
  for (const char* name : {"nu", "nu_voronoi", "count"})
    for (std::size_t l = 0; l < alone.profiles.z.size(); ++l) {
      EXPECT_NEAR(measured.profiles.z[l], alone.profiles.z[l], 1e-9);
      if (at(alone, name, l) > 0) {
        EXPECT_NEAR(at(measured, name, l), at(alone, name, l), 1e-9) << name << ' ' << l;
      }
    }
  EXPECT_LE(static_cast<double>(nodes_of_maps(measured)), most_nodes_for(with_stray.x.size()));
}

TEST(Scattered, SprayOverAMillionDiametersIsMeasuredInABoundedWindow) {
  const Snapshot spray = thrown_over(1e6, 400);
  const Measurement measured = measurement_of(spray, everything());
  ASSERT_TRUE(measured.scattered);
  EXPECT_GT(measured.scattered->mean, 390);  // 1e4 d^2 of 1e12 d^2 hold next to nothing
  EXPECT_LE(static_cast<double>(nodes_of_maps(measured)), most_nodes_for(400));
  EXPECT_LE(measured.place.reach.height(), window_limits(400).height + 1e-6);
}

TEST(Scattered, SiloThatRunsOutIsMeasuredWhereItsGrainsLay) {
  // Of 480 grains twelve leave at each snapshot, and fall freely from then on.
  std::vector<Snapshot> run;
  for (int s = 0; s < 40; ++s) {
    Snapshot here = open_block();
    here.time = 100.0 * s;
    for (std::size_t i = 0; i < here.x.size(); ++i)
      if (const double falling = here.time - 100.0 * (static_cast<double>(i) / 12); falling > 0)
        here.z[i] -= falling * falling / 2;
    run.push_back(here);
  }
  const Measurement measured = particles::measurement(source_of(run), everything());
  ASSERT_TRUE(measured.scattered);
  EXPECT_NEAR(measured.scattered->mean, 12 * 19.5, 12);
  EXPECT_EQ(measured.scattered->last, 12u * 39);
  EXPECT_LT(measured.place.reach.height(), 11 + 8);  // the cells beneath see grains that leave
}

TEST(Scattered, PeriodicDomainKeepsItsWidth) {
  Snapshot layer = testing::hexagonal_layer(30, 10);
  add_grain(layer, 3, 1e7, 0.5);
  const Measurement measured = measurement_of(layer);
  ASSERT_TRUE(measured.scattered);
  EXPECT_EQ(measured.scattered->last, 1u);
  EXPECT_EQ(measured.place.period, 30);
  EXPECT_LT(measured.place.reach.height(), 10 + 1e-6);
}

TEST(Scattered, WindowTakesTheHeavierOfTwoHeaps) {
  Snapshot heaps = open_block();
  for (int i = 0; i < 100; ++i) add_grain(heaps, 5000 + i % 10, i / 10, 0.5);
  const Measurement measured = measurement_of(heaps);
  ASSERT_TRUE(measured.scattered);
  EXPECT_EQ(measured.scattered->last, 100u);
}

TEST(Scattered, OccupancyForgetsTheEmptierCellsAndKeepsThePacking) {
  Snapshot spray = thrown_over(1e8, 480);
  Occupancy occupancy;
  const FlowFrame frame;
  for (int s = 0; s < 60; ++s) {  // 60 x 480 cells are more than the 16 x 960 + 10,000 that are kept
    Snapshot here = open_block();
    for (std::size_t i = 0; i < spray.x.size(); ++i) add_grain(here, spray.x[i] + 1e5 * s, spray.z[i], 0.5);
    occupancy.add(here, frame);
  }
  const Rectangle window = occupancy.window({-1e8, 1e8, -1e8, 1e8}, window_limits(960));
  EXPECT_LE(window.x_min, 0);
  EXPECT_GE(window.x_max, 40);
  EXPECT_LT(window.x_max - window.x_min, 40 + 1);
}

TEST(Scattered, CellsOfThePackingDoNotFeelWhatFliesFarAway) {
  const Snapshot block = open_block();
  Snapshot with_spray = block;
  const Snapshot spray = thrown_over(1e6, 12);
  for (std::size_t i = 0; i < spray.x.size(); ++i) add_grain(with_spray, spray.x[i], spray.z[i], 0.5);
  const auto alone = voronoi_cells(block), among = voronoi_cells(with_spray);
  for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(among[i].area, alone[i].area, 1e-12) << i;
  const double lonely = std::numbers::pi * voronoi_reach * voronoi_reach;
  for (std::size_t i = alone.size(); i < among.size(); ++i) EXPECT_NEAR(among[i].area, lonely, 1e-9) << i;
}

}  // namespace
}  // namespace drumlin
