#include "continuum/model/drum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/exchange/errors.hpp"

namespace drumlin {

double DrumGeometry::half_chord() const { return std::sqrt(radius * radius - axis_offset * axis_offset); }

double DrumGeometry::expected_Q() const {
  return 0.5 * nu * rotation * (radius * radius - axis_offset * axis_offset);
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

FlowProblem drum_problem(const DrumGeometry& drum, const StressLaw& law, const FlowMesh& mesh,
                         const FlowBoundary& boundary, const FlowRegularisation& regularisation) {
  FlowProblem problem;
  const double coarsest = mesh.surface_cell * std::pow(2.0, mesh.levels - 1);
  problem.domain = ChordDomain{.radius = drum.radius,
                               .axis_offset = drum.axis_offset,
                               .surface_cell = coarsest,
                               .surface_zone = mesh.surface_zone,
                               .growth = mesh.growth};
  problem.law = law;
  problem.regularisation = {regularisation.shear_rate, regularisation.pressure};
  problem.density = drum.nu;
  problem.slope = drum.slope ? Slope(FixedSlope{*drum.slope}) : Slope(SlopeFromMoment{});
  problem.boundary[Side::top] = NormalSpring{boundary.surface_stiffness};
  problem.boundary[Side::bottom] = PrescribedVelocity{[drum, length = boundary.corner_taper](Vec2 point) {
    const double from_corner = std::hypot(std::abs(point.x) - drum.half_chord(), point.z);
    const double s = std::min(1.0, from_corner / length);
    const Vec2 rigid = rigid_rotation(drum.rotation, drum.axis_offset, point);
    const double share = s * s * (3 - 2 * s);
    return Vec2{share * rigid.x, share * rigid.z};
  }};
  return problem;
}

FlowProblem drum_problem(const FlowScene& scene, const DrumGeometry& drum, const StressLaw& law) {
  FlowProblem problem = drum_problem(drum, law, scene.mesh, scene.boundary.value(), scene.regularisation);
  if (scene.effects.inertia) problem.inertia = Inertia{};
  if (scene.effects.rotating_frame) problem.frame = RotatingFrame{drum.rotation, drum.axis_offset};
  if (scene.effects.nonlocal) problem.nonlocal = NonlocalFluidity{scene.effects.nonlocal->length};
  if (const auto& slip = scene.effects.wall_slip)  // no taper: the wall slides along the corners
    problem.boundary[Side::bottom] = FrictionWall{
        .velocity = [drum](Vec2 point) { return rigid_rotation(drum.rotation, drum.axis_offset, point); },
        .friction = slip->friction,
        .slip_speed = slip->slip_speed};
  return problem;
}

}  // namespace drumlin
