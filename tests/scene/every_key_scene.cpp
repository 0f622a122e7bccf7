// Cases for the keys of runs, grains and walls.
#include "tests/scene/every_key_cases.hpp"

namespace drumlin::testing {
using namespace particles;
namespace {

const std::string periodic = "periodic_x={x_min_mm=-10, x_max_mm=10}";
const std::string two_listed = "grains={density_kg_m3=2700, listed={file=\"two.csv\"}}";
// A first impact that no solver settles in one sweep to 1e-12.
const std::vector<std::string> hopeless = {"solver.tolerance=1e-12", "solver.max_sweeps=1",
                                           "solver.check_every=1"};
const std::vector<std::string> stopping = with(hopeless, "solver.stop_when_unconverged=true");
const std::string round = "shape = \"circle\"";
const std::string straight = "shape = \"rectangle\"";
const std::string container = "shape = \"container\"";
const std::string segment = "shape = \"segment\"";
const std::string disc = "shape = \"disc\"";
const std::string rough = "walls.0.rough={diameter_mm=1, spacing_mm=2}";
const std::string power_law = "grains.generated.sizes={kind=\"power_law\", exponent=3}";
const std::string sieve =
    "grains.generated.sizes={kind=\"sieve\", openings_mm=[3.1, 3.5], passing_share=[0.2, 0.5]}";
const std::string lognormal = "grains.generated.sizes={kind=\"lognormal\", median_mm=3.3, sigma=0.5}";

}  // namespace

std::vector<Case> cases_of_the_run() {
  const std::string* D = &drum_scene();
  return {
      {"format", "", D, {}, "format=drumlin-scene-2", exit_code},
      {"title", "", D, {}, "title=\"another\"", title},
      {"reduced", "", D, {}, "reduced=true", reduced},
      {"seed", "", D, {}, "seed=2", positions_mm},

      {"solver", "", D, {}, "solver={}", logged_sweeps},
      {"solver.name", "", D, {}, "solver.name=accelerated", logged_sweeps},
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
      {"solver.projection_share", "", D, hopeless, "solver.projection_share=0.6", logged_overlaps},
      {"solver.stop_when_unconverged", "", D, hopeless, "solver.stop_when_unconverged=true", status},

      {"solver.capture_unconverged", "", D, hopeless, "solver.capture_unconverged=2", captured},

      {"output", "", D, {}, "output={}", windows_s},
      {"output.velocity_window_s", "", D, {}, "output.velocity_window_s=3e-3", windows_s},
      {"output.log_every_steps", "", D, {}, "output.log_every_steps=3", logged_steps},
      // A run that fails before its first checkpoint leaves none.
      {"output.checkpoint_every_s", "", D, stopping, "output.checkpoint_every_s=1e-3", checkpoint},
      {"output.energy_ledger", "", D, {}, "output.energy_ledger=true", energy_columns},
  };
}

std::vector<Case> cases_of_grains() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  return {
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
      {"grains.generated.placement", "", D, {}, "grains.generated.placement=\"deposited\"", positions_mm},
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
      {"grains.generated.sizes.by",
       "kind = \"two\"",
       D,
       {"grains.generated.sizes={kind=\"two\", small_share=0.5}"},
       "grains.generated.sizes.by=\"mass\"",
       positions_mm},
      {"grains.generated.sizes.by",
       "kind = \"power_law\"",
       D,
       {power_law},
       "grains.generated.sizes.by=\"mass\"",
       positions_mm},
      {"grains.generated.sizes.by",
       "kind = \"lognormal\"",
       D,
       {lognormal},
       "grains.generated.sizes.by=\"mass\"",
       positions_mm},
      {"grains.generated.sizes.openings_mm",
       "kind = \"sieve\"",
       D,
       {sieve},
       "grains.generated.sizes.openings_mm=[3.2, 3.5]",
       positions_mm},
      {"grains.generated.sizes.passing_share",
       "kind = \"sieve\"",
       D,
       {sieve},
       "grains.generated.sizes.passing_share=[0.9, 0.95]",
       positions_mm},
      // The knob then stands in the region, and is known.
      {"grains.generated.around",
       "",
       F,
       {"walls.1.center_mm=[-4, 4]"},
       "grains.generated.around=[\"left\"]",
       exit_code},
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
  };
}

std::vector<Case> cases_of_walls() {
  const std::string* D = &drum_scene();
  const std::string* F = &floor_scene();
  return {
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
      {"walls[].acts_on",
       "",
       D,
       {"grains.materials=[{name=\"a\"}, {name=\"b\"}]", "walls.0.acts_on=[\"a\", \"b\"]",
        "stages.1.motions=[]", "stages.1={name=\"turn\", duration_s=0.05, time_step_s=1e-3, snapshots=1}"},
       "walls.0.acts_on=[\"a\"]",
       positions_mm},
      {"walls[].rough", "", F, {}, rough, positions_mm},
      {"walls[].rough.diameter_mm", "", F, {rough}, "walls.0.rough.diameter_mm=1.5", positions_mm},
      {"walls[].rough.spacing_mm", "", F, {rough}, "walls.0.rough.spacing_mm=1.7", positions_mm},
  };
}

}  // namespace drumlin::testing
