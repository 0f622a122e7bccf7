#include "particles/measurement/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "coupling/exchange/errors.hpp"
#include "particles/measurement/intervals.hpp"
#include "particles/measurement/layer_profiles.hpp"
#include "particles/measurement/layer_sums.hpp"
#include "particles/measurement/packing_scalars.hpp"

namespace drumlin {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// The snapshots to measure, turned so that the drum goes clockwise.
struct Recording {
  const SnapshotSource& source;
  std::size_t first = 0;
  bool in_mirror = false;
  std::size_t count() const { return source.count - first; }
  Snapshot read(std::size_t index) const {
    Snapshot snapshot = source.read(first + index);
    if (snapshot.x.empty())
      throw InputError("snapshot " + std::to_string(first + index) + " holds no grains");
    return in_mirror ? mirrored(std::move(snapshot)) : snapshot;
  }
};

/// The last snapshots with one and the same motion of the wall: pictures of the settling are not steady flow.
Recording steady_recording(const SnapshotSource& source) {
  const double spin = source.read(source.count - 1).wall_spin;
  std::size_t other = 0, same = source.count - 1;  // the border between two motions lies between them
  if (source.read(0).wall_spin == spin) {
    same = 0;
  } else {
    while (same - other > 1) {
      const std::size_t middle = (other + same) / 2;
      (source.read(middle).wall_spin == spin ? same : other) = middle;
    }
  }
  return Recording{source, same, spin < 0};
}

/// What the first reading finds out.
struct Survey {
  FlowFrame upright;
  std::vector<CoverageMap> maps;                      ///< one per batch; empty without a container
  std::vector<double> mass_angle;                     ///< rad, per snapshot; empty without a container
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;  ///< what the grains reach in `upright`
};

Survey survey(const Recording& recording, std::size_t batches, const std::function<void()>& tick) {
  Survey found;
  for (std::size_t s = 0; s < recording.count(); ++s) {
    const Snapshot snapshot = recording.read(s);
    const double radius = snapshot.container_radius;
    if (s == 0) {
      double mean_x = 0;
      for (double x : snapshot.x) mean_x += x / static_cast<double>(snapshot.x.size());
      if (radius > 0) {
        found.upright = frame_at_slope(snapshot.container_x, snapshot.container_z, snapshot.gravity_x,
                                       snapshot.gravity_z, 0);
        found.maps.assign(batches, CoverageMap(-radius, radius, -radius, radius));
      } else if (snapshot.period_x > 0) {
        found.upright =
            FlowFrame{mean_x, 0, 1, 0};  // layers must run along the period, whatever gravity does
      } else {
        found.upright = frame_at_slope(mean_x, 0, snapshot.gravity_x, snapshot.gravity_z, 0);
      }
    }
    for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
      const double x = found.upright.x_of(snapshot.x[i], snapshot.z[i]);
      const double z = found.upright.z_of(snapshot.x[i], snapshot.z[i]), r = snapshot.radius[i];
      found.x_min = std::min(found.x_min, x - r);
      found.x_max = std::max(found.x_max, x + r);
      found.z_min = s + i == 0 ? z - r : std::min(found.z_min, z - r);
      found.z_max = s + i == 0 ? z + r : std::max(found.z_max, z + r);
    }
    if (radius > 0) {
      found.maps[batch_of(s, recording.count(), batches)].add(snapshot, found.upright);
      found.mass_angle.push_back(centre_of_mass_angle(snapshot, found.upright));
    }
    tick();
  }
  return found;
}

/// Slope of the surface, the same with one batch left out each.
struct SlopeEstimate {
  Slope slope;
  double ci99 = std::numeric_limits<double>::quiet_NaN();
};

