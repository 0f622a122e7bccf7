// Outlets, sources and grains that leave: counts, identities and what of a state follows them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/flow_rate.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/scene/validate.hpp"
#include "tests/support/says.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Grains that fall freely, one above the other, into an outlet whose upper edge is at z = 0.
TestScene falling(int count) {
  std::vector<Grain> grains;
  for (int k = 0; k < count; ++k) grains.push_back({0, 2 + 3.0 * k});
  TestScene scene = scene_of(grains).with(Gravity{});
  scene.outlets = {{"below", RectangleRegion{{-50, -50}, {50, 0}}}};
  return scene;
}

double largest_overlap(const Bodies& bodies) {
  double deepest = 0;
  for (std::size_t a = 0; a < bodies.count(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      deepest = std::max(deepest, bodies.radius[a] + bodies.radius[b] -
                                      std::hypot(bodies.x[a] - bodies.x[b], bodies.z[a] - bodies.z[b]));
  return deepest;
}

TEST(Outlets, TakeEachGrainWhenItFallsIn) {
  const double h = 1e-3;
  Scene scene = falling(4).lasting(5, h);
  EndedRun run(scene);
  const OutletState& outlet = run.state().traffic->outlets[0];
  ASSERT_EQ(outlet.taken(), 4);
  // Free fall; one step more until it is taken, and the scheme's own error of h t / 2 in the place.
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(outlet.times[k], std::sqrt(2 * (2 + 3.0 * k)), 2 * h) << k;
  EXPECT_NEAR(outlet.mass, 4 * weight, 1e-12);
  EXPECT_EQ(run.bodies().count(), 0u);
}

TEST(Outlets, EndAStageAfterSoManyGrains) {
  Scene scene = falling(4).lasting(5, 1e-3);
  scene.stages[0].until.emplace().out = UntilOut{"below", 2};
  EXPECT_TRUE(validate(scene).empty());
  EndedRun run(scene);
  ASSERT_EQ(run.state().ends.size(), 1u);
  EXPECT_EQ(run.state().ends[0].by, EndedBy::outlet);
  EXPECT_EQ(run.bodies().id, (std::vector<std::int64_t>{2, 3}));
  scene.stages[0].until->out->outlet = "above";
  EXPECT_FALSE(validate(scene).empty());
}

TEST(Outlets, LeaveImpulsesAndDisplacementsWithTheirGrains) {
  // Grain 0 glides into the outlet; 1 and 2 press on each other and a floor; 3 glides on.
  const TemporaryFolder folder;
  Scene scene = on_floor({{-8, 20, 1, -1, 0}, {0, 0.5}, {0, 1.5}, {8, 20, 1, 1, 0}});
  scene.outlets = {{"left", RectangleRegion{{-20, 10}, {-9, 30}}}};
  add_stage(scene, 2, 0.01);
  scene.stages[0].snapshots = 1;
  scene.output.velocity_window_s = 1.5 * time_s;
  EndedRun run(scene);
  const Snapshot snapshot = run.take_snapshot();
  EXPECT_EQ(snapshot.id, (std::vector<std::int64_t>{1, 2, 3}));
  ASSERT_EQ(snapshot.displacement_x.size(), 3u);
  EXPECT_NEAR(snapshot.displacement_x[2], snapshot.velocity_window, 1e-9);
  EXPECT_NEAR(snapshot.displacement_x[0], 0, 1e-9);
  const ImpulseCache& memory = run.state().memory;
  for (std::size_t c = 0; c < memory.i.size(); ++c) EXPECT_LT(memory.i[c], 3);
  write_snapshot(folder.path() / "s.h5", snapshot);
  EXPECT_EQ(read_snapshot(folder.path() / "s.h5").id, snapshot.id);
}

TEST(Outlets, ReturnWhatTheyTakeAsNewGrains) {
  Scene scene = falling(3);
  scene.outlets[0].returns_to = RectangleRegion{{-2, 20}, {2, 24}};
  scene.outlets[0].return_velocity_mm_s = {0, -100};
  add_stage(scene, 30, 1e-2);
  TestRun run(scene);
  run.each_step([&] {
    const auto& state = run.state();
    EXPECT_EQ(state.bodies.count() + state.traffic->outlets[0].waiting.size(), 3u);
  });
  const auto& state = run.state();
  EXPECT_GT(state.traffic->outlets[0].taken(), 6);
  EXPECT_GE(state.bodies.id.front(), 3);
  EXPECT_EQ(state.traffic->next_id, 3 + state.traffic->outlets[0].taken());
}

TEST(Sources, PourAtTheirRateUpToTheirCountWithoutOverlap) {
  Scene scene = on_floor({{0, 0.5}});
  Source source{"rain", RectangleRegion{{-20, 30}, {20, 36}}};
  source.grains_per_s = 10 / time_s, source.count = 37;
  source.diameter_min_mm = 0.8, source.diameter_max_mm = 1.2, source.velocity_mm_s = {0, -200};
  scene.sources = {source};
  add_stage(scene, 3, 0.01);
  add_stage(scene, 2, 0.01);
  ASSERT_TRUE(validate(scene).empty());
  TestRun run(scene);
  std::size_t before = 1;
  run.each_step([&] {
    const auto& state = run.state();
    const double due = std::floor(10 * (state.time() - 0.01) + 1e-6);
    EXPECT_EQ(state.traffic->poured[0], std::min(37.0, due)) << state.step;
    if (state.bodies.count() > before) {
      EXPECT_LT(largest_overlap(state.bodies), 1e-3);
    }
    before = state.bodies.count();
  });
  EXPECT_EQ(before, 38u);
}

TEST(Sources, WaitForRoomAndCountWhatWaits) {
  // A disc of diameter 1 lies in the middle of a box of 2 x 2: there is no room for another of diameter 1.2.
  Scene scene = scene_of({{0, 0, 1}});
  Source source{"full", RectangleRegion{{-1, -1}, {1, 1}}};
  source.grains_per_s = 1 / time_s;
  source.diameter_min_mm = source.diameter_max_mm = 1.2;
  scene.sources = {source};
  add_stage(scene, 5.5, 0.1);
  EndedRun run(scene);
  const auto& state = run.state();
  EXPECT_EQ(state.bodies.count(), 1u);
  EXPECT_EQ(waiting(scene.sources[0], state.traffic->poured[0], state.time() * run.scales().time_s), 5);
}

TEST(Sources, AreRefusedWhereAnOutletTakesGrainsOrDiscsHaveNoRoom) {
  Scene scene = falling(1).lasting(1, 0.01);
  Source source{"rain", RectangleRegion{{-5, -5}, {5, 5}}};
  source.grains_per_s = 1, source.diameter_min_mm = 1, source.diameter_max_mm = 2;
  scene.sources = {source};
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].key, "sources.0.region");
  scene.sources[0].region = CircleRegion{{0, 8}, 0.9};
  ASSERT_EQ(validate(scene).size(), 1u);
  expect_has(validate(scene)[0].allowed, "2 mm");
  scene.sources[0].region = CircleRegion{{0, 8}, 5};
  EXPECT_TRUE(validate(scene).empty());
  scene.periodic_x = PeriodicX{-3, 3};  // a disc of 2 mm could touch another one on both sides
  const auto faults = validate(scene);
  EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [](const auto& fault) {
    return fault.key == "sources.0.diameter_max_mm" && fault.allowed.find("periodic_x") != std::string::npos;
  }));
}

