// For every key of a scene file: another value, and what it changes in a tiny run. A key without a case fails
// the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "particles/scene/scene_file.hpp"
#include "tests/scene/every_key_runs.hpp"

namespace drumlin {
namespace {

using namespace testing;

/// A dozen grains in a drum that first rests, then turns; every effect.
const std::string drum = R"(format = "drumlin-scene-1"
[grains]
density_kg_m3 = 2700
[grains.generated]
count = 12
diameter_min_mm = 3.0
diameter_max_mm = 3.6
region = { shape = "circle", center_mm = [0, -1], radius_mm = 13 }
[[walls]]
name = "drum"
shape = "container"
center_mm = [0, 0]
radius_mm = 15
[effects.gravity]
[effects.friction]
grain_grain = 0.4
grain_wall = 0.9
[effects.restitution]
grain_grain = 0.5
grain_wall = 0.5
[effects.spin]
[[stages]]
name = "fall"
duration_s = 0.05
time_step_s = 1e-3
snapshots = 1
[[stages]]
name = "turn"
turns = 0.1
time_step_s = 1e-3
snapshots = 4
motions = [{ wall = "drum", kind = "rotation", speed_rpm = 60, center_mm = [0, 0] }]
[solver]
name = "nncg"
tolerance = 1e-6
penetration_tolerance = 1e3
max_sweeps = 200
check_every = 5
[output]
velocity_window_s = 2e-3
)";

/// Eight grains without friction that fall beside two knobs on a floor.
const std::string floor_and_knobs = R"(format = "drumlin-scene-1"
[grains]
density_kg_m3 = 2700
[grains.generated]
count = 8
diameter_min_mm = 3.0
diameter_max_mm = 3.6
region = { shape = "rectangle", min_mm = [-8, 1], max_mm = [8, 12] }
[[walls]]
name = "floor"
shape = "segment"
from_mm = [-20, 0]
to_mm = [20, 0]
[[walls]]
name = "left"
shape = "disc"
center_mm = [-4, 0]
diameter_mm = 1
[[walls]]
name = "right"
shape = "disc"
center_mm = [4, 0]
diameter_mm = 1
[effects.gravity]
[[stages]]
name = "fall"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
motions = [{ wall = "left", kind = "translation", velocity_mm_s = [20, 0] }]
[output]
velocity_window_s = 2e-3
)";

struct Case {
  std::string path;       ///< as listed
  std::string condition;  ///< as listed
  const std::string* scene;
  std::vector<std::string> common;  ///< overrides of both runs
  std::string change;               ///< one more override
  Observable seen;
};

/// What gtest says of a case that fails.
void PrintTo(const Case& one, std::ostream* out) { *out << one.path << ": " << one.change; }

