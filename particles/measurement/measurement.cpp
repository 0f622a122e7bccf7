#include "particles/measurement/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/samples.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/grains/cell_sums.hpp"
#include "particles/measurement/layers/scalars.hpp"
#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/layers/variants.hpp"

namespace drumlin::particles {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Angle of the frame's x axis below the horizontal; below the laboratory's x axis without gravity.
double angle_of(const FlowFrame& frame, const Snapshot& snapshot) {
  const FlowFrame upright = frame_at_slope(0, 0, snapshot.gravity_x, snapshot.gravity_z, 0);
  const auto [along, up] = upright.turned(frame.x_axis_x, frame.x_axis_z);
  return std::atan2(-up, along);
}

/// Smaller parts of gravity are rounding of its direction.
constexpr double level = 1e-9;

/// The frame, and the scalars that the first reading gives. Returns its angle.
double find_frame(const Recording& recording, const Survey& found, const MeasurementOptions& options,
                  Measurement& result) {
  const Snapshot last = recording.read(recording.count() - 1);
  MeasurementFrame& place = result.place;
  place.frame = found.upright;
  place.container_radius = last.container_radius;
  place.period = place.container_radius > 0 ? 0 : last.period_x;
  place.closed = found.closed;
  if (place.closed) place.period = found.cell_length;
  place.rotation = last.wall_spin;
  place.snapshots = found.series.time.size();
  place.batches = std::min(options.batches, place.snapshots);
  place.half_chord = std::numeric_limits<double>::infinity();
  Scalar theta{"theta_deg", Measurement::none, Measurement::none};
  Scalar theta_com{"theta_com_deg", Measurement::none, Measurement::none};
  if (const double radius = place.container_radius; radius > 0) {
    const double mass_angle = statistics::mean(found.series.mass_angle);
    theta_com.value = mass_angle * degrees;
    theta_com.ci99 = mean_ci99(found.series.mass_angle, options.batches) * degrees;
    const SlopeEstimate estimate =
        slope_estimate(found, mass_angle, {options.slope_isoline, options.slope_half_width, radius});
    theta.value = estimate.slope.theta * degrees;
    theta.ci99 = estimate.ci99 * degrees;
    const bool has_line = std::isfinite(estimate.slope.theta);
    place.source = has_line ? FrameSource::isoline : FrameSource::centre_of_mass;
    result.slope_half_width = estimate.slope.half_width;
    place.frame = frame_at_slope(last.container_x, last.container_z, last.gravity_x, last.gravity_z,
                                 has_line ? estimate.slope.theta : mass_angle);
    place.half_chord = std::sqrt(std::max(0.0, radius * radius - std::pow(estimate.slope.surface_z, 2)));
    place.slice_width = std::min(options.slice_width, place.half_chord / 2);
    place.reach = {-radius, radius, -radius, radius};
  } else {
    place.source = place.period > 0 ? FrameSource::domain : FrameSource::gravity;
    place.slice_width = place.period > 0 ? place.period : std::min(options.slice_width, found.reach.width());
    place.reach = found.reach;
  }
  // In a periodic domain nothing varies along x.
  if (options.gradient_step && !(place.period > 0))
    place.gradient_step = std::min(*options.gradient_step, place.half_chord / 4);
  result.scalars.scalars = {theta, theta_com};
  place.in_mirror = recording.in_mirror;
  result.first_snapshot = recording.first;
  result.scales = last.scales;
  result.velocity_window = last.displacement_x.empty() ? 0 : last.velocity_window;
  if (place.period > 0) result.geometry = geometry_of_layers(last.gravity_x, last.gravity_z);
  if (found.cut_to_window) result.scattered.emplace();
  return angle_of(place.frame, last);
}

/// The slices in which profiles are taken.
struct Slices {
  Slice centre;
  std::optional<Slice> west, east;  ///< for derivatives along x
  std::vector<Slice> others;
  std::vector<double> positions;  ///< of the others
};

Slices asked_slices(const MeasurementFrame& place, const MeasurementOptions& options) {
  const auto at = [&](double position, double width) {
    return empty_slice(slice_grid(place, position, width, options.layer_thickness), place.batches);
  };
  Slices slices{at(options.position, place.slice_width), {}, {}, {}, {}};
  if (place.gradient_step > 0) {
    slices.west = at(options.position - place.gradient_step, place.slice_width);
    slices.east = at(options.position + place.gradient_step, place.slice_width);
  }
  if (!options.slices || place.period > 0) return slices;
  std::vector<double> positions = options.slices->positions;
  const double reach = std::min(place.half_chord, place.reach.width() / 2);
  if (positions.empty())
    for (double share : {-0.6, -0.3, 0.0, 0.3, 0.6}) positions.push_back(share * reach);
  for (double position : positions) {
    slices.others.push_back(at(position, options.slices->width));
    slices.positions.push_back(position);
  }
  return slices;
}

void add_snapshot(Slices& slices, const FlowSnapshot& snapshot, std::size_t batch) {
  const auto add = [&](Slice& slice) { add_snapshot(slice.grid, snapshot, slice.batches[batch]); };
  add(slices.centre);
  if (slices.west) add(*slices.west);
  if (slices.east) add(*slices.east);
  for (Slice& slice : slices.others) add(slice);
}

/// Profiles, their derivatives and the scalars read off them.
void measure_centre(const Slices& slices, const MeasurementOptions& options, double wall_height,
                    double frame_angle, Measurement& result) {
  LeaveOneOut<Profile> centre = slice_profiles(slices.centre, options.surface_nu);
  if (slices.west && slices.east)
    add_gradients(centre, *slices.west, *slices.east, result.place.gradient_step);
  result.surface_z = centre.whole.surface_z;
  result.layer_thickness = slices.centre.grid.thickness;
  result.axis_depth = -result.surface_z;
  result.wall_z = wall_height - result.surface_z;
  result.profiles = table_of(centre);
  for (const Profile& one : centre.without) result.leave_one_out.push_back(table_of(one));
  result.fits = profile_scalars(result.profiles, options.scalars);

  const auto scalars_of = [&](const Profile& profile) {
    const double wall_z = wall_height - profile.surface_z;
    const bool closed = result.place.closed;
    ScalarSet set = packing_scalars(profile, {wall_z, frame_angle, closed}, options);
    if (!(result.place.container_radius > 0))
      for (const Scalar& scalar : bulk_scalars(profile, wall_z, options.bulk_margin, closed).scalars)
        set.scalars.push_back(scalar);
    return set;
  };
  const auto scalars = each_of(scalars_of, centre);
  for (std::size_t s = 0; s < scalars.whole.scalars.size(); ++s) {
    result.scalars.scalars.push_back(scalars.whole.scalars[s]);
    result.scalars.scalars.back().ci99 =
        ci99_of(scalars, [&](const ScalarSet& one) { return one.scalars[s].value; });
  }
}

/// Height of the wall under a slice in the frame.
double wall_height(const MeasurementFrame& place, const Slice& slice, double position) {
  const double radius = place.container_radius;
  return radius > 0 ? -std::sqrt(std::max(0.0, radius * radius - position * position)) : slice.grid.z_min;
}

void measure_other_slices(const Slices& slices, const MeasurementFrame& place,
                          const MeasurementOptions& options, Measurement& result) {
  for (std::size_t s = 0; s < slices.others.size(); ++s) {
    const auto measured = slice_profiles(slices.others[s], options.surface_nu);
    const double position = slices.positions[s], surface_z = measured.whole.surface_z;
    result.slices.push_back({position, options.slices->width, table_of(measured), -surface_z,
                             wall_height(place, slices.others[s], position) - surface_z});
  }
}

/// Grains with their centres outside of what is measured.
std::size_t scattered_in(const FlowSnapshot& snapshot, const MeasurementFrame& place) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double x = place.period > 0 ? place.reach.x_min : snapshot.x[i];
    count += place.reach.holds(x, snapshot.z[i]) ? 0 : 1;
  }
  return count;
}

