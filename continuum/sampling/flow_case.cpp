#include "continuum/sampling/flow_case.hpp"

#include <fmt/format.h>

#include <numbers>
#include <type_traits>

#include "continuum/sampling/drum_profiles.hpp"

namespace drumlin {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

std::string text_of(double value) { return fmt::format("{}", value); }

FlowCase drum_case(const FlowScene& scene, double nu, const StressLaw& law) {
  const DrumGeometry drum = drum_geometry(scene, nu);
  const SliceOptions slice{scene.output.slice_width.value(), scene.output.layer_thickness};
  FlowCase result;
  result.geometry = "drum";
  result.summary = fmt::format("drum, R = {:.2f} d, axis {:.2f} d above the surface, Omega = {:.5f}",
                               drum.radius, drum.axis_offset, drum.rotation);
  result.problem = drum_problem(scene, drum, law);
  result.given = {{{"nu", drum.nu, {}}, {"chord_offset", drum.axis_offset, {}}}};
  result.settings = {{{"drum_radius", drum.radius, {}},
                      {"rotation", drum.rotation, {}},
                      {"corner_taper", scene.boundary->corner_taper, {}},
                      {"surface_stiffness", scene.boundary->surface_stiffness, {}},
                      {"slice_width", slice_width(slice, drum), {}}}};
  result.profile_header = [drum, slice](const FlowField& field) {
    return std::vector<std::pair<std::string, std::string>>{
        {"theta_deg", text_of(field.theta() * degrees)},
        {"axis_depth", text_of(drum.axis_offset - middle_height(field))},
        {"drum_radius", text_of(drum.radius)},
        {"wall_z", text_of(drum.axis_offset - middle_height(field) - drum.radius)},
        {"rotation", text_of(drum.rotation)},
        {"slice_width", text_of(slice_width(slice, drum))}};
  };
  result.profiles = [drum, slice](const FlowField& field) { return drum_profiles(field, drum, slice); };
  result.scalars = [drum, slice](const FlowField& field) {
    return drum_scalars(field, drum, drum_profiles(field, drum, slice));
  };
  result.checks = [drum](const FlowField& field) { return drum_checks(field, drum); };
  result.map_area = [drum](const FlowField& field) { return drum_map_area(field, drum); };
  return result;
}

FlowCase gap_case(const FlowScene& scene, const Gap& gap, const StressLaw& law) {
  FlowCase result;
  result.geometry = gap.name;
  result.summary = fmt::format("{}, {:.2f} d from the top to the wall at rest", gap.name, gap.depth);
  result.problem = gap_problem(gap, law, scene.mesh, scene.regularisation);
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
    std::vector<std::pair<std::string, std::string>> header{{"wall_z", text_of(-gap.depth)}};
    if (gap.weight > 0) header.emplace_back("theta_deg", text_of(gap.slope * degrees));
    return header;
  };
  result.profiles = [gap, thickness = scene.output.layer_thickness](const FlowField& field) {
    return gap_profiles(field, gap, thickness);
  };
  result.scalars = [gap](const FlowField& field) { return gap_scalars(field, gap); };
  result.checks = [gap](const FlowField& field) { return gap_checks(field, gap); };
  result.closed_form = [gap, law, regularisation = result.problem.regularisation](const FlowField& field) {
    return gap_comparison(field, gap, law, regularisation);
  };
  const auto* strip = std::get_if<BoxDomain>(&result.problem.domain);
  result.map_area = [gap, width = strip ? strip->width : 0](const FlowField&) {
    return gap_map_area(gap, width);
  };
  return result;
}

}  // namespace

FlowCase flow_case(const FlowScene& scene, double nu, const StressLaw& law) {
  return std::visit(
      [&](const auto& geometry) {
        if constexpr (std::is_same_v<std::decay_t<decltype(geometry)>, FlowDrum>)
          return drum_case(scene, nu, law);
        else
          return gap_case(scene, gap_of(geometry, scales_of(scene), nu), law);
      },
      scene.geometry);
}

}  // namespace drumlin
