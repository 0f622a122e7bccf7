// Frames of runs: closed forms of packings at rest and in motion, what is kept, what is refused.
#include <gtest/gtest.h>

#include <numeric>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/frames/run_frames.hpp"
#include "tests/measurement/packings.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
namespace {

constexpr double disc = std::numbers::pi / 4;  // area of a grain

/// Columns of discs between x = 0 and 20, 16 high, on a floor, at rest and under their weight.
Snapshot block(double time) {
  Snapshot snapshot = testing::stacked_columns(20, 16, 0);
  snapshot.period_x = 0;
  snapshot.time = time;
  return snapshot;
}

/// On the floor, the one shape, between walls 10 d beside it that nothing touches.
FrameRun run_of(std::vector<Snapshot> snapshots) {
  FrameRun run;
  run.name = "run";
  for (const Snapshot& snapshot : snapshots) run.times.push_back(snapshot.time);
  run.read = [all = std::move(snapshots)](std::size_t i) { return all.at(i); };
  run.walls = {"floor", "beside"};
  run.wall_of_shape = {0, 1};
  run.shapes_at = [](const Snapshot&) -> std::vector<Shape> {
    return {Segment{{-10, 0}, {30, 0}}, Segment{{-10, 0}, {-10, 50}}};
  };
  return run;
}

Frames frames_of_one(const FrameRun& run, const FrameOptions& options) {
  return frames_of(std::span(&run, 1), options);
}

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(Frames, OfABlockAtRestHaveItsAreaHeightAndWeight) {
  const Frames frames = frames_of_one(run_of({block(0)}), {.times = {0}});
  const Frame& frame = frames.frames.at(0);
  EXPECT_NEAR(frames.nu_bulk, disc, 1e-12);  // kernels add up to 1 on a lattice of their spacing
  EXPECT_NEAR(frame.scalars.at("area"), 320, 1e-10);
  EXPECT_NEAR(frame.scalars.at("centre_x"), 10, 1e-12);
  EXPECT_NEAR(frame.scalars.at("centre_z"), 8, 1e-12);
  EXPECT_NEAR(frame.loads.at("floor")[1], -320 * disc, 1e-10);
  EXPECT_EQ(frame.loads.at("floor")[0], 0);
  EXPECT_EQ(frame.loads.at("beside")[1], 0);
  double area = 0;  // but for the columns 1 d outside, which have 1/48 of a row's grain: less than 0.05
  for (const double nu : frame.fields.at("nu")) area += std::isnan(nu) ? 0 : nu;
  EXPECT_NEAR(area, (320 - 2 * 16.0 / 48) * disc, 1e-10);
  EXPECT_NEAR(total(frame.mass_height), 320, 1e-10);
  const auto column = static_cast<std::size_t>(std::lround(10 - frames.grid.x_first));
  EXPECT_NEAR(frame.mass_height[column], 16, 1e-10);
  // Grains at the middles of rows: nu at the rows around the top is 1/6, 5/6 of the bulk's.
  EXPECT_NEAR(frame.height[column], 16, 1e-10);
  EXPECT_TRUE(std::isnan(frame.height.front()));
  const auto row = static_cast<std::size_t>(std::lround(7.5 - frames.grid.z_first));
  // The weight above the middle of the row, half of its own grains included.
  EXPECT_NEAR(frame.fields.at("sigma_zz")[row * frames.grid.columns + column], 8.5 * disc, 1e-3);
  EXPECT_NEAR(frame.fields.at("v_x")[row * frames.grid.columns + column], 0, 0);
  EXPECT_EQ(frames.header.kernel_width, 1);
}

TEST(Frames, OfABlockThatGlidesHaveItsVelocityWhereverItHasOne) {
  Snapshot gliding = block(3);
  for (std::size_t i = 0; i < gliding.x.size(); ++i) gliding.v_x[i] = 0.3, gliding.v_z[i] = -0.2;
  const Frames frames = frames_of_one(run_of({block(1), gliding}), {.origin = 1, .times = {0, 2}});
  const Frame& frame = frames.frames.at(1);
  std::size_t nodes = 0;
  for (std::size_t n = 0; n < frames.grid.nodes(); ++n) {
    const double v_x = frame.fields.at("v_x")[n];
    EXPECT_EQ(std::isnan(v_x), std::isnan(frame.fields.at("nu")[n]));
    if (std::isnan(v_x)) continue;
    ++nodes;
    EXPECT_NEAR(v_x, 0.3, 1e-14);
    EXPECT_NEAR(frame.fields.at("v_z")[n], -0.2, 1e-14);
  }
  EXPECT_GT(nodes, 320u);
  EXPECT_NEAR(frame.scalars.at("kinetic_energy"), 320 * disc * (0.09 + 0.04) / 2, 1e-10);
}

TEST(Frames, CountWhatHasFallenBelowAllWallsOrIsGone) {
  std::vector<Snapshot> snapshots;
  for (int s = 0; s < 4; ++s) {
    Snapshot snapshot = block(s);
    snapshot.contacts.clear();
    for (std::int64_t i = 0; i < 320; ++i) snapshot.id.push_back(i);
    for (std::size_t i = 0; i < 10u * static_cast<std::size_t>(s); ++i) snapshot.z[i] = -5;
    if (s == 3) {  // an outlet has taken the first five of those
      const auto take = [](auto& values) { values.erase(values.begin(), values.begin() + 5); };
      for (auto* values :
           {&snapshot.x, &snapshot.z, &snapshot.v_x, &snapshot.v_z, &snapshot.radius, &snapshot.spin})
        take(*values);
      take(snapshot.id);
    }
    snapshots.push_back(snapshot);
  }
  const std::vector<FrameRun> runs{run_of(snapshots),
                                   run_of({snapshots[0], snapshots[0], snapshots[0], snapshots[0]})};
  std::vector<FrameRun> both = runs;
  both[1].times = both[0].times;
  const Frames frames = frames_of(both, {.times = {0, 1, 2, 3}});
  ASSERT_EQ(frames.frames.size(), 8u);
  for (std::size_t t = 0; t < 4; ++t) {
    const auto& of = frames.frames[t].scalars;
    EXPECT_NEAR(of.at("discharged"), 10.0 * static_cast<double>(t), 1e-10);
    EXPECT_NEAR(of.at("area") + of.at("discharged"), 320, 1e-10);
    EXPECT_NEAR(of.at("discharge_rate"), 10, 1e-10);
    EXPECT_EQ(frames.frames[4 + t].scalars.at("discharged"), 0);
  }
  EXPECT_GE(frames.grid.z_first, -3);  // what has left makes no nodes
}

TEST(Frames, AreOfTheSnapshotNextToEachTimeOrRefused) {
  const std::vector<double> times{0, 4, 5, 7};
  const auto next = [&](double time) { return next_snapshot(times, time); };
  EXPECT_EQ(next(1.9), 0u);
  EXPECT_EQ(next(2.1), 1u);
  EXPECT_EQ(next(5), 2u);
  EXPECT_EQ(next(8), 3u);  // half of the last interval
  EXPECT_EQ(next(8.1), std::nullopt);
  EXPECT_EQ(next(-2.1), std::nullopt);
  EXPECT_EQ(next_snapshot(std::vector{3.0}, 3), 0u);
  EXPECT_EQ(next_snapshot(std::vector{3.0}, 3.1), std::nullopt);
  const Frames frames = frames_of_one(run_of({block(0), block(4)}), {.times = {0, 3.5}});
  EXPECT_EQ(frames.header.further.at("snapshot_distance"), "0.5");
  expect_has(message_of<InputError>([] {
               frames_of_one(run_of({block(0), block(4)}), {.times = {7}});
             }),
             "no snapshot at the time 7");
  Snapshot thin = testing::stacked_columns(20, 3, 0);
  thin.period_x = 0;
  expect_has(message_of<InputError>([&] { frames_of_one(run_of({thin}), {.times = {0}}); }), "--nu-bulk");
  EXPECT_NEAR(frames_of_one(run_of({thin}), {.times = {0}, .nu_bulk = disc}).frames[0].scalars.at("area"), 60,
              1e-10);
}

}  // namespace
}  // namespace drumlin