void add_scattered(std::size_t here, std::size_t snapshots, ScatteredGrains& scattered) {
  scattered.mean += static_cast<double>(here) / static_cast<double>(snapshots);
  scattered.most = std::max(scattered.most, here);
  scattered.last = here;
}

}  // namespace

std::optional<Geometry> geometry_of_layers(double gravity_x, double gravity_z) {
  const double size = std::hypot(gravity_x, gravity_z);
  if (size == 0) return Geometry::plane_shear;
  if (!(gravity_x > level * size) || gravity_z > level * size) return std::nullopt;
  return gravity_z < -level * size ? Geometry::incline : Geometry::chute;
}

Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        std::span<const MeasurementPart> parts,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  const Recording recording = steady_recording(source, options.since_s);
  std::size_t done = 0;
  const auto tick = [&] {
    if (progress) progress(++done, 2 * recording.count());
  };
  Survey found = survey(recording, std::min(options.batches, recording.count()),
                        std::make_shared<ScratchFile>(options.scratch_folder), tick);

  Measurement result;
  const double frame_angle = find_frame(recording, found, options, result);
  result.frame_angle_deg = frame_angle * degrees;
  const MeasurementFrame& place = result.place;

  Slices slices = asked_slices(place, options);
  std::vector<VariantSlice> variants;
  if (options.sensitivity) variants = variant_slices(found, place, frame_angle, options);
  for (const MeasurementPart& part : parts) part.begin(place);
  FlowSnapshot in_frame;
  for (std::size_t s = 0; s < recording.count(); ++s) {
    const Snapshot snapshot = recording.read(s);
    const std::size_t batch = batch_of(s, recording.count(), place.batches);
    to_flow_frame(snapshot, place.frame, VelocityKind::window, in_frame);
    if (result.scattered) add_scattered(scattered_in(in_frame, place), recording.count(), *result.scattered);
    add_snapshot(slices, in_frame, batch);
    if (options.voronoi) add_cells(slices.centre.grid, snapshot, in_frame, slices.centre.batches[batch]);
    for (const MeasurementPart& part : parts) part.add(snapshot, in_frame, batch);
    add_snapshot(variants, snapshot, in_frame);
    tick();
  }

  const double wall = wall_height(place, slices.centre, options.position);
  measure_centre(slices, options, wall, frame_angle, result);
  measure_other_slices(slices, place, options, result);
  if (options.sensitivity)
    result.variants = scalar_variants(variants, found, place, slices.centre, wall, frame_angle, options);
  const double radius = place.container_radius;
  if (!(radius > 0)) result.axis_depth = Measurement::none;
  result.steadiness = steadiness(found.series, place.rotation, options.batches);
  // What the drum lifts on one side flows down on the other: the flux through the middle of a straight
  // surface.
  const double nu = result.scalars.value("nu_bulk"), c = result.axis_depth;
  result.scalars.scalars.push_back(
      {"Q_expected", nu * place.rotation * (radius * radius - c * c) / 2, std::nullopt});
  result.series = std::move(found.series);
  return result;
}

}  // namespace drumlin::particles
