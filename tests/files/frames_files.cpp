// frames.h5: what is in it, refusals; a continuum under the kernel.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/frames_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::frames_files {
namespace {

using testing::expect_same;
using testing::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Two runs at three times, two columns, one row: each number says where it stands.
Frames example() {
  Frames frames;
  frames.grid = {0, 0.5, 1, 1, 2, 1};
  frames.scales = {2e-3, 0.014, 2700};
  frames.runs = {"RUN-1", "RUN-2"};
  frames.times = {0, 1, 2.5};
  frames.time_origin_s = 0.4;
  frames.nu_bulk = 0.8;
  for (double n = 0; n < 6; ++n)
    frames.frames.push_back({{n, nan}, {n, -n}, {{"nu", {n, 2 * n}}}, {{"area", n}}, {{"floor", {n, -n}}}});
  return frames;
}

TEST(FramesFile, HoldsRunsAndTimesBeforeTheNodes) {
  const TemporaryFolder folder;
  write_frames(folder / "frames.h5", example());
  const H5Reader in(folder / "frames.h5");
  using Lengths = std::vector<std::size_t>;
  EXPECT_EQ(in.shape("fields/nu"), (Lengths{2, 3, 1, 2}));
  EXPECT_EQ(in.shape("mass_height"), (Lengths{2, 3, 2}));
  EXPECT_EQ(in.shape("loads/floor"), (Lengths{2, 3, 2}));
  expect_same(in.doubles("fields/nu"), {0, 0, 1, 2, 2, 4, 3, 6, 4, 8, 5, 10});
  expect_same(in.doubles("height"), {0, nan, 1, nan, 2, nan, 3, nan, 4, nan, 5, nan});
  expect_same(in.doubles("scalars/area"), {0, 1, 2, 3, 4, 5});
  expect_same(in.doubles("times"), {0, 1, 2.5});
  EXPECT_EQ(in.text("format"), "drumlin-frames-1");
  EXPECT_EQ(in.text("runs"), "RUN-1\nRUN-2\n");
  EXPECT_EQ(in.text("header"), "nu_bulk = 0.8\ntime_origin_s = 0.4\n");
}

TEST(FramesFile, WhatDoesNotFitTogetherIsNotWritten) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& part, auto spoil) {
    Frames frames = example();
    spoil(frames);
    expect_has(message_of<InputError>([&] { write_frames(folder / "frames.h5", frames); }), part);
    EXPECT_FALSE(std::filesystem::exists(folder / "frames.h5"));
  };
  refused("5 frames of 2 runs at 3 times", [](Frames& frames) { frames.frames.pop_back(); });
  refused("height", [](Frames& frames) { frames.frames[1].mass_height.pop_back(); });
  refused("nu has another length", [](Frames& frames) { frames.frames[2].fields["nu"].pop_back(); });
  refused("not the same", [](Frames& frames) { frames.frames[3].loads.clear(); });
  refused("not the same", [](Frames& frames) { frames.frames[4].scalars["more"] = 1; });
}

/// A block of 0.8 from x = -8 to 8 and z = 0 to 10 that moves like a simple shear with a pressure 3 - z/5.
TEST(SmoothedFlow, IsTheFlowInsideAndHalfOfItsVolumeFractionAtAnEdge) {
  const MapGrid grid{-12, -3.5, 1, 1, 25, 18};
  SmoothedFlow smoothed(grid, 1);
  constexpr double side = 1.0 / 16;
  for (double x = -8 + side / 2; x < 8; x += side)
    for (double z = side / 2; z < 10; z += side) {
      const double P = 3 - z / 5;
      smoothed.add({x, z, side * side, {0.8, 0.3 * z, -0.1, {}, {P, -0.2 * P, -0.2 * P, P}}});
    }
  const Frame frame = smoothed.frame(0.8);
  const auto at = [&](const char* field, std::size_t column, std::size_t row) {
    return frame.fields.at(field)[row * grid.columns + column];
  };
  // The errors are those of the midpoint rule of sixteen points in a width.
  EXPECT_NEAR(at("nu", 12, 8), 0.8, 1e-6);
  EXPECT_NEAR(at("nu", 4, 8), 0.4, 1e-6);  // x = -8
  EXPECT_NEAR(at("v_x", 12, 8), 0.3 * 4.5, 1e-6);
  EXPECT_NEAR(at("v_z", 4, 8), -0.1, 1e-12);
  const double P = 3 - 0.9, kinetic = 0.8 * 0.3 * 0.3 / 3;  // of the shear under the kernel: w^2/3
  EXPECT_NEAR(at("sigma_xx", 12, 8), P + kinetic, 1e-4);
  EXPECT_NEAR(at("sigma_zz", 12, 8), P, 1e-6);
  EXPECT_NEAR(at("sigma_xz", 12, 8), 0.2 * P, 1e-6);
  EXPECT_NEAR(at("I", 12, 8), 0.3 / std::sqrt(P + kinetic / 2), 1e-4);
  for (const char* field : {"nu", "v_x", "I"}) EXPECT_TRUE(std::isnan(at(field, 0, 8)));
  // nu falls through its half at the edge itself, and linearly from node to node.
  EXPECT_NEAR(frame.height[12], 10, 0.01);
  EXPECT_TRUE(std::isnan(frame.height[0]));
}

}  // namespace
}  // namespace drumlin::frames_files
