#include "continuum/model/gap.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "continuum/model/scene_effects.hpp"

namespace drumlin::continuum {
namespace {

constexpr double degree = std::numbers::pi / 180;

double in_diameters(const Scales& scales, double length_mm) { return 1e-3 * length_mm / scales.length_m; }
double in_weights(const Scales& scales, double pressure_pa) { return pressure_pa / scales.stress_Pa(); }

// Heights of the rows of cells from the top down: `cell` within the fine zone, growing beyond it, shrunk
// together so that they fill the depth.
std::vector<double> graded_layers(const Gap& gap, double cell, double zone, double growth) {
  std::vector<double> layers;
  double sum = 0;
  while (sum < (1 - 1e-9) * gap.depth) {
    layers.push_back(cell + growth * std::max(0.0, sum - zone));
    sum += layers.back();
  }
  for (double& layer : layers) layer *= gap.depth / sum;
  if (gap.flows_at_wall) std::reverse(layers.begin(), layers.end());
  return layers;
}

PrescribedVelocity at_rest() {
  return {[](Vec2) { return Vec2{0, 0}; }};
}

void add_straight_sides(const Gap& gap, FlowProblem& problem) {
  problem.boundary[Side::bottom] = at_rest();
  if (gap.speed)
    problem.boundary[Side::top] = PressedWall{[speed = *gap.speed](Vec2) {
                                                return Vec2{speed, 0};
                                              },
                                              gap.pressure};
  else
    problem.boundary[Side::top] = Traction{[P = gap.pressure](Vec2) { return Vec2{0, -P}; }};
}

void add_cylinders(const Gap& gap, FlowProblem& problem) {
  problem.boundary[Side::top] = PrescribedVelocity{
      [rotation = -gap.speed.value() / gap.inner_radius](Vec2 p) { return rigid_rotation(rotation, 0, p); }};
  problem.boundary[Side::bottom] = PressedWall{[](Vec2) { return Vec2{0, 0}; }, gap.pressure};
}

}  // namespace

Gap gap_of(const FlowIncline& incline, const Scales& scales, double nu) {
  return {.depth = in_diameters(scales, incline.height_mm),
          .nu = nu,
          .weight = nu,
          .slope = incline.slope_deg * degree,
          .geometry = Geometry::incline,
          .scalars = {"theta_deg", "Q", "surface_speed", "mean_speed", "I", "mu_wall"}};
}

Gap gap_of(const FlowPlaneShear& shear, const Scales& scales, double nu) {
  return {.depth = in_diameters(scales, shear.gap_mm),
          .nu = nu,
          .pressure = in_weights(scales, shear.pressure_pa),
          .speed = in_diameters(scales, shear.wall_speed_mm_s) * scales.time_s,
          .geometry = Geometry::plane_shear,
          .scalars = {"shear_rate", "I", "mu_wall"}};
}

Gap gap_of(const FlowChute& chute, const Scales& scales, double nu) {
  return {.depth = in_diameters(scales, chute.half_width_mm),
          .nu = nu,
          .weight = nu,
          .slope = std::numbers::pi / 2,
          .pressure = in_weights(scales, chute.pressure_pa),
          .flows_at_wall = true,
          .geometry = Geometry::chute,
          .scalars = {"Q", "surface_speed", "mean_speed", "mu_wall"}};
}

Gap gap_of(const FlowAnnulus& ring, const Scales& scales, double nu) {
  const double inner = in_diameters(scales, ring.inner_radius_mm);
  return {.depth = in_diameters(scales, ring.outer_radius_mm) - inner,
          .inner_radius = inner,
          .nu = nu,
          .pressure = in_weights(scales, ring.pressure_pa),
          .speed = ring.rotation_rpm * std::numbers::pi / 30 * scales.time_s * inner,
          .geometry = Geometry::annulus,
          .scalars = {"Q", "torque", "mu_wall", "lambda"}};
}

Gap gap_of(const FlowScene& scene, double nu) {
  return std::visit(
      [&](const auto& geometry) -> Gap {
        if constexpr (requires { gap_of(geometry, scales_of(scene), nu); })
          return gap_of(geometry, scales_of(scene), nu);
        else
          throw std::logic_error("a drum or a region is no gap");
      },
      scene.geometry);
}

double gap_pressure(const Gap& gap, double y) { return gap.pressure + gap.weight * std::cos(gap.slope) * y; }

double gap_shear_stress(const Gap& gap, double top_shear_stress, double y) {
  if (gap.inner_radius > 0) {
    const double ratio = gap.inner_radius / (gap.inner_radius + y);
    return top_shear_stress * ratio * ratio;
  }
  return top_shear_stress + gap.weight * std::sin(gap.slope) * y;
}

namespace {

FlowProblem gap_without_law(const Gap& gap, const FlowMesh& mesh, const FlowRegularisation& regularisation) {
  FlowProblem problem;
  const double coarsest = mesh.surface_cell * std::pow(2.0, mesh.levels - 1);
  auto layers = graded_layers(gap, coarsest, mesh.surface_zone, mesh.growth);
  problem.regularisation = {regularisation.shear_rate, regularisation.pressure};
  problem.density = gap.weight;
  problem.slope = FixedSlope{gap.slope};
  if (gap.inner_radius > 0) {
    problem.domain = AnnulusDomain{.inner_radius = gap.inner_radius, .layers = std::move(layers)};
    add_cylinders(gap, problem);
  } else {
    problem.domain = BoxDomain{.width = 2 * coarsest,
                               .height = gap.depth,
                               .cells_x = 2,
                               .periodic_x = true,
                               .layers = std::move(layers)};
    add_straight_sides(gap, problem);
    // Greatest at the wall at rest; on an incline its mu is tan(slope) everywhere.
    if (!gap.speed)
      problem.load = StaticLoad{gap_shear_stress(gap, 0, gap.depth), gap_pressure(gap, gap.depth)};
  }
  return problem;
}

}  // namespace

FlowProblem gap_problem(const Gap& gap, const StressLaw& law, const FlowMesh& mesh,
                        const FlowRegularisation& regularisation) {
  FlowProblem problem = gap_without_law(gap, mesh, regularisation);
  problem.law = law;
  return problem;
}

FlowProblem gap_problem(const FlowScene& scene, const RheologyFit& law) {
  refuse_effects_of_the_drum(scene.effects);
  FlowProblem problem = gap_without_law(gap_of(scene, law.nu), scene.mesh, scene.regularisation);
  add_law_and_effects(scene, law, problem);
  return problem;
}

GapPlace gap_place(const Gap& gap, double y, double s) {
  if (gap.inner_radius == 0) return {{0, -y}, {1, 0}, {0, 1}};  // the same all along the strip
  const double angle = 2 * std::numbers::pi * s;
  const Vec2 outward{std::sin(angle), std::cos(angle)};
  const double r = gap.inner_radius + y;
  return {{r * outward.x, r * outward.z}, {-outward.z, outward.x}, {-outward.x, -outward.z}};
}

}  // namespace drumlin::continuum