std::vector<Case> cases() {
  const std::string round = "shape = \"circle\"", straight = "shape = \"rectangle\"",
                    container = "shape = \"container\"", segment = "shape = \"segment\"",
                    disc = "shape = \"disc\"", rotation = "kind = \"rotation\"",
                    translation = "kind = \"translation\"";
  const std::string rubbing = "effects.friction={grain_grain=0.4, grain_wall=0.4}";
  const std::string sliding = "effects.gravity.direction_deg=-45";
  const std::string periodic = "periodic_x={x_min_mm=-10, x_max_mm=10}";
  const std::string two_listed = "grains={density_kg_m3=2700, listed={file=\"two.csv\"}}";
  // A first impact that no solver settles in one sweep to 1e-12.
  const std::vector<std::string> hopeless = {"solver.tolerance=1e-12", "solver.max_sweeps=1",
                                             "solver.check_every=1"};
  std::vector<std::string> stopping = hopeless;
  stopping.push_back("solver.stop_when_unconverged=true");
  // Two materials among the grains, the wall of one of them.
  const std::vector<std::string> materials = {"grains.materials=[{name=\"a\"}, {name=\"b\"}]",
                                              "walls.0.material=b"};
  const auto with = [](std::vector<std::string> all, const std::string& one) {
    all.push_back(one);
    return all;
  };
  const std::string pairs = ".pairs=[{between=[\"a\", \"b\"], value=0.05}]";
  const std::string sticking = "effects.cohesion={grain_grain=5, grain_wall=5, range_d=0.1}";
  const std::string shaken =
      "stages.0.motions=[{wall=\"left\", kind=\"oscillation\", amplitude_mm=[1, 0], frequency_hz=5}]";
  const std::string rocked =
      "stages.0.motions=[{wall=\"left\", kind=\"rocking\", amplitude_deg=20, frequency_hz=5}]";
  const std::string pushed =
      "stages.0.motions=[{wall=\"left\", kind=\"force\", direction=[1, 1], force_n_m=1, mass_kg_m=0.1}]";
  const std::string rolling = "effects.rolling_resistance={grain_grain=0.1, grain_wall=0.2}";
  const std::string force = "kind = \"force\"";
  const std::string rough = "walls.0.rough={diameter_mm=1, spacing_mm=2}";
  const std::string oscillation = "kind = \"oscillation\"", rocking = "kind = \"rocking\"";
  const std::string power_law = "grains.generated.sizes={kind=\"power_law\", exponent=3}";
  const std::string lognormal = "grains.generated.sizes={kind=\"lognormal\", median_mm=3.3, sigma=0.5}";
  const auto *D = &drum, *F = &floor_and_knobs;
  return {
      {"format", "", D, {}, "format=drumlin-scene-2", exit_code},
      {"title", "", D, {}, "title=\"another\"", title},
      {"reduced", "", D, {}, "reduced=true", reduced},
      {"seed", "", D, {}, "seed=2", positions_mm},

      {"periodic_x", "", F, {sliding}, periodic, positions_mm},
      {"periodic_x.x_min_mm", "", F, {sliding, periodic}, "periodic_x.x_min_mm=-12", positions_mm},
      {"periodic_x.x_max_mm", "", F, {sliding, periodic}, "periodic_x.x_max_mm=12", positions_mm},

      {"grains", "", F, {}, two_listed, positions_mm},
      {"grains.density_kg_m3", "", D, {}, "grains.density_kg_m3=1000", density},
      {"grains.materials[]",
       "",
       D,
       {"walls.0.material=b", "effects.friction" + pairs, "grains.materials=[{name=\"a\"}]"},
       "grains.materials=[{name=\"a\"}, {name=\"b\"}]",
       positions_mm},
      {"grains.materials[].name", "", D, with(materials, "effects.friction" + pairs),
       "grains.materials=[{name=\"c\"}, {name=\"b\"}, {name=\"a\"}]", positions_mm},
      {"grains.materials[].share", "", D, with(materials, "effects.friction" + pairs),
       "grains.materials.0.share=100", positions_mm},
      {"grains.generated",
       "",
       F,
       {two_listed},
       "grains={density_kg_m3=2700, generated={count=2, diameter_min_mm=3, diameter_max_mm=3.5, "
       "region={shape=\"rectangle\", min_mm=[-8, 1], max_mm=[8, 12]}}}",
       positions_mm},
      {"grains.generated.count", "", D, {}, "grains.generated.count=11", positions_mm},
      {"grains.generated.diameter_min_mm", "", D, {}, "grains.generated.diameter_min_mm=2.9", positions_mm},
      {"grains.generated.diameter_max_mm", "", D, {}, "grains.generated.diameter_max_mm=3.7", positions_mm},
      {"grains.generated.sizes", "", D, {}, power_law, positions_mm},
      {"grains.generated.sizes.kind",
       "",
       D,
       {power_law},
       "grains.generated.sizes={kind=\"two\", small_share=0.5}",
       positions_mm},
      {"grains.generated.sizes.small_share",
       "kind = \"two\"",
       D,
       {"grains.generated.sizes={kind=\"two\", small_share=0.5}"},
       "grains.generated.sizes.small_share=0.9",
       positions_mm},
      {"grains.generated.sizes.exponent",
       "kind = \"power_law\"",
       D,
       {power_law},
       "grains.generated.sizes.exponent=9",
       positions_mm},
      {"grains.generated.sizes.median_mm",
       "kind = \"lognormal\"",
       D,
       {lognormal},
       "grains.generated.sizes.median_mm=3.1",
       positions_mm},
      {"grains.generated.sizes.sigma",
       "kind = \"lognormal\"",
       D,
       {lognormal},
       "grains.generated.sizes.sigma=0.05",
       positions_mm},
      {"grains.generated.region",
       "",
       D,
       {},
       "grains.generated.region={shape=\"circle\", radius_mm=14}",
       positions_mm},
      {"grains.generated.region.shape",
       "",
       D,
       {},
       "grains.generated.region={shape=\"rectangle\", min_mm=[-10, -10], max_mm=[10, 10]}",
       positions_mm},
      {"grains.generated.region.center_mm",
       round,
       D,
       {},
       "grains.generated.region.center_mm=[1, 1]",
       positions_mm},
      {"grains.generated.region.radius_mm",
       round,
       D,
       {},
       "grains.generated.region.radius_mm=12",
       positions_mm},
      {"grains.generated.region.min_mm",
       straight,
       F,
       {},
       "grains.generated.region.min_mm=[-7.9, 1.1]",
       positions_mm},
      // The lattice fills the region from its lower left corner: the other one decides how many stand in a
      // row.
      {"grains.generated.region.max_mm",
       straight,
       F,
       {},
       "grains.generated.region.max_mm=[4, 30]",
       positions_mm},
      {"grains.listed", "", F, {}, two_listed, positions_mm},
      {"grains.listed.file", "", F, {two_listed}, "grains.listed.file=three.csv", positions_mm},

      {"walls[]", "", F, {"stages.0.motions=[]"}, "walls=[]", positions_mm},
      {"walls[].name", "", F, {}, "walls.2.name=left", positions_mm},  // then it moves with the left one
      {"walls[].shape",
       "",
       F,
       {},
       "walls.2={name=\"right\", shape=\"segment\", from_mm=[4, 0], to_mm=[4, 0.5]}",
       positions_mm},
      {"walls[].center_mm", container, D, {}, "walls.0.center_mm=[0.5, 0]", positions_mm},
      {"walls[].radius_mm", container, D, {}, "walls.0.radius_mm=15.5", positions_mm},
      {"walls[].from_mm", segment, F, {}, "walls.0.from_mm=[-20, -1]", positions_mm},
      {"walls[].to_mm", segment, F, {}, "walls.0.to_mm=[20, -1]", positions_mm},
      {"walls[].center_mm", disc, F, {}, "walls.2.center_mm=[4.5, 0]", positions_mm},
      {"walls[].diameter_mm", disc, F, {}, "walls.2.diameter_mm=1.5", positions_mm},

      {"walls[].material",
       "",
       D,
       {"grains.materials=[{name=\"a\"}, {name=\"b\"}]", "effects.friction" + pairs},
       "walls.0.material=b",
       positions_mm},
      {"walls[].rough", "", F, {}, rough, positions_mm},
      {"walls[].rough.diameter_mm", "", F, {rough}, "walls.0.rough.diameter_mm=1.5", positions_mm},
      {"walls[].rough.spacing_mm", "", F, {rough}, "walls.0.rough.spacing_mm=1.7", positions_mm},

      {"effects", "", F, {}, "effects={}", positions_mm},
      {"effects.gravity", "", F, {"effects={}"}, "effects.gravity={}", positions_mm},
      {"effects.gravity.acceleration_m_s2",
       "",
       D,
       {},
       "effects.gravity.acceleration_m_s2=1.62",
       positions_mm},
      {"effects.gravity.direction_deg", "", D, {}, "effects.gravity.direction_deg=-80", positions_mm},
      {"effects.friction", "", F, {sliding}, rubbing, positions_mm},
      {"effects.friction.grain_grain", "", D, {}, "effects.friction.grain_grain=0.1", positions_mm},
      {"effects.friction.grain_wall", "", D, {}, "effects.friction.grain_wall=0.1", positions_mm},
      {"effects.friction.pairs[]", "", D, materials, "effects.friction" + pairs, positions_mm},
      {"effects.friction.pairs[].between", "", D, with(materials, "effects.friction" + pairs),
       "effects.friction.pairs.0.between=[\"a\", \"a\"]", positions_mm},
      {"effects.friction.pairs[].value", "", D, with(materials, "effects.friction" + pairs),
       "effects.friction.pairs.0.value=0.8", positions_mm},
      {"effects.restitution",
       "",
       F,
       {},
       "effects.restitution={grain_grain=0.9, grain_wall=0.9}",
       kinetic_energy},
      {"effects.restitution.grain_grain", "", D, {}, "effects.restitution.grain_grain=0", kinetic_energy},
      {"effects.restitution.grain_wall", "", D, {}, "effects.restitution.grain_wall=0", kinetic_energy},
      {"effects.restitution.pairs[]", "", D, materials, "effects.restitution" + pairs, kinetic_energy},
      {"effects.restitution.pairs[].between", "", D, with(materials, "effects.restitution" + pairs),
       "effects.restitution.pairs.0.between=[\"a\", \"a\"]", kinetic_energy},
      {"effects.restitution.pairs[].value", "", D, with(materials, "effects.restitution" + pairs),
       "effects.restitution.pairs.0.value=0.9", kinetic_energy},
      {"effects.rolling_resistance", "", D, {}, rolling, spins_rad_s},
      {"effects.rolling_resistance.grain_grain",
       "",
       D,
       {rolling},
       "effects.rolling_resistance.grain_grain=0.5",
       spins_rad_s},
      {"effects.rolling_resistance.grain_wall",
       "",
       D,
       {rolling},
       "effects.rolling_resistance.grain_wall=0.5",
       spins_rad_s},
      {"effects.rolling_resistance.pairs[]", "", D, with(materials, rolling),
       "effects.rolling_resistance" + pairs, spins_rad_s},
      {"effects.rolling_resistance.pairs[].between", "", D,
       with(with(materials, rolling), "effects.rolling_resistance" + pairs),
       "effects.rolling_resistance.pairs.0.between=[\"a\", \"a\"]", spins_rad_s},
      {"effects.rolling_resistance.pairs[].value", "", D,
       with(with(materials, rolling), "effects.rolling_resistance" + pairs),
       "effects.rolling_resistance.pairs.0.value=0.6", spins_rad_s},
      {"effects.cohesion", "", D, {}, sticking, positions_mm},
      {"effects.cohesion.grain_grain", "", D, {sticking}, "effects.cohesion.grain_grain=2", positions_mm},
      {"effects.cohesion.grain_wall", "", D, {sticking}, "effects.cohesion.grain_wall=2", positions_mm},
      {"effects.cohesion.range_d", "", D, {sticking}, "effects.cohesion.range_d=0.3", positions_mm},
      {"effects.cohesion.pairs[]", "", D, with(materials, sticking), "effects.cohesion" + pairs,
       positions_mm},
      {"effects.cohesion.pairs[].between", "", D, with(with(materials, sticking), "effects.cohesion" + pairs),
       "effects.cohesion.pairs.0.between=[\"a\", \"a\"]", positions_mm},
      {"effects.cohesion.pairs[].value", "", D, with(with(materials, sticking), "effects.cohesion" + pairs),
       "effects.cohesion.pairs.0.value=9", positions_mm},
      {"effects.rotating_frame", "", F, {}, "effects.rotating_frame={speed_rpm=10}", positions_mm},
      {"effects.rotating_frame.speed_rpm",
       "",
       F,
       {"effects.rotating_frame={speed_rpm=10}"},
       "effects.rotating_frame.speed_rpm=-10",
       positions_mm},
      {"effects.rotating_frame.center_mm",
       "",
       F,
       {"effects.rotating_frame={speed_rpm=10}"},
       "effects.rotating_frame.center_mm=[50, 0]",
       positions_mm},
      {"effects.spin", "", F, {sliding, rubbing}, "effects.spin={}", spins_rad_s},

      {"stages[]",
       "",
       F,
       {},
       "stages=[{name=\"only\", duration_s=0.05, time_step_s=1e-3, snapshots=1}]",
       snapshot_times_s},
      {"stages[].name", "", D, {}, "stages.1.name=\"round\"", logged_stages},
      {"stages[].duration_s", "", D, {}, "stages.0.duration_s=0.06", steps},
      {"stages[].turns", "", D, {}, "stages.1.turns=0.2", steps},
      {"stages[].time_step_s", "", D, {}, "stages.0.time_step_s=2e-3", positions_mm},
      {"stages[].snapshots", "", D, {}, "stages.1.snapshots=5", snapshot_times_s},
      {"stages[].motions[]", "", F, {}, "stages.0.motions=[]", positions_mm},
      {"stages[].motions[].wall", "", F, {}, "stages.0.motions.0.wall=right", positions_mm},
      {"stages[].motions[].kind",
       "",
       F,
       {},
       "stages.0.motions.0={wall=\"left\", kind=\"rotation\", speed_rpm=60}",
       positions_mm},
      {"stages[].motions[].speed_rpm", rotation, D, {}, "stages.1.motions.0.speed_rpm=-60", spins_rad_s},
      {"stages[].motions[].center_mm", rotation, D, {}, "stages.1.motions.0.center_mm=[1, 0]", positions_mm},
      {"stages[].motions[].velocity_mm_s",
       translation,
       F,
       {},
       "stages.0.motions.0.velocity_mm_s=[20, 5]",
       positions_mm},

      {"stages[].motions[].amplitude_mm",
       oscillation,
       F,
       {shaken},
       "stages.0.motions.0.amplitude_mm=[2, 0]",
       positions_mm},
      {"stages[].motions[].frequency_hz",
       oscillation,
       F,
       {shaken},
       "stages.0.motions.0.frequency_hz=7",
       positions_mm},
      {"stages[].motions[].phase_deg",
       oscillation,
       F,
       {shaken},
       "stages.0.motions.0.phase_deg=90",
       positions_mm},
      {"stages[].motions[].amplitude_deg",
       rocking,
       F,
       {rocked},
       "stages.0.motions.0.amplitude_deg=-20",
       positions_mm},
      {"stages[].motions[].frequency_hz",
       rocking,
       F,
       {rocked},
       "stages.0.motions.0.frequency_hz=7",
       positions_mm},
      {"stages[].motions[].phase_deg", rocking, F, {rocked}, "stages.0.motions.0.phase_deg=90", positions_mm},
      {"stages[].motions[].center_mm",
       rocking,
       F,
       {rocked},
       "stages.0.motions.0.center_mm=[0, -9]",
       positions_mm},

      {"stages[].motions[].direction",
       force,
       F,
       {pushed},
       "stages.0.motions.0.direction=[1, 0.5]",
       positions_mm},
      {"stages[].motions[].force_n_m", force, F, {pushed}, "stages.0.motions.0.force_n_m=2", positions_mm},
      {"stages[].motions[].mass_kg_m", force, F, {pushed}, "stages.0.motions.0.mass_kg_m=0.2", positions_mm},
      {"stages[].motions[].velocity_mm_s",
       force,
       F,
       {pushed},
       "stages.0.motions.0.velocity_mm_s=[20, -20]",
       positions_mm},

      {"solver", "", D, {}, "solver={}", logged_sweeps},
      {"solver.name", "", D, {}, "solver.name=nlgs", logged_sweeps},
      {"solver.tolerance", "", D, {}, "solver.tolerance=1e-2", logged_sweeps},
      {"solver.penetration_tolerance",
       "",
       D,
       {"solver.tolerance=10"},
       "solver.penetration_tolerance=1e-12",
       logged_sweeps},
      {"solver.max_sweeps", "", D, hopeless, "solver.max_sweeps=7", logged_sweeps},
      {"solver.check_every", "", D, {}, "solver.check_every=7", logged_sweeps},
      {"solver.projection_sweeps", "", D, hopeless, "solver.projection_sweeps=0", logged_overlaps},
      {"solver.stop_when_unconverged", "", D, hopeless, "solver.stop_when_unconverged=true", exit_code},

      {"solver.capture_unconverged", "", D, hopeless, "solver.capture_unconverged=2", captured},

      {"output", "", D, {}, "output={}", windows_s},
      {"output.velocity_window_s", "", D, {}, "output.velocity_window_s=3e-3", windows_s},
      {"output.log_every_steps", "", D, {}, "output.log_every_steps=3", logged_steps},
      // A run that fails before its first checkpoint leaves none.
      {"output.checkpoint_every_s", "", D, stopping, "output.checkpoint_every_s=1e-3", checkpoint},
      {"output.energy_ledger", "", D, {}, "output.energy_ledger=true", energy_columns},
  };
}

