// Cases for the keys of a cell that is periodic in x and z.
#include "tests/scene/every_key_cases.hpp"
#include "tests/support/scene_text.hpp"

namespace drumlin::testing {
using namespace particles;
namespace {

/// Grains in random motion in a cell that is sheared.
const std::string cell =
    "format = \"drumlin-scene-1\"\n"
    "periodic_x = { x_min_mm = -8, x_max_mm = 8 }\n"
    "periodic_z = { z_min_mm = 0, z_max_mm = 13 }\n" +
    test::generated_grains(8, "{ shape = \"rectangle\", min_mm = [-8, 1], max_mm = [8, 12] }") +
    R"([effects.friction]
grain_grain = 0.4
grain_wall = 0.4
[[stages]]
name = "move"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
cell = { shear_rate_per_s = 20 }
[output]
velocity_window_s = 2e-3
)";

const std::string moving = "grains.thermal_speed_mm_s=100";
const std::string pressed = "stages.0.cell={xx={pressure_n_m2=0.2}, zz={pressure_n_m2=0.2}}";
const std::string strained = "stages.0.cell={xx={rate_per_s=-1}, zz={rate_per_s=-1}}";

}  // namespace

std::vector<Case> cases_of_cell() {
  const std::string* C = &cell;
  const std::string key = "stages[].cell", first = "stages.0.cell.";
  return {
      {"periodic_z", "", C, {moving}, "periodic_z={z_min_mm=-1, z_max_mm=14}", positions_mm},
      {"periodic_z.z_min_mm", "", C, {moving}, "periodic_z.z_min_mm=-1", positions_mm},
      {"periodic_z.z_max_mm", "", C, {moving}, "periodic_z.z_max_mm=15", positions_mm},
      {key, "", C, {moving}, "stages.0.cell={xx={rate_per_s=1}}", positions_mm},
      {key + ".shear_rate_per_s", "", C, {}, first + "shear_rate_per_s=10", positions_mm},
      {key + ".xx", "", C, {}, first + "xx={rate_per_s=-1}", positions_mm},
      {key + ".zz", "", C, {}, first + "zz={rate_per_s=-1}", positions_mm},
      {key + ".xx.rate_per_s", "", C, {strained}, first + "xx.rate_per_s=1", positions_mm},
      {key + ".zz.rate_per_s", "", C, {strained}, first + "zz.rate_per_s=1", positions_mm},
      {key + ".xx.pressure_n_m2", "", C, {pressed}, first + "xx.pressure_n_m2=0.1", positions_mm},
      {key + ".zz.pressure_n_m2", "", C, {pressed}, first + "zz.pressure_n_m2=0.1", positions_mm},
      {key + ".inertia", "", C, {pressed}, first + "inertia=2", positions_mm},
  };
}

}  // namespace drumlin::testing
