#include "continuum/postprocessing/flow_case.hpp"

#include <fmt/format.h>

#include <numbers>
#include <variant>

#include "continuum/postprocessing/drum_profiles.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

FlowCase drum_case(const FlowScene& scene, const RheologyFit& law) {
  const DrumGeometry drum = drum_geometry(scene, law.nu);
  const SliceOptions slice{scene.output.slice_width.value(), scene.output.layer_thickness};
  FlowCase result;
  result.summary = fmt::format("drum, R = {:.2f} d, axis {:.2f} d above the surface, Omega = {:.5f}",
                               drum.radius, drum.axis_offset, drum.rotation);
  result.problem = drum_problem(scene, law);
  result.given = {{{"nu", drum.nu, {}}, {"chord_offset", drum.axis_offset, {}}}};
  result.settings = {{{"drum_radius", drum.radius, {}},
                      {"rotation", drum.rotation, {}},
                      {"entrainment_length", scene.boundary->entrainment_length, {}},
                      {"surface_stiffness", scene.boundary->surface_stiffness, {}},
                      {"slice_width", slice_width(slice, drum), {}}}};
  result.profile_header = [drum, slice](const FlowField& field) {
    RunHeader header;
    header.theta_deg = field.theta() * degrees;
    header.axis_depth = drum.axis_offset - middle_height(field);
    header.drum_radius = drum.radius;
    header.wall_z = drum.axis_offset - middle_height(field) - drum.radius;
    header.rotation = drum.rotation;
    header.slice_width = slice_width(slice, drum);
    return header;
  };
  result.profiles = [drum, slice](const FlowField& field) { return drum_profiles(field, drum, slice); };
  result.scalars = [drum, slice](const FlowField& field) {
    return drum_scalars(field, drum, drum_profiles(field, drum, slice));
  };
  result.checks = [drum](const FlowField& field) { return drum_checks(field, drum); };
  result.map_area = [drum](const FlowField& field) { return drum_map_area(field, drum); };
  return result;
}

// The closed form is that of the local law, and in a ring of a pressure that k and inertia would change along
// the radius.
bool has_closed_form(const FlowProblem& problem) {
  const bool ring = std::holds_alternative<AnnulusDomain>(problem.domain);
  return !problem.nonlocal && !problem.threshold_fluidity && !(ring && (problem.turned || problem.inertia));
}

FlowCase gap_case(const FlowScene& scene, const RheologyFit& law) {
  const Gap gap = gap_of(scene, law.nu);
  FlowCase result;
  result.geometry = gap.geometry;
  result.summary =
      fmt::format("{}, {:.2f} d from the top to the wall at rest", name_of(gap.geometry), gap.depth);
  result.problem = gap_problem(scene, law);
  result.given = {{{"nu", gap.nu, {}}}};
  result.settings = {{{"gap", gap.depth, {}}}};
  const auto set = [&](const char* name, double value, const std::string& said) {
    result.settings.scalars.push_back({name, value, {}});
    result.summary += said;
  };
  if (gap.inner_radius > 0)
    set("inner_radius", gap.inner_radius, fmt::format(", inner radius {:.2f} d", gap.inner_radius));
  if (gap.weight > 0)
    set("slope_deg", gap.slope * degrees, fmt::format(", slope {:g} deg", gap.slope * degrees));
  if (gap.pressure > 0) set("pressure", gap.pressure, fmt::format(", pressure {:.4g}", gap.pressure));
  if (gap.speed) set("wall_speed", *gap.speed, fmt::format(", wall speed {:.4g}", *gap.speed));
  result.profile_header = [gap](const FlowField&) {
    RunHeader header;
    header.wall_z = -gap.depth;
    if (gap.weight > 0) header.theta_deg = gap.slope * degrees;
    return header;
  };
  result.profiles = [gap, thickness = scene.output.layer_thickness](const FlowField& field) {
    return gap_profiles(field, gap, thickness);
  };
  result.scalars = [gap](const FlowField& field) { return gap_scalars(field, gap); };
  result.checks = [gap](const FlowField& field) { return gap_checks(field, gap); };
  if (has_closed_form(result.problem))
    result.closed_form = [gap, mu = result.problem.law,
                          regularisation = result.problem.regularisation](const FlowField& field) {
      return gap_comparison(field, gap, mu, regularisation);
    };
  const auto* strip = std::get_if<BoxDomain>(&result.problem.domain);
  result.map_area = [gap, width = strip ? strip->width : 0](const FlowField&) {
    return gap_map_area(gap, width);
  };
  return result;
}

}  // namespace

FlowCase flow_case(const FlowScene& scene, const RheologyFit& law) {
  if (std::holds_alternative<FlowRegion>(scene.geometry))
    throw InputError({InputProblem{.file = "",
                                   .key = "region",
                                   .what = "is not solved yet",
                                   .allowed = "drum, incline, plane_shear, chute, annulus"}});
  FlowCase made =
      std::holds_alternative<FlowDrum>(scene.geometry) ? drum_case(scene, law) : gap_case(scene, law);
  made.law_I_max = made.problem.memory ? made.problem.memory->law.mu.I.back() : largest_measured_I(law.mu);
  return made;
}

}  // namespace drumlin::continuum
