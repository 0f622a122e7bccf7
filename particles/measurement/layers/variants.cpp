#include "particles/measurement/layers/variants.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/samples.hpp"
#include "particles/measurement/layers/scalars.hpp"

namespace drumlin::particles {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Of a profile, but for those that the change cannot reach.
ScalarVariant variant_of(const std::string& change, const Profile& profile, double wall_height,
                         double frame_angle, const MeasurementOptions& options, bool closed) {
  return {change, packing_scalars(profile, {wall_height - profile.surface_z, frame_angle, closed}, options),
          table_of(profile)};
}

/// Windows that are laid over the layers of the one slice.
struct WindowChange {
  std::string change;
  MeasurementOptions options;
};

std::vector<WindowChange> window_changes(const MeasurementOptions& standard) {
  std::vector<WindowChange> changes;
  const auto add = [&](const std::string& change) -> MeasurementOptions& {
    return changes.emplace_back(WindowChange{change, standard}).options;
  };
  for (double nu : {0.5, 0.6, 0.75}) add(fmt::format("surface where nu = {}", nu)).surface_nu = nu;
  for (double share : {0.2, 0.4, 0.5})
    add(fmt::format("straight line where v_x > {} v_x(0)", share)).scalars.linear_share = share;
  for (double depth : {0.5, 2.0})
    add(fmt::format("v_x(0) read {} d below the surface", depth)).scalars.surface_speed_depth = depth;
  for (const auto& [from, to] : {std::pair(6.0, 2.0), std::pair(8.0, 0.0), std::pair(12.0, 4.0)}) {
    ProfileScalarOptions& scalars = add(fmt::format("lambda from -H-{} to -H-{}", from, to)).scalars;
    scalars.decay_from = from;
    scalars.decay_to = to;
  }
  add("lambda from v_x").scalars.decay_of = "v_x";
  for (double margin : {2.0, 8.0})
    add(fmt::format("bulk {} d from surface and wall", margin)).bulk_margin = margin;
  for (double margin : {1.0, 6.0})
    add(fmt::format("static phase from {} d above the wall", margin)).wall_margin = margin;
  for (double I : {1e-5, 1e-3})
    add(fmt::format("power laws of the fluctuations from I = {}", I)).fluctuation_I_min = I;
  return changes;
}

/// theta by other lines and ranges than that of the frame.
void add_slope_variants(const Survey& found, double first_guess, double radius,
                        const MeasurementOptions& options, std::vector<ScalarVariant>& result) {
  const CoverageMap coverage = found.coverage->whole();
  const auto add = [&](const std::string& change, const SlopeOptions& slope) {
    const Slope line = isoline_slope(coverage, first_guess, slope);
    result.push_back({change, {{{"theta_deg", line.theta * degrees, {}}}}, {}});
  };
  for (double nu : {0.3, 0.5, 0.6})
    add(fmt::format("slope of the line nu = {}", nu), {nu, options.slope_half_width, radius});
  for (double width : {10.0, 30.0})
    add(fmt::format("slope over |x| < {} d", width), {options.slope_isoline, width, radius});
}

}  // namespace

LayerGrid slice_grid(const MeasurementFrame& place, double position, double width, double thickness) {
  const double radius = place.container_radius;
  if (radius > 0 && std::abs(position) + width / 2 >= radius)
    throw InputError(fmt::format(
        "the slice at {} d leaves the drum of radius {} d: none {} d wide may lie further out than "
        "{} d",
        position, radius, width, radius - width / 2));
  if (place.closed)
    return closed_grid(place.frame, thickness, place.reach.z_min, place.reach.z_max, place.period);
  return layer_grid(place.frame, position, width, thickness, place.reach.z_min, place.reach.z_max, radius,
                    place.period);
}

std::vector<VariantSlice> variant_slices(const Survey& found, const MeasurementFrame& place,
                                         double frame_angle, const MeasurementOptions& options) {
  std::vector<VariantSlice> variants;
  const auto slice = [&](const MeasurementFrame& at, double offset, double width, double thickness) {
    return empty_slice(slice_grid(at, options.position + offset, width, thickness), 1);
  };
  const double width = place.slice_width, thickness = options.layer_thickness;
  const auto add = [&](const std::string& change, double its_width, double its_thickness) {
    variants.push_back({change, {slice(place, 0, its_width, its_thickness)}, frame_angle});
  };
  for (double factor : {0.5, 1.5})
    if (!(place.period > 0) && factor * width < place.half_chord)
      add(fmt::format("slice {:.3g} d wide", factor * width), factor * width, thickness);
  for (double factor : {0.5, 2.0})
    add(fmt::format("layers {:.3g} d thick", factor * thickness), width, factor * thickness);
  add("instantaneous velocity", width, thickness);
  variants.back().own_view = VelocityKind::instantaneous;
  if (place.source == FrameSource::isoline) {
    const double mass_angle = statistics::mean(found.series.mass_angle);
    MeasurementFrame turned = place;
    turned.frame = found.upright.at_slope(mass_angle);
    variants.push_back({"frame at the angle of the centre of mass",
                        {slice(turned, 0, width, thickness)},
                        mass_angle,
                        VelocityKind::window});
  }
  for (double factor : {0.5, 2.0}) {
    const double step = factor * place.gradient_step;
    if (!(step > 0) || step + width / 2 >= place.half_chord) continue;
    variants.push_back({fmt::format("derivatives from slices {} d to either side", step),
                        {slice(place, -step, width, thickness), slice(place, step, width, thickness)},
                        frame_angle});
    variants.back().step = step;
  }
  return variants;
}

void add_snapshot(std::vector<VariantSlice>& variants, const Snapshot& snapshot, FlowSnapshot& in_frame) {
  for (const bool own : {false, true})
    for (VariantSlice& variant : variants) {
      if (variant.own_view.has_value() != own) continue;
      if (own) to_flow_frame(snapshot, variant.slices.front().grid.frame, *variant.own_view, in_frame);
      for (Slice& slice : variant.slices) add_snapshot(slice.grid, in_frame, slice.batches.front());
    }
}

std::vector<ScalarVariant> scalar_variants(const std::vector<VariantSlice>& variants, const Survey& found,
                                           const MeasurementFrame& place, const Slice& centre,
                                           double wall_height, double frame_angle,
                                           const MeasurementOptions& options) {
  std::vector<ScalarVariant> result;
  const Slice all{centre.grid, {leave_one_out(centre.batches).whole}};
  for (const WindowChange& window : window_changes(options))
    result.push_back(variant_of(window.change, slice_profiles(all, window.options.surface_nu).whole,
                                wall_height, frame_angle, window.options, place.closed));
  for (const VariantSlice& one : variants) {
    auto measured = slice_profiles(one.step > 0 ? all : one.slices.front(), options.surface_nu);
    if (one.step > 0) add_gradients(measured, one.slices[0], one.slices[1], one.step);
    ScalarVariant& variant = result.emplace_back(
        variant_of(one.change, measured.whole, wall_height, one.frame_angle, options, place.closed));
    if (!(one.step > 0)) continue;  // else nothing but the derivatives changes
    variant.profiles = {};
    std::erase_if(variant.scalars.scalars,
                  [](const Scalar& s) { return s.name.find("_dx") == std::string::npos; });
  }
  if (place.source == FrameSource::isoline)
    add_slope_variants(found, statistics::mean(found.series.mass_angle), place.container_radius, options,
                       result);
  return result;
}

}  // namespace drumlin::particles