TEST(FlowRate, IsThatOfTheMiddleOfTheOutflow) {
  std::vector<double> times;
  for (int k = 0; k < 1000; ++k) times.push_back(3 + 0.02 * k);
  const auto flow = flow_rate(times);
  ASSERT_TRUE(flow);
  EXPECT_NEAR(flow->rate, 50, 0.1);
  EXPECT_LT(flow->ci99, 0.5);
  EXPECT_NEAR(flow->from, 5, 1e-9);
  times.resize(99);
  EXPECT_FALSE(flow_rate(times));
}

TEST(SameGrains, AreMatchedByIdentity) {
  Snapshot before, now;
  before.x.resize(4), now.x.resize(3);
  EXPECT_TRUE(same_grains(before, now).empty());
  before.id = {0, 2, 5, 7}, now.id = {2, 6, 7};
  const auto same = same_grains(before, now);
  ASSERT_EQ(same.size(), 2u);
  EXPECT_EQ(same[0].before, 1u);
  EXPECT_EQ(same[0].now, 0u);
  EXPECT_EQ(same[1].before, 3u);
  EXPECT_EQ(same[1].now, 2u);
}

TEST(LeftGrains, AreCountedOnceInTheirStage) {
  const TemporaryFolder folder;
  Scene scene =
      scene_of({{0, 1}, {10, 1, 1, 100, 0}}).between({floor_wall(20)}).lasting(1, 0.01).lasting(1, 0.01);
  TestRun run(scene);
  EXPECT_FALSE(run.state().left);
  run.to_end();
  // It passes x = 20 + 100 at t = 1.1.
  ASSERT_TRUE(run.state().left);
  const LeftGrains& left = *run.state().left;
  EXPECT_EQ(left.per_stage, (std::vector<std::int64_t>{0, 1}));
  ASSERT_EQ(left.first.size(), 1u);
  EXPECT_EQ(left.first[0].grain, 1);
  EXPECT_NEAR(left.first[0].time, 1.1, 0.011);
  Checkpoint checkpoint;
  checkpoint.state = run.state();
  write_checkpoint(folder.path() / "c.h5", checkpoint);
  const auto read = read_checkpoint(folder.path() / "c.h5").state.left;
  ASSERT_TRUE(read);
  EXPECT_EQ(read->has_left, left.has_left);
  EXPECT_EQ(read->per_stage, left.per_stage);
}