SlopeEstimate slope_estimate(const Survey& found, double first_guess, const SlopeOptions& options,
                             std::size_t batches) {
  CoverageMap total = found.maps.front();
  for (std::size_t b = 1; b < found.maps.size(); ++b) total += found.maps[b];
  SlopeEstimate estimate;
  estimate.slope = isoline_slope(total, first_guess, options);
  std::vector<double> leave_one_out;
  for (std::size_t b = 0; b < batches && batches > 1; ++b) {
    CoverageMap rest = total;
    rest -= found.maps[b];
    leave_one_out.push_back(isoline_slope(rest, first_guess, options).theta);
  }
  estimate.ci99 = jackknife_ci99(leave_one_out);
  return estimate;
}

/// Angle of the frame's x axis below the horizontal; below the laboratory's x axis without gravity.
double frame_angle(const FlowFrame& frame, const Snapshot& snapshot) {
  const FlowFrame upright = frame_at_slope(0, 0, snapshot.gravity_x, snapshot.gravity_z, 0);
  return std::atan2(-upright.normal(frame.x_axis_x, frame.x_axis_z),
                    upright.along(frame.x_axis_x, frame.x_axis_z));
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// The profiles with the batches' spread as their intervals, layer by layer.
void add_intervals(Measurement& result) {
  for (std::size_t c = 0; c < result.profiles.columns.size(); ++c) {
    ProfileColumn& column = result.profiles.columns[c];
    if (column.name == "count") continue;
    for (std::size_t l = 0; l < result.profiles.z.size(); ++l) {
      std::vector<double> values;
      for (const ProfileSet& one : result.leave_one_out)
        values.push_back(l < one.z.size() ? one.columns[c].value[l]
                                          : std::numeric_limits<double>::quiet_NaN());
      column.ci99.push_back(jackknife_ci99(values));
    }
  }
}

/// Second reading: the layers, their profiles and the scalars read off these.
void measure_layers(const Recording& recording, const LayerGrid& grid, const MeasurementOptions& options,
                    double wall_height, Measurement& result, const std::function<void()>& tick) {
  const LayerSums empty{std::vector<LayerSum>(grid.layers()), 0, true};
  std::vector<LayerSums> batch(result.batches, empty);
  for (std::size_t s = 0; s < recording.count(); ++s) {
    add_snapshot(grid, recording.read(s), batch[batch_of(s, recording.count(), result.batches)]);
    tick();
  }
  LayerSums total = empty;
  for (const LayerSums& one : batch) {
    total += one;
    total.with_spin = total.with_spin && one.with_spin;
  }

  const auto profiles_of = [&](const LayerSums& sums, double& surface) {
    surface = surface_height(grid, sums, options.surface_nu);
    // A pile too loose for a surface keeps the height of the frame.
    return layer_profiles(grid, sums, std::isfinite(surface) ? surface : 0);
  };
  double surface = 0;
  result.profiles = profiles_of(total, surface);
  if (!std::isfinite(surface)) surface = 0;
  result.axis_depth = -surface;
  result.wall_z = wall_height - surface;
  result.fits = profile_scalars(result.profiles, options.scalars);

  std::vector<ScalarSet> without;
  if (result.batches > 1) {
    for (const LayerSums& one : batch) {
      LayerSums rest = total;
      rest -= one;
      double own_surface = 0;
      result.leave_one_out.push_back(profiles_of(rest, own_surface));
      without.push_back(packing_scalars(result.leave_one_out.back(), wall_height - own_surface, options));
    }
  }
  add_intervals(result);
  for (Scalar& scalar : packing_scalars(result.profiles, result.wall_z, options).scalars) {
    std::vector<double> values;
    for (const ScalarSet& one : without) values.push_back(one.value(scalar.name));
    scalar.ci99 = jackknife_ci99(values);
    result.scalars.scalars.push_back(scalar);
  }
}

}  // namespace

Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        const std::function<void(std::size_t, std::size_t)>& progress) {
  if (source.count == 0) throw InputError("the run holds no snapshots: there is nothing to measure");
  const Recording recording = steady_recording(source);
  const Snapshot last = recording.read(recording.count() - 1);
  Measurement result;
  result.batches = std::min(options.batches, recording.count());
  result.first_snapshot = recording.first;
  result.snapshots = recording.count();
  result.in_mirror = recording.in_mirror;
  result.first_time = recording.read(0).time;
  result.last_time = last.time;
  result.scales = last.scales;
  result.rotation = last.wall_spin;
  result.velocity_window = last.displacement_x.empty() ? 0 : last.velocity_window;

  std::size_t done = 0;
  const auto tick = [&] {
    if (progress) progress(++done, 2 * recording.count());
  };
  const Survey found = survey(recording, result.batches, tick);
  FlowFrame frame = found.upright;
  Scalar theta{"theta_deg", ProfileScalars::none, ProfileScalars::none};
  Scalar theta_com{"theta_com_deg", ProfileScalars::none, ProfileScalars::none};
  const double radius = last.container_radius;
  result.container_radius = radius;
  if (radius > 0) {
    const double mass_angle = mean_of(found.mass_angle);
    theta_com.value = mass_angle * degrees;
    theta_com.ci99 = mean_ci99(found.mass_angle, options.batches) * degrees;
    const SlopeOptions slope_options{options.slope_isoline, options.slope_half_width, radius};
    const SlopeEstimate estimate = slope_estimate(found, mass_angle, slope_options, result.batches);
    theta.value = estimate.slope.theta * degrees;
    theta.ci99 = estimate.ci99 * degrees;
    const bool has_line = std::isfinite(estimate.slope.theta);
    result.frame_source = has_line ? FrameSource::isoline : FrameSource::centre_of_mass;
    result.slope_half_width = estimate.slope.half_width;
    frame = frame_at_slope(last.container_x, last.container_z, last.gravity_x, last.gravity_z,
                           has_line ? estimate.slope.theta : mass_angle);
    const double half_chord =
        std::sqrt(std::max(0.0, radius * radius - std::pow(estimate.slope.surface_z, 2)));
    result.slice_width = std::min(options.slice_width, half_chord / 2);
    if (std::abs(options.position) + result.slice_width / 2 >= radius)
      throw InputError("the slice at " + std::to_string(options.position) + " d leaves the drum of radius " +
                       std::to_string(radius) + " d");
  } else {
    result.frame_source = last.period_x > 0 ? FrameSource::domain : FrameSource::gravity;
    result.slice_width =
        last.period_x > 0 ? last.period_x : std::min(options.slice_width, found.x_max - found.x_min);
  }
  result.frame_angle_deg = frame_angle(frame, last) * degrees;

  const LayerGrid grid = layer_grid(frame, options.position, result.slice_width, options.layer_thickness,
                                    radius > 0 ? -radius : found.z_min, radius > 0 ? radius : found.z_max,
                                    radius, radius > 0 ? 0 : last.period_x);
  const double wall_height =
      radius > 0 ? -std::sqrt(std::max(0.0, radius * radius - options.position * options.position))
                 : grid.z_min;
  result.scalars.scalars = {theta, theta_com};
  measure_layers(recording, grid, options, wall_height, result, tick);
  if (!(radius > 0)) result.axis_depth = ProfileScalars::none;
  // What the drum lifts on one side flows down on the other: the flux through the middle of a straight
  // surface.
  const double nu = result.scalars.value("nu_bulk"), c = result.axis_depth;
  result.scalars.scalars.push_back(
      {"Q_expected", nu * result.rotation * (radius * radius - c * c) / 2, std::nullopt});
  return result;
}

std::string name_of(FrameSource source) {
  switch (source) {
    case FrameSource::isoline:
      return "isoline";
    case FrameSource::centre_of_mass:
      return "centre of mass";
    case FrameSource::gravity:
      return "gravity";
    case FrameSource::domain:
      return "domain";
  }
  return {};
}

}  // namespace drumlin