std::string name_of(const std::string& path, const std::string& condition) {
  return condition.empty() ? path : path + " with " + condition;
}

TEST(EveryKeyTable, HasACase) {
  std::set<std::string> listed, covered;
  for (const auto& row : scene_keys()) listed.insert(name_of(row.path, row.condition));
  for (const auto& one : cases()) covered.insert(name_of(one.path, one.condition));
  for (const auto& key : listed) EXPECT_TRUE(covered.contains(key)) << "no case for " << key;
  for (const auto& key : covered) EXPECT_TRUE(listed.contains(key)) << "no such key: " << key;
}

TEST(EveryKeyTable, TheSameSceneGivesTheSameRun) {
  for (const auto* scene : {&drum, &floor_and_knobs}) {
    const auto first = summary_of_run(*scene, {}), second = summary_of_run(*scene, {});
    ASSERT_EQ(first.exit_code, 0);
    ASSERT_FALSE(first.snapshots.empty());
    for (const Observable seen :
         {positions_mm, spins_rad_s, kinetic_energy, logged_sweeps, logged_overlaps, windows_s})
      EXPECT_EQ(seen(first), seen(second));
  }
}

class EveryKey : public ::testing::TestWithParam<Case> {};

TEST_P(EveryKey, ChangesWhatARunLeaves) {
  const Case& one = GetParam();
  std::vector<std::string> changed = one.common;
  changed.push_back(one.change);
  const auto before = summary_of_run(*one.scene, one.common), after = summary_of_run(*one.scene, changed);
  EXPECT_NE(one.seen(before), one.seen(after)) << one.change;
  // A refused scene would differ in everything and prove nothing.
  if (one.seen != exit_code) {
    EXPECT_EQ(before.exit_code, after.exit_code);
    EXPECT_FALSE(before.log.empty());
    EXPECT_FALSE(after.log.empty()) << one.change << " was refused";
  }
}

INSTANTIATE_TEST_SUITE_P(Scene, EveryKey, ::testing::ValuesIn(cases()), [](const auto& chosen) {
  std::string name = name_of(chosen.param.path, chosen.param.condition);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

}  // namespace
}  // namespace drumlin
