// Memory that the phases of a step share, and what a step takes of it.
#include "particles/parallel/work_memory.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(WorkMemory, ArraysEndWithTheirFrame) {
  WorkMemory memory;
  WorkArray<double> outer, inner;
  outer.use(&memory), inner.use(&memory);
  {
    const WorkMemory::Scope scope(&memory);
    outer.assign(100, 1.0);
    {
      const WorkMemory::Scope within(&memory);
      inner.assign(1000, 2.0);
      EXPECT_EQ(inner.size(), 1000);
    }
    EXPECT_TRUE(inner.empty());
    EXPECT_EQ(outer.size(), 100);
    EXPECT_EQ(outer[99], 1.0);
  }
  EXPECT_TRUE(outer.empty());
}

TEST(WorkMemory, OneFrameTakesTheBytesOfTheOneBefore) {
  WorkMemory memory;
  WorkArray<double> first, second;
  first.use(&memory), second.use(&memory);
  for (int step = 0; step < 3; ++step) {
    {
      const WorkMemory::Scope scope(&memory);
      first.assign(100000, 1.0);
    }
    const WorkMemory::Scope scope(&memory);
    second.assign(90000, 2.0);
  }
  EXPECT_LE(memory.bytes(), 100000 * sizeof(double) + 64);
}

TEST(WorkMemory, PiecesOfItBecomeOne) {
  WorkMemory memory;
  const auto take_forty = [&] {
    const WorkMemory::Scope scope(&memory);
    const auto* const first = static_cast<std::byte*>(memory.take(50048));
    const std::byte* last = first;
    for (int k = 1; k < 40; ++k) last = static_cast<std::byte*>(memory.take(50048));
    return last - first;
  };
  (void)take_forty();
  const std::size_t all = memory.bytes();
  for (int step = 0; step < 3; ++step) EXPECT_EQ(take_forty(), 39 * 50048);
  EXPECT_EQ(memory.bytes(), all);
  memory.release();
  EXPECT_EQ(memory.bytes(), 0);
  EXPECT_EQ(take_forty(), 39 * 50048);
  EXPECT_EQ(memory.bytes(), all);
}

TEST(WorkMemory, LongerArraysKeepWhatTheyHold) {
  WorkMemory memory;
  const WorkMemory::Scope scope(&memory);
  for (WorkMemory* of : {&memory, static_cast<WorkMemory*>(nullptr)}) {
    WorkArray<int> array;
    array.use(of);
    array.resize_uninitialized(3);
    array[0] = 5, array[1] = 6, array[2] = 7;
    array.resize(5000);
    EXPECT_EQ(array.size(), 5000);
    EXPECT_EQ(array[0], 5);
    EXPECT_EQ(array[2], 7);
  }
}

TEST(WorkMemory, NothingIsTakenOutsideOfAFrame) {
  WorkMemory memory;
  EXPECT_THROW((void)memory.take(8), std::logic_error);
}

/// Bytes per contact: those that stay from step to step, and those that its phases share.
TEST(WorkMemory, AStepTakesSoMuchPerContact) {
  constexpr int grains = 3000;
  GeneratedGrains made{grains, 3, 3.6, CircleRegion{{0, 0}, 146}};
  made.placement = Placement::deposited;
  test::TestRun simulation(test::scene_of(made)
                               .between({test::drum_wall(146)})
                               .with(Gravity{}, Friction{0.4, 0.95}, Restitution{0.46, 0.46}, Spin{})
                               .lasting(0.06 / test::time_s, 1e-3 / test::time_s)
                               .moving("drum", Rotation{6, {0, 0}}));
  std::int64_t contacts = 0;
  simulation.each_step([&](const StepReport& report) { contacts = std::max(contacts, report.contacts); });
  const StepMemory memory = simulation.stepper().memory();
  EXPECT_GT(contacts, 1.9 * grains);
  EXPECT_LT(static_cast<double>(memory.kept), 400.0 * contacts);
  EXPECT_LT(static_cast<double>(memory.shared), 240.0 * contacts);
  simulation.release_memory();
  EXPECT_EQ(simulation.stepper().memory().shared, 0);
}

}  // namespace
}  // namespace drumlin
