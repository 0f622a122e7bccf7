#include "particles/measurement/layers/variants.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "coupling/common/errors.hpp"
#include "particles/measurement/layers/packing_scalars.hpp"

namespace drumlin::particles {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

ScalarVariant variant_of(const std::string& change, const Slice& slice, double wall_height,
                         double frame_angle, const MeasurementOptions& options) {
  const SliceProfiles measured = slice_profiles(Slice{slice.grid, {total_of(slice)}}, options.surface_nu);
  return {change,
          packing_scalars(measured.profiles,
                          {wall_height - measured.surface_z, frame_angle, slice.grid.closed}, options),
          measured.profiles};
}

/// The derivatives along x by other steps; nothing else changes.
void add_gradient_variants(const VariantSlices& variants, const Slice& centre, double wall_height,
                           double frame_angle, const MeasurementOptions& options,
                           std::vector<ScalarVariant>& result) {
  const SliceProfiles plain = slice_profiles(Slice{centre.grid, {total_of(centre)}}, options.surface_nu);
  for (const VariantSlices::Pair& pair : variants.gradients) {
    SliceProfiles measured = plain;
    add_gradients(measured, slice_profiles(pair.west, plain), slice_profiles(pair.east, plain), pair.step);
    ScalarSet scalars =
        packing_scalars(measured.profiles, {wall_height - measured.surface_z, frame_angle, false}, options);
    std::erase_if(scalars.scalars, [](const Scalar& s) { return s.name.find("_dx") == std::string::npos; });
    result.push_back({fmt::format("derivatives from slices {} d to either side", pair.step), scalars, {}});
  }
}

/// Windows that are laid over the layers of the one slice.
struct WindowChange {
  std::string change;
  MeasurementOptions options;
};

std::vector<WindowChange> window_changes(const MeasurementOptions& standard) {
  std::vector<WindowChange> changes;
  const auto add = [&](const std::string& change, auto alter) {
    changes.push_back({change, standard});
    alter(changes.back().options);
  };
  for (double nu : {0.5, 0.6, 0.75})
    add(fmt::format("surface where nu = {}", nu), [&](MeasurementOptions& o) { o.surface_nu = nu; });
  for (double share : {0.2, 0.4, 0.5})
    add(fmt::format("straight line where v_x > {} v_x(0)", share),
        [&](MeasurementOptions& o) { o.scalars.linear_share = share; });
  for (double depth : {0.5, 2.0})
    add(fmt::format("v_x(0) read {} d below the surface", depth),
        [&](MeasurementOptions& o) { o.scalars.surface_speed_depth = depth; });
  for (const auto& [from, to] : {std::pair(6.0, 2.0), std::pair(8.0, 0.0), std::pair(12.0, 4.0)})
    add(fmt::format("lambda from -H-{} to -H-{}", from, to), [from = from, to = to](MeasurementOptions& o) {
      o.scalars.decay_from = from;
      o.scalars.decay_to = to;
    });
  add("lambda from v_x", [](MeasurementOptions& o) { o.scalars.decay_of = "v_x"; });
  for (double margin : {2.0, 8.0})
    add(fmt::format("bulk {} d from surface and wall", margin),
        [&](MeasurementOptions& o) { o.bulk_margin = margin; });
  for (double margin : {1.0, 6.0})
    add(fmt::format("static phase from {} d above the wall", margin),
        [&](MeasurementOptions& o) { o.wall_margin = margin; });
  for (double I : {1e-5, 1e-3})
    add(fmt::format("power laws of the fluctuations from I = {}", I),
        [&](MeasurementOptions& o) { o.fluctuation_I_min = I; });
  return changes;
}

/// theta by other lines and ranges than that of the frame.
void add_slope_variants(const Survey& found, double first_guess, double radius,
                        const MeasurementOptions& options, std::vector<ScalarVariant>& result) {
  const auto add = [&](const std::string& change, const SlopeOptions& slope) {
    const Slope line = slope_estimate(found, first_guess, slope).slope;
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
  if (place.closed) return closed_grid(place.frame, thickness, place.z_min, place.z_max, place.period);
  return layer_grid(place.frame, position, width, thickness, place.z_min, place.z_max, radius, place.period);
}

VariantSlices variant_slices(const Survey& found, const MeasurementFrame& place, double frame_angle,
                             const MeasurementOptions& options) {
  VariantSlices variants;
  const auto add = [&](const std::string& change, double width, double thickness) {
    variants.in_the_frame.push_back(
        {change, empty_slice(slice_grid(place, options.position, width, thickness), 1), frame_angle});
  };
  if (!(place.period > 0))
    for (double factor : {0.5, 1.5})
      if (factor * place.slice_width < place.half_chord)
        add(fmt::format("slice {:.3g} d wide", factor * place.slice_width), factor * place.slice_width,
            options.layer_thickness);
  for (double factor : {0.5, 2.0})
    add(fmt::format("layers {:.3g} d thick", factor * options.layer_thickness), place.slice_width,
        factor * options.layer_thickness);
  const auto standard = [&](const MeasurementFrame& at) {
    return empty_slice(slice_grid(at, options.position, place.slice_width, options.layer_thickness), 1);
  };
  for (double factor : {0.5, 2.0}) {
    const double step = factor * place.gradient_step;
    if (!(step > 0) || step + place.slice_width / 2 >= place.half_chord) continue;
    const auto beside = [&](double offset) {
      return empty_slice(
          slice_grid(place, options.position + offset, place.slice_width, options.layer_thickness), 1);
    };
    variants.gradients.push_back({step, beside(-step), beside(step)});
  }
  variants.instantaneous = VariantSlices::One{"instantaneous velocity", standard(place), frame_angle};
  if (place.source == FrameSource::isoline) {
    const double mass_angle = mean_of(found.series.mass_angle);
    MeasurementFrame turned = place;
    // `upright` is the frame of angle 0: turned clockwise by the angle of the centre of mass.
    const FlowFrame& up = found.upright;
    const double c = std::cos(mass_angle), s = std::sin(mass_angle);
    turned.frame.x_axis_x = c * up.x_axis_x + s * up.x_axis_z;
    turned.frame.x_axis_z = c * up.x_axis_z - s * up.x_axis_x;
    variants.mass_angle_frame =
        VariantSlices::One{"frame at the angle of the centre of mass", standard(turned), mass_angle};
  }
  return variants;
}

void add_snapshot(VariantSlices& variants, const Snapshot& snapshot, FlowSnapshot& in_frame) {
  const auto add = [](VariantSlices::One& one, const FlowSnapshot& seen) {
    add_snapshot(one.slice.grid, seen, one.slice.batches.front());
  };
  for (VariantSlices::One& one : variants.in_the_frame) add(one, in_frame);
  for (VariantSlices::Pair& pair : variants.gradients)
    for (Slice* slice : {&pair.west, &pair.east}) add_snapshot(slice->grid, in_frame, slice->batches.front());
  const auto add_own = [&](std::optional<VariantSlices::One>& one, VelocityKind kind) {
    if (!one) return;
    to_flow_frame(snapshot, one->slice.grid.frame, kind, in_frame);
    add(*one, in_frame);
  };
  add_own(variants.instantaneous, VelocityKind::instantaneous);
  add_own(variants.mass_angle_frame, VelocityKind::window);
}

std::vector<ScalarVariant> scalar_variants(const VariantSlices& variants, const Survey& found,
                                           const MeasurementFrame& place, const Slice& centre,
                                           double wall_height, double frame_angle,
                                           const MeasurementOptions& options) {
  std::vector<ScalarVariant> result;
  for (const WindowChange& window : window_changes(options))
    result.push_back(variant_of(window.change, centre, wall_height, frame_angle, window.options));
  const auto add = [&](const VariantSlices::One& one) {
    result.push_back(variant_of(one.change, one.slice, wall_height, one.frame_angle, options));
  };
  for (const VariantSlices::One& one : variants.in_the_frame) add(one);
  if (variants.instantaneous) add(*variants.instantaneous);
  if (variants.mass_angle_frame) add(*variants.mass_angle_frame);
  add_gradient_variants(variants, centre, wall_height, frame_angle, options, result);
  if (place.source == FrameSource::isoline)
    add_slope_variants(found, mean_of(found.series.mass_angle), place.container_radius, options, result);
  return result;
}

}  // namespace drumlin::particles
