#include "particles/measurement/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "coupling/common/errors.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/grains/cell_profiles.hpp"
#include "particles/measurement/layers/bulk_scalars.hpp"
#include "particles/measurement/layers/packing_scalars.hpp"
#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/layers/variants.hpp"

namespace drumlin::particles {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Angle of the frame's x axis below the horizontal; below the laboratory's x axis without gravity.
double angle_of(const FlowFrame& frame, const Snapshot& snapshot) {
  const FlowFrame upright = frame_at_slope(0, 0, snapshot.gravity_x, snapshot.gravity_z, 0);
  return std::atan2(-upright.normal(frame.x_axis_x, frame.x_axis_z),
                    upright.along(frame.x_axis_x, frame.x_axis_z));
}

/// Smaller parts of gravity are rounding of its direction.
constexpr double level = 1e-9;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Leaves what a snapshot says of the whole. To assign {} to a vector would keep its memory.
void forget_grains(Snapshot& snapshot) {
  for (auto* values : {&snapshot.x, &snapshot.z, &snapshot.v_x, &snapshot.v_z, &snapshot.radius,
                       &snapshot.spin, &snapshot.displacement_x, &snapshot.displacement_z, &snapshot.mass})
    *values = std::vector<double>();
  snapshot.contacts = decltype(snapshot.contacts)();
  snapshot.id = decltype(snapshot.id)();
}

/// The frame, and the scalars that the first reading gives.
MeasurementFrame found_frame(const Survey& found, const Snapshot& last, const MeasurementOptions& options,
                             Measurement& result) {
  MeasurementFrame place;
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
    const double mass_angle = mean_of(found.series.mass_angle);
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
    place.z_min = place.x_min = -radius;
    place.z_max = place.x_max = radius;
  } else {
    place.source = place.period > 0 ? FrameSource::domain : FrameSource::gravity;
    place.slice_width =
        place.period > 0 ? place.period : std::min(options.slice_width, found.x_max - found.x_min);
    place.x_min = found.x_min;
    place.x_max = found.x_max;
    place.z_min = found.z_min;
    place.z_max = found.z_max;
  }
  // In a periodic domain nothing varies along x.
  if (options.gradient_step && !(place.period > 0))
    place.gradient_step = std::min(*options.gradient_step, place.half_chord / 4);
  result.scalars.scalars = {theta, theta_com};
  return place;
}

/// The slices in which profiles are taken.
struct Slices {
  Slice centre;
  std::optional<Slice> west, east;  ///< for derivatives along x
  std::vector<Slice> others;
  std::vector<double> positions;   ///< of the others
  std::optional<CellSlice> cells;  ///< of the middle one
};

Slices asked_slices(const MeasurementFrame& place, const MeasurementOptions& options) {
  const auto at = [&](double position, double width) {
    return empty_slice(slice_grid(place, position, width, options.layer_thickness), place.batches);
  };
  Slices slices{at(options.position, place.slice_width), {}, {}, {}, {}, {}};
  if (options.voronoi) slices.cells = empty_cell_slice(slices.centre);
  if (place.gradient_step > 0) {
    slices.west = at(options.position - place.gradient_step, place.slice_width);
    slices.east = at(options.position + place.gradient_step, place.slice_width);
  }
  if (!options.slices || place.period > 0) return slices;
  std::vector<double> positions = options.slices->positions;
  const double reach = std::min(place.half_chord, (place.x_max - place.x_min) / 2);
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
  SliceProfiles centre = slice_profiles(slices.centre, options.surface_nu);
  if (slices.west && slices.east)
    add_gradients(centre, slice_profiles(*slices.west, centre), slice_profiles(*slices.east, centre),
                  result.place.gradient_step);
  if (slices.cells) add_cell_columns(slices.centre, *slices.cells, centre);
  add_intervals(centre);
  result.surface_z = centre.surface_z;
  result.layer_thickness = slices.centre.grid.thickness;
  result.axis_depth = -centre.surface_z;
  result.wall_z = wall_height - centre.surface_z;
  result.fits = profile_scalars(centre.profiles, options.scalars);

  const auto scalars_of = [&](const ProfileSet& profiles, double wall_z) {
    ScalarSet scalars = packing_scalars(profiles, {wall_z, frame_angle, result.place.closed}, options);
    if (!(result.place.container_radius > 0))
      for (Scalar& scalar : bulk_scalars(profiles, wall_z, options.bulk_margin, result.place.closed).scalars)
        scalars.scalars.push_back(std::move(scalar));
    return scalars;
  };
  std::vector<ScalarSet> without;
  for (std::size_t b = 0; b < centre.leave_one_out.size(); ++b)
    without.push_back(scalars_of(centre.leave_one_out[b], wall_height - centre.leave_one_out_surface_z[b]));
  for (Scalar& scalar : scalars_of(centre.profiles, result.wall_z).scalars) {
    std::vector<double> values;
    for (const ScalarSet& one : without) values.push_back(one.value(scalar.name));
    scalar.ci99 = jackknife_ci99(values);
    result.scalars.scalars.push_back(scalar);
  }
  result.profiles = std::move(centre.profiles);
  result.leave_one_out = std::move(centre.leave_one_out);
}

