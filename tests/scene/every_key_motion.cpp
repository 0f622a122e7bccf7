// Cases for the keys of effects and stages.
#include "tests/scene/every_key_cases.hpp"

namespace drumlin::testing {
using namespace particles;
namespace {

const std::string rubbing = "effects.friction={grain_grain=0.4, grain_wall=0.4}";
const std::string rotation = "kind = \"rotation\"";
const std::string translation = "kind = \"translation\"";
const std::string oscillation = "kind = \"oscillation\"";
const std::string rocking = "kind = \"rocking\"";
const std::string force = "kind = \"force\"";
const std::string sticking = "effects.cohesion={grain_grain=5, grain_wall=5, range_d=0.1}";
const std::string shaken =
    "stages.0.motions=[{wall=\"left\", kind=\"oscillation\", amplitude_mm=[1, 0], frequency_hz=5}]";
const std::string rocked =
    "stages.0.motions=[{wall=\"left\", kind=\"rocking\", amplitude_deg=20, frequency_hz=5}]";
const std::string pushed =
    "stages.0.motions=[{wall=\"left\", kind=\"force\", direction=[1, 1], force_n_m=1, mass_kg_m=0.1}]";
const std::string slow = "effects.drag={rate_per_s=2}";
const std::string rolling = "effects.rolling_resistance={grain_grain=0.1, grain_wall=0.2}";

}  // namespace

std::vector<Case> cases_of_effects() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  return {
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
      {"effects.drag", "", D, {}, slow, positions_mm},
      {"effects.drag.rate_per_s", "", D, {slow}, "effects.drag.rate_per_s=8", positions_mm},
      {"effects.drag.spin_rate_per_s", "", D, {slow}, "effects.drag.spin_rate_per_s=40", spins_rad_s},
      {"effects.drag.grows_with", "", D, {slow}, "effects.drag.grows_with=diameter", positions_mm},
      {"effects.spin", "", F, {sliding, rubbing}, "effects.spin={}", spins_rad_s},
  };
}

std::vector<Case> cases_of_stages() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  return {
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

      {"stages[].motions[].speed_mm_s",
       "kind = \"belt\"",
       F,
       {rubbing, "stages.0.motions=[{wall=\"floor\", kind=\"belt\", speed_mm_s=100}]"},
       "stages.0.motions.0.speed_mm_s=-100",
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
  };
}

}  // namespace drumlin::testing