/// A disc of the scene's density meets one of a group four times as dense, head on, and loses no energy.
TEST(Groups, OfTheirOwnDensityCollideByTheirMasses) {
  Scene scene = scene_of({{0, 0, 1, 1, 0}});
  const Scene heavy = scene_of({{2, 0, 1}});
  GrainGroup group;
  group.name = "intruder", group.density_kg_m3 = 4 * 2700;
  group.source = std::get<ListedGrains>(heavy.grains.source);
  scene.grains.groups = {group};
  scene.effects.restitution = Restitution{1, 1};
  add_stage(scene, 3, 0.01);
  scene.stages[0].snapshots = 1;
  scene.output.velocity_window_s = 0;
  for (const SceneFault& fault : validate(scene)) ADD_FAILURE() << fault.key << ' ' << fault.what;
  EndedRun run(scene);
  EXPECT_NEAR(run.bodies().v_x[0], -0.6, 1e-6);
  EXPECT_NEAR(run.bodies().v_x[1], 0.4, 1e-6);
  const Snapshot snapshot = run.take_snapshot();
  ASSERT_EQ(snapshot.mass.size(), 2u);
  EXPECT_NEAR(snapshot.mass[1] / snapshot.mass[0], 4, 1e-12);
  EXPECT_TRUE(snapshot.id.empty());
  FlowSnapshot in_frame;
  to_flow_frame(snapshot, FlowFrame{0, 0, 1, 0}, VelocityKind::instantaneous, in_frame);
  ASSERT_EQ(in_frame.density.size(), 2u);
  EXPECT_NEAR(in_frame.density[1] / in_frame.density[0], 4, 1e-12);
}

TEST(Groups, LeaveTheMainSourceAsItIsAndMustNotOverlapIt) {
  Scene scene = scene_of(GeneratedGrains{40, 1, 1.2, RectangleRegion{{0, 0}, {10, 10}}}).lasting(1, 0.01);
  const Bodies alone = Simulation(scene).state().bodies;
  GrainGroup group;
  group.name = "rain";
  group.source = GeneratedGrains{20, 0.5, 0.6, RectangleRegion{{0, 12}, {10, 16}}};
  scene.grains.groups = {group};
  const Bodies both = Simulation(scene).state().bodies;
  ASSERT_EQ(both.count(), 60u);
  EXPECT_TRUE(std::equal(alone.x.begin(), alone.x.end(), both.x.begin()));
  EXPECT_TRUE(std::equal(alone.z.begin(), alone.z.end(), both.z.begin()));
  scene.grains.groups[0].source = GeneratedGrains{20, 0.5, 0.6, RectangleRegion{{0, 2}, {10, 6}}};
  expect_has(message_of<InputError>([&] { (void)Simulation(scene); }), "\"rain\"");
}

}  // namespace
}  // namespace drumlin