/// Height of the wall under a slice in the frame.
double wall_height(const MeasurementFrame& place, const Slice& slice, double position) {
  const double radius = place.container_radius;
  return radius > 0 ? -std::sqrt(std::max(0.0, radius * radius - position * position)) : slice.grid.z_min;
}

void measure_other_slices(const Slices& slices, const MeasurementFrame& place,
                          const MeasurementOptions& options, Measurement& result) {
  for (std::size_t s = 0; s < slices.others.size(); ++s) {
    SliceProfiles measured = slice_profiles(slices.others[s], options.surface_nu);
    add_intervals(measured);
    const double position = slices.positions[s];
    result.slices.push_back({position, options.slices->width, std::move(measured.profiles),
                             -measured.surface_z,
                             wall_height(place, slices.others[s], position) - measured.surface_z});
  }
}

/// Grains with their centres outside of what is measured.
std::size_t scattered_in(const FlowSnapshot& snapshot, const MeasurementFrame& place) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const bool beside =
        !(place.period > 0) && !(snapshot.x[i] >= place.x_min && snapshot.x[i] <= place.x_max);
    count += beside || !(snapshot.z[i] >= place.z_min && snapshot.z[i] <= place.z_max) ? 1 : 0;
  }
  return count;
}

void add_scattered(std::size_t here, std::size_t snapshots, ScatteredGrains& scattered) {
  scattered.mean += static_cast<double>(here) / static_cast<double>(snapshots);
  scattered.most = std::max(scattered.most, here);
  scattered.last = here;
}

}  // namespace

std::string geometry_of_layers(double gravity_x, double gravity_z) {
  const double size = std::hypot(gravity_x, gravity_z);
  if (size == 0) return "plane_shear";
  if (!(gravity_x > level * size) || gravity_z > level * size) return "";
  return gravity_z < -level * size ? "incline" : "chute";
}

Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        std::span<const MeasurementPart> parts,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  const Recording recording = steady_recording(source);
  Snapshot last = recording.read(recording.count() - 1);
  const double velocity_window = last.displacement_x.empty() ? 0 : last.velocity_window;
  forget_grains(last);
  std::size_t done = 0;
  const auto tick = [&] {
    if (progress) progress(++done, 2 * recording.count());
  };
  Survey found = survey(recording, std::min(options.batches, recording.count()),
                        std::make_shared<ScratchFile>(options.scratch_folder), tick);

  Measurement result;
  result.first_snapshot = recording.first;
  result.in_mirror = recording.in_mirror;
  result.scales = last.scales;
  result.velocity_window = velocity_window;
  MeasurementFrame place = found_frame(found, last, options, result);
  place.in_mirror = recording.in_mirror;
  const double frame_angle = angle_of(place.frame, last);
  result.place = place;
  result.frame_angle_deg = frame_angle * degrees;
  if (place.period > 0) result.geometry = geometry_of_layers(last.gravity_x, last.gravity_z);
  if (found.cut_to_window) result.scattered.emplace();

  Slices slices = asked_slices(place, options);
  std::optional<VariantSlices> variants;
  if (options.sensitivity) variants = variant_slices(found, place, frame_angle, options);
  for (const MeasurementPart& part : parts) part.begin(place);
  FlowSnapshot in_frame;
  for (std::size_t s = 0; s < recording.count(); ++s) {
    const Snapshot snapshot = recording.read(s);
    const std::size_t batch = batch_of(s, recording.count(), place.batches);
    to_flow_frame(snapshot, place.frame, VelocityKind::window, in_frame);
    if (result.scattered) add_scattered(scattered_in(in_frame, place), recording.count(), *result.scattered);
    add_snapshot(slices, in_frame, batch);
    if (slices.cells) add_snapshot(slices.centre, snapshot, in_frame, batch, *slices.cells);
    for (const MeasurementPart& part : parts) part.add(snapshot, in_frame, batch);
    if (variants) add_snapshot(*variants, snapshot, in_frame);
    tick();
  }

  const double wall = wall_height(place, slices.centre, options.position);
  measure_centre(slices, options, wall, frame_angle, result);
  measure_other_slices(slices, place, options, result);
  if (variants)
    result.variants = scalar_variants(*variants, found, place, slices.centre, wall, frame_angle, options);
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
