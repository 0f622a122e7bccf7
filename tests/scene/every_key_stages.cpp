// Cases for the keys of what stages change and of servo walls.
#include "tests/scene/every_key_cases.hpp"

namespace drumlin::testing {
using namespace particles;
namespace {

const std::string pressure = "kind = \"pressure\"";
const std::string strain_rate = "kind = \"strain_rate\"";
const std::string polyline = "shape = \"polyline\"";
const std::string arc = "shape = \"arc\"";

const std::string pressed =
    "stages.0.motions=[{wall=\"left\", kind=\"pressure\", direction=[1, 1], pressure_n_m2=200, "
    "mass_kg_m=0.1, between=[\"left\", \"right\"]}]";
const std::string strained =
    "stages.0.motions=[{wall=\"left\", kind=\"strain_rate\", direction=[1, 0], reference_mm=[4, 0], "
    "rate_per_s=-5}]";
const std::string bent = "walls.0={name=\"floor\", shape=\"polyline\", x_mm=[-20, 0, 20], z_mm=[0, -1, 0]}";
const std::string domed =
    "walls.0={name=\"floor\", shape=\"arc\", center_mm=[0, -60], radius_mm=60, from_deg=60, to_deg=120}";
const std::string tilted = "stages.0.gravity={direction_deg=-80, acceleration_m_s2=5}";
const std::string smooth = "stages.1.friction={grain_grain=0, grain_wall=0}";
const std::string lively = "stages.0.restitution={grain_grain=0.9, grain_wall=0.9}";
const std::string rolling = "effects.rolling_resistance={grain_grain=0.1, grain_wall=0.2}";
const std::string stiff = "stages.1.rolling_resistance={grain_grain=1, grain_wall=1}";
const std::string slippery = "effects.dynamic_friction={grain_grain=0.01, grain_wall=0.02, speed_mm_s=5}";
const std::string rubbing_later = "stages.1.dynamic_friction={grain_grain=0.8, grain_wall=0.9}";
const std::string sticky = "effects.cohesion={grain_grain=1, grain_wall=1}";
const std::string stickier = "stages.0.cohesion={grain_grain=5, grain_wall=5}";
const std::string moved = "stages.0.until={moved={wall=\"left\", distance_mm=1}}";
const std::string never = "stages.0.until={moved={wall=\"right\", distance_mm=1}}";
const std::string rested = "stages.0.until.at_rest={energy=1e6, for_s=0.01}";

}  // namespace

std::vector<Case> cases_of_servo_walls() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  const std::string motion = "stages[].motions[].", first = "stages.0.motions.0.";
  return {
      {motion + "direction", pressure, F, {pressed}, first + "direction=[1, 0.5]", positions_mm},
      {motion + "pressure_n_m2", pressure, F, {pressed}, first + "pressure_n_m2=400", positions_mm},
      {motion + "mass_kg_m", pressure, F, {pressed}, first + "mass_kg_m=0.2", positions_mm},
      {motion + "velocity_mm_s", pressure, F, {pressed}, first + "velocity_mm_s=[20, -20]", positions_mm},
      {motion + "between", pressure, F, {pressed}, first + "between=[\"floor\", \"right\"]", positions_mm},
      {motion + "direction", strain_rate, F, {strained}, first + "direction=[1, 1]", positions_mm},
      {motion + "reference_mm", strain_rate, F, {strained}, first + "reference_mm=[5, 0]", positions_mm},
      {motion + "rate_per_s", strain_rate, F, {strained}, first + "rate_per_s=-8", positions_mm},
      {"walls[].x_mm", polyline, F, {bent}, "walls.0.x_mm=[-20, 1, 20]", positions_mm},
      {"walls[].z_mm", polyline, F, {bent}, "walls.0.z_mm=[0, -2, 0]", positions_mm},
      {"walls[].center_mm", arc, F, {domed}, "walls.0.center_mm=[0, -61]", positions_mm},
      {"walls[].radius_mm", arc, F, {domed}, "walls.0.radius_mm=59", positions_mm},
      {"walls[].from_deg", arc, F, {domed}, "walls.0.from_deg=92", positions_mm},
      {"walls[].to_deg", arc, F, {domed}, "walls.0.to_deg=88", positions_mm},
      {"walls[].closed", polyline, F, {bent}, "walls.0.closed=true", positions_mm},
      {"output.walls_every_s", "", D, {}, "output.walls_every_s=0.03", wall_lines},
      {"grains.thermal_speed_mm_s", "", D, {}, "grains.thermal_speed_mm_s=100", positions_mm},
  };
}

