#include "continuum/model/drum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/model/scene_effects.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {

double DrumGeometry::half_chord() const { return std::sqrt(radius * radius - axis_offset * axis_offset); }

double DrumGeometry::expected_Q(double surface_height) const {
  const double below_axis = axis_offset - surface_height;
  return 0.5 * nu * rotation * (radius * radius - below_axis * below_axis);
}

DrumGeometry drum_geometry(const FlowScene& scene, double nu) {
  const auto& asked = std::get<FlowDrum>(scene.geometry);
  const Scales scales = scales_of(scene);
  DrumGeometry drum;
  drum.radius = 0.5e-3 * asked.diameter_mm / scales.length_m;
  drum.rotation = asked.rotation_rpm * std::numbers::pi / 30 * scales.time_s;
  if (asked.slope_deg) drum.slope = *asked.slope_deg * std::numbers::pi / 180;
  drum.nu = nu;
  const double area = grain_area(scene.grains, scene.grains.count.value()) / nu,
               whole = std::numbers::pi * drum.radius * drum.radius;
  if (area >= whole)
    throw InputError(
        {InputProblem{.file = "",
                      .key = "grains.count",
                      .what = fmt::format("the grains would cover {:.4g} d^2 at nu = {:.3g}", area, nu),
                      .allowed = fmt::format("less than the drum's {:.4g} d^2", whole)}});
  drum.axis_offset = chord_offset(drum.radius, area);
  return drum;
}

Vec2 entraining_wall_velocity(const DrumGeometry& drum, double length, Vec2 point, Vec2 left, Vec2 right) {
  constexpr double growth = 0.3;  // of the length per height of the end, measured from 2 to 15 rpm
  double share = 1;
  for (const Vec2& end : {left, right}) {
    const double from_end = std::hypot(point.x - end.x, point.z - end.z);
    share *= -std::expm1(-from_end / std::max(0.25 * length, length + growth * end.z));
  }
  const Vec2 rigid = rigid_rotation(drum.rotation, drum.axis_offset, point);
  return {share * rigid.x, share * rigid.z};
}

namespace {

// Chebyshev's points of degree n are (pi/n)^2/2 of the half width apart at its ends.
int resolved_degree(double half_width, double cell) {
  return std::clamp(static_cast<int>(std::numbers::pi * std::sqrt(half_width / (1.6 * cell))), 4, 60);
}

void add_effects_of_the_drum(const FlowScene& scene, const DrumGeometry& drum, FlowProblem& problem) {
  const FlowEffects& effects = scene.effects;
  if (effects.rotating_frame) problem.frame = RotatingFrame{drum.rotation, drum.axis_offset};
  if (problem.memory) problem.memory->turn = drum.rotation < 0 ? -1 : 1;
  if (const auto& moving = effects.moving_surface)
    problem.moving_surface =
        MovingSurface{.degree = moving->degree ? *moving->degree
                                               : resolved_degree(drum.half_chord(), scene.mesh.surface_cell),
                      .tolerance = moving->tolerance,
                      .slope_half_length = std::min(20.0, 0.5 * drum.half_chord()),
                      .wall_velocity = [drum, length = scene.boundary->entrainment_length](
                                           Vec2 point, Vec2 left, Vec2 right) {
                        return entraining_wall_velocity(drum, length, point, left, right);
                      }};
  if (const auto& slip = effects.wall_slip)  // the wall slides along the corners
    problem.boundary[Side::bottom] = FrictionWall{
        .velocity = [drum](Vec2 point) { return rigid_rotation(drum.rotation, drum.axis_offset, point); },
        .friction = slip->friction,
        .slip_speed = slip->slip_speed};
}

FlowProblem drum_without_law(const DrumGeometry& drum, const FlowMesh& mesh, const FlowBoundary& boundary,
                             const FlowRegularisation& regularisation) {
  FlowProblem problem;
  const double coarsest = mesh.surface_cell * std::pow(2.0, mesh.levels - 1);
  problem.domain = ChordDomain{.radius = drum.radius,
                               .axis_offset = drum.axis_offset,
                               .surface_cell = coarsest,
                               .surface_zone = mesh.surface_zone,
                               .growth = mesh.growth};
  problem.regularisation = {regularisation.shear_rate, regularisation.pressure};
  problem.density = drum.nu;
  problem.slope = SlopeFromMoment{};
  if (drum.slope) {
    const double weight = drum.nu * (drum.radius - drum.axis_offset);
    problem.slope = FixedSlope{*drum.slope};
    problem.load = StaticLoad{weight * std::sin(*drum.slope), weight * std::cos(*drum.slope)};
  }
  problem.boundary[Side::top] = NormalSpring{boundary.surface_stiffness};
  problem.boundary[Side::bottom] =
      PrescribedVelocity{[drum, length = boundary.entrainment_length](Vec2 point) {
        return entraining_wall_velocity(drum, length, point, {-drum.half_chord(), 0}, {drum.half_chord(), 0});
      }};
  return problem;
}

}  // namespace

FlowProblem drum_problem(const DrumGeometry& drum, const StressLaw& law, const FlowMesh& mesh,
                         const FlowBoundary& boundary, const FlowRegularisation& regularisation) {
  FlowProblem problem = drum_without_law(drum, mesh, boundary, regularisation);
  problem.law = law;
  return problem;
}

FlowProblem drum_problem(const FlowScene& scene, const RheologyFit& law) {
  const DrumGeometry drum = drum_geometry(scene, law.nu);
  FlowProblem problem = drum_without_law(drum, scene.mesh, scene.boundary.value(), scene.regularisation);
  add_law_and_effects(scene, law, problem);
  add_effects_of_the_drum(scene, drum, problem);
  return problem;
}

}  // namespace drumlin::continuum
