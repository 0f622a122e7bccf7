// A run that is stopped and read back from its checkpoint goes on as if nothing had been, with every effect.
#include "coupling/core/basics/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/validate.hpp"
#include "particles/stepping/prolong.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

struct Case {
  const char* name;
  void (*add)(Scene&);
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

/// Two stages in place of the one, the first so long.
void cut(Scene& scene, double first_s) {
  scene.stages.push_back(scene.stages[0]);
  scene.stages[0].duration_s = first_s;
  scene.stages[1].duration_s = *scene.stages[1].duration_s - first_s;
  scene.stages[1].name = "on";
}

/// A cell without walls in place of the drum.
void put_into_cell(Scene& s) {
  s.walls.clear(), s.stages[0].motions.clear(), s.effects.gravity.reset();
  s.periodic_x = PeriodicX{0, 32}, s.periodic_z = PeriodicZ{0, 32};
  std::get<GeneratedGrains>(s.grains.source).region = RectangleRegion{{0, 0}, {32, 32}};
}

const Case cases[] = {
    {"MaterialPairs",
     [](Scene& s) {
       s.grains.materials = {{"glass"}, {"steel"}};
       s.walls[0].material = "steel";
       s.effects.friction->pairs = {{{"glass", "steel"}, 0.1}};
       s.effects.restitution->pairs = {{{"glass", "glass"}, 0.8}};
     }},
    {"Rocking",
     [](Scene& s) {
       s.stages[0].motions = {{"drum", Rocking{20, 4, 10, {0, 0}}}};
     }},
    {"OpenedWall",
     [](Scene& s) {
       s.walls.push_back({"gate", SegmentShape{{-29, -12}, {29, -12}}});
       std::get<GeneratedGrains>(s.grains.source).region = CircleRegion{{0, 9}, 19};
       cut(s, 0.1);
       s.stages[1].opens = {"gate"};
     }},
    {"StageGravity",
     [](Scene& s) {
       cut(s, 0.1);
       s.stages[0].gravity = StageGravity{{}, -120, true};
       s.stages[1].gravity = StageGravity{5, {}, true};
     }},
    {"StageCoefficients",
     [](Scene& s) {
       cut(s, 0.1);
       s.stages[0].effects.friction = {0, 0};
       s.stages[1].effects.restitution = {0.9, 0.9};
       s.effects.cohesion = Cohesion{1, 1};
       s.stages[1].effects.cohesion = {3, 0};
     }},
    {"StageThatEndsEarly",
     [](Scene& s) {
       cut(s, 0.1);
       s.walls.push_back({"rod", DiscShape{{0, 25}, 1}});
       for (Stage& stage : s.stages) stage.motions.push_back({"rod", Translation{{0, -10}}});
       // At steps 60 and 150; the second one is never at rest for long enough.
       s.stages[0].until = Until{{}, UntilMoved{"rod", 0.595}};
       s.stages[1].until = Until{UntilRest{1e3, 10}, UntilMoved{"rod", 0.895}};
       s.stages[0].snapshots = s.stages[1].snapshots = 3;
     }},
    {"PressedWall",
     [](Scene& s) {
       s.walls.push_back({"lid", SegmentShape{{-15, 15}, {15, 15}}});
       s.walls.push_back({"post", DiscShape{{-28, 9}, 1}});
       PressureControl lid{{0, -1}, 500, 0.05};
       lid.between = {"post", "drum"};
       s.stages[0].motions.push_back({"lid", lid});
     }},
    {"StrainedWall",
     [](Scene& s) {
       cut(s, 0.1);
       s.walls.push_back({"lid", SegmentShape{{-15, 15}, {15, 15}}});
       for (Stage& stage : s.stages) stage.motions.push_back({"lid", StrainRate{{0, 1}, {0, -20}, -3}});
     }},
    {"WallLoads",
     [](Scene& s) {
       s.output.walls_every_s = 0.05;
       s.grains.thermal_speed_mm_s = 100;
     }},
    {"PressedCell",
     [](Scene& s) {
       put_into_cell(s);
       s.stages[0].cell = StageCell{CellAxis{{}, -0.5}, CellAxis{200, {}}, 5, 1};
       s.stages[0].snapshots = 3;
     }},
    {"TwoMotionsOfOneWall",
     [](Scene& s) {
       cut(s, 0.1);
       s.walls.push_back({"lid", DiscShape{{0, 22}, 6}});
       for (Stage& stage : s.stages) {
         stage.motions.push_back({"drum", Oscillation{{1, 2}, 8, 20}});
         stage.motions.push_back({"lid", Rotation{50, {0, 22}}});
         stage.motions.push_back({"lid", ForceControl{{0.2, -1}, 20, 0.05, {}}});
       }
     }},
    {"Belt",
     [](Scene& s) {
       s.walls.push_back({"belt", SegmentShape{{-20, -15}, {20, -15}}});
       std::get<GeneratedGrains>(s.grains.source).region = CircleRegion{{0, 6}, 20};
       s.stages[0].motions.push_back({"belt", Belt{300}});
     }},
    {"WallThatActsOnAMaterial",
     [](Scene& s) {
       s.grains.materials = {{"glass"}, {"steel"}};
       s.walls.push_back({"sieve", SegmentShape{{-28, -12}, {28, -12}}, {}, {}, {{"steel"}}});
       std::get<GeneratedGrains>(s.grains.source).region = CircleRegion{{0, 9}, 19};
     }},
    {"OutletsAndSources",
     [](Scene& s) {
       s.outlets = {{"hole", RectangleRegion{{-12, -32}, {12, -20}}, RectangleRegion{{-8, 5}, {8, 15}}}};
       Source rain{"rain", RectangleRegion{{-8, 16}, {8, 24}}};
       rain.grains_per_s = 100, rain.diameter_min_mm = 2, rain.diameter_max_mm = 4;
       rain.density_kg_m3 = 5000, rain.velocity_mm_s = {30, -50};
       s.sources = {rain};
     }},
};

/// What a run leaves beside places and velocities.
std::vector<double> numbers_of(const TestRun& run) {
  const SimulationState& state = run.state();
  std::vector<double> all(state.bodies.id.begin(), state.bodies.id.end());
  const auto add = [&all](const auto&... numbers) { (all.push_back(static_cast<double>(numbers)), ...); };
  const auto append = [&all](const auto& list) { all.insert(all.end(), list.begin(), list.end()); };
  append(state.memory.impulse), append(run.plan().snapshot_steps);
  add(state.step, state.ends.size());
  for (const DrivenState& driven : state.driven) add(driven.position, driven.velocity);
  if (const auto& cell = state.cell) add(cell->length_x, cell->length_z, cell->rate_z, cell->offset);
  if (!state.loads) return all;
  add(state.loads->time);
  for (const WallLoad& load : state.loads->walls)
    add(load.moment, load.impulse_x, load.place.angle, load.last.angle - load.first.angle);
  return all;
}

class Restart : public ::testing::TestWithParam<Case> {};

TEST_P(Restart, ContinuesBitForBitOnAnyThreads) {
  const TemporaryFolder folder;
  Scene scene = turning_drum();
  GetParam().add(scene);
  const EndedRun whole(scene);
  TestRun first(scene);
  first.to_step(117);
  Checkpoint checkpoint;
  checkpoint.state = first.state();
  write_checkpoint(folder.path() / "checkpoint.h5", checkpoint);
  const EndedRun second(scene, read_checkpoint(folder.path() / "checkpoint.h5").state, 2);
  expect_same(whole.bodies(), second.bodies());
  EXPECT_EQ(numbers_of(whole), numbers_of(second));
  if (whole.state().traffic) {
    EXPECT_GT(whole.state().traffic->poured[0], 10);
    EXPECT_GT(whole.state().traffic->outlets[0].taken(), 3);
  }
  // The effect does something: without it the end is another.
  EXPECT_NE(whole.bodies().x, bodies_at_end(turning_drum()).x);
}

TEST(Prolong, GivesWhatTheLongerSceneGives) {
  Scene scene = turning_drum();
  scene.stages[0].snapshots = 4;
  TestRun shorter(scene);
  shorter.each_step([&] {
    if (shorter.snapshot_due()) (void)shorter.take_snapshot();
  });
  SimulationState state = shorter.state();
  const Scene longer = prolonged(scene, 0.1, state);
  EXPECT_EQ(longer.stages[0].snapshots, 6);
  EXPECT_NEAR(*longer.stages[0].duration_s, 0.3, 1e-12);
  TestRun whole(longer), second(longer, state);
  for (TestRun* run : {&whole, &second})
    run->each_step([run] {
      if (run->snapshot_due() && !run->finished()) (void)run->take_snapshot();
    });
  EXPECT_EQ(whole.state().step, 300);
  expect_same(whole.bodies(), second.bodies());
  EXPECT_EQ(whole.state().memory.impulse, second.state().memory.impulse);
  EXPECT_EQ(whole.state().snapshots, second.state().snapshots);
  EXPECT_EQ(whole.take_snapshot().displacement_x, second.take_snapshot().displacement_x);
}

// 7 rpm: 0.1 turns are 857.14 steps of 1 ms, so that 857 are 1.00017 ms long each and the window is 5.999.
TEST(Prolong, LeavesASceneThatIsReadAgainWhereTheStepWasAdjusted) {
  Scene scene = turning_drum();
  scene.stages[0].duration_s = 0.85714285714285714;
  scene.stages[0].time_step_s = 1e-3;
  scene.stages[0].snapshots = 100;
  scene.output.velocity_window_s = 6e-3;
  SimulationState state = Simulation(scene).state();
  for (int k = 1; k <= 3; ++k) {
    state.step = state.step_in_stage = time_plan(scene, scales_of(scene)).steps;
    scene = prolonged(scene, 0.857, state);
    EXPECT_EQ(scene.stages[0].snapshots, 100 * (1 + k));
    EXPECT_EQ(time_plan(scene, scales_of(scene)).steps, 857 * (1 + k));
    EXPECT_TRUE(validate(scene).empty()) << validate(scene)[0].what;
  }
  // 10.4 steps, as 10 of 1.04 ms: a window of six would be 4 % longer.
  scene.stages[0].duration_s = 0.0104, scene.stages[0].time_step_s = 1e-3, scene.stages[0].snapshots = 1;
  ASSERT_TRUE(validate(scene).empty());
  state.step = state.step_in_stage = 10;
  EXPECT_THROW((void)prolonged(scene, 0.01, state), InputError);
}

TEST(Prolong, RefusesWhatWouldHaveGoneAnotherWay) {
  Scene scene = turning_drum(5);
  TestRun run(scene);
  SimulationState state = run.state();
  EXPECT_THROW((void)prolonged(scene, 0.1, state), InputError);  // not finished
  run.to_end();
  state = run.state();
  scene.stages[0].snapshots = 100;  // every second step, the window being six
  EXPECT_THROW((void)prolonged(scene, 0.1, state), InputError);
  scene.stages[0].snapshots = 0;
  EXPECT_NO_THROW((void)prolonged(scene, 0.1, state));
  EXPECT_THROW((void)prolonged(scene, 1e30, state), InputError);
  scene.stages[0].snapshots = 1;
  EXPECT_THROW((void)prolonged(scene, 1e8, state), InputError);  // more than a scene can ask for
}

INSTANTIATE_TEST_SUITE_P(Effects, Restart, ::testing::ValuesIn(cases),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace drumlin