std::vector<Case> cases_of_stage_changes() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  return {
      {"stages[].opens", "", F, {}, "stages.0.opens=[\"right\"]", positions_mm},
      {"stages[].gravity", "", F, {}, tilted, positions_mm},
      {"stages[].gravity.acceleration_m_s2",
       "",
       F,
       {tilted},
       "stages.0.gravity.acceleration_m_s2=4",
       positions_mm},
      {"stages[].gravity.direction_deg", "", F, {tilted}, "stages.0.gravity.direction_deg=-70", positions_mm},
      {"stages[].gravity.ramp", "", F, {tilted}, "stages.0.gravity.ramp=true", positions_mm},
      {"stages[].friction", "", D, {}, smooth, positions_mm},
      {"stages[].friction.grain_grain", "", D, {smooth}, "stages.1.friction.grain_grain=1", positions_mm},
      {"stages[].friction.grain_wall", "", D, {smooth}, "stages.1.friction.grain_wall=1", positions_mm},
      {"stages[].restitution", "", D, {}, lively, kinetic_energy},
      {"stages[].restitution.grain_grain",
       "",
       D,
       {lively},
       "stages.0.restitution.grain_grain=0",
       kinetic_energy},
      {"stages[].restitution.grain_wall",
       "",
       D,
       {lively},
       "stages.0.restitution.grain_wall=0",
       kinetic_energy},
      {"stages[].rolling_resistance", "", D, {rolling}, stiff, spins_rad_s},
      {"stages[].rolling_resistance.grain_grain",
       "",
       D,
       {rolling, stiff},
       "stages.1.rolling_resistance.grain_grain=0",
       spins_rad_s},
      {"stages[].rolling_resistance.grain_wall",
       "",
       D,
       {rolling, stiff},
       "stages.1.rolling_resistance.grain_wall=0",
       spins_rad_s},
      {"stages[].cohesion", "", D, {sticky}, stickier, positions_mm},
      {"stages[].cohesion.grain_grain",
       "",
       D,
       {sticky, stickier},
       "stages.0.cohesion.grain_grain=0",
       positions_mm},
      {"stages[].cohesion.grain_wall",
       "",
       D,
       {sticky, stickier},
       "stages.0.cohesion.grain_wall=0",
       positions_mm},
      {"stages[].dynamic_friction", "", D, {slippery}, rubbing_later, positions_mm},
      {"stages[].dynamic_friction.grain_grain",
       "",
       D,
       {slippery, rubbing_later},
       "stages.1.dynamic_friction.grain_grain=0",
       positions_mm},
      {"stages[].dynamic_friction.grain_wall",
       "",
       D,
       {slippery, rubbing_later},
       "stages.1.dynamic_friction.grain_wall=0",
       positions_mm},
      {"stages[].until", "", F, {}, moved, steps},
      {"stages[].until.moved",
       "",
       F,
       {"stages.0.until={at_rest={for_s=9}}"},
       "stages.0.until.moved={wall=\"left\", distance_mm=1}",
       steps},
      {"stages[].until.moved.wall", "", F, {moved}, "stages.0.until.moved.wall=right", steps},
      {"stages[].until.moved.distance_mm", "", F, {moved}, "stages.0.until.moved.distance_mm=0.5", steps},
      {"stages[].until.at_rest", "", F, {never}, rested, steps},
      {"stages[].until.at_rest.energy", "", F, {never, rested}, "stages.0.until.at_rest.energy=1e-9", steps},
      {"stages[].until.at_rest.for_s", "", F, {never, rested}, "stages.0.until.at_rest.for_s=0.02", steps},
  };
}

}  // namespace drumlin::testing
