#include "particles/measurement/frame/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/dense_window.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/grain_bins.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

FlowFrame upright_frame(const Snapshot& snapshot) {
  if (snapshot.container_radius > 0)
    return frame_at_slope(snapshot.container_x, snapshot.container_z, snapshot.gravity_x, snapshot.gravity_z,
                          0);
  double mean_x = 0;
  for (double x : snapshot.x) mean_x += x / static_cast<double>(snapshot.x.size());
  // Layers must run along the period, whatever gravity does.
  if (snapshot.period_x > 0) return FlowFrame{mean_x, 0, 1, 0};
  return frame_at_slope(mean_x, 0, snapshot.gravity_x, snapshot.gravity_z, 0);
}

/// Translation of all grains relative to the drum.
void add_motion(const Snapshot& snapshot, RelativeVelocities& velocity, TimeSeries& series) {
  relative_velocities(snapshot, VelocityKind::instantaneous, velocity);
  double energy = 0, mass = 0;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    energy += mass_of(snapshot, i) / 2 * (velocity.x[i] * velocity.x[i] + velocity.z[i] * velocity.z[i]);
    mass += mass_of(snapshot, i);
  }
  series.kinetic_energy.push_back(energy);
  series.speed.push_back(mass > 0 ? std::sqrt(2 * energy / mass) : 0);
}

void widen_reach(const Snapshot& snapshot, Survey& found) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const auto [x, z] = found.upright.place(snapshot.x[i], snapshot.z[i]);
    const double r = snapshot.radius[i];
    found.reach.widen({x - r, x + r, z - r, z + r});
  }
}

/// Stress and shear rate of all grains together: NaN without contacts, or with fewer than three grains that
/// touch something at two heights. Grains in free flight enter by their area alone.
void add_bulk(const Snapshot& snapshot, const FlowFrame& frame, TimeSeries& series) {
  const FlowSnapshot seen = in_flow_frame(snapshot, frame);
  std::array<GrainSum, 1> all{};
  accumulate(seen, Everywhere{}, all);
  const Tensor<2> stress = derive(all[0], Background<2>{all[0].solid}).contact;
  std::vector<double> heights, velocities;
  for (std::size_t i = 0; i < seen.x.size(); ++i) {
    if (seen.coordination[i] == 0) continue;
    heights.push_back(seen.z[i]);
    velocities.push_back(seen.v_x[i]);
  }
  const auto line = heights.size() < 3 ? std::nullopt : statistics::fit_line(heights, velocities);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const bool known = snapshot.contacts_known;
  series.pressure.push_back(known ? (stress[0][0] + stress[1][1]) / 2 : none);
  series.shear_stress.push_back(known ? -stress[0][1] : none);
  series.shear_rate.push_back(known && line ? line->slope : none);
}

/// Takes the window in place of an extent beyond the limits.
void cut_to_window(const Occupancy& occupancy, std::size_t grains, double period, Survey& found) {
  const WindowLimits limits = window_limits(grains);
  if (fits(limits, found.reach, period)) return;
  const Rectangle window = occupancy.window(found.reach, limits);
  found.cut_to_window = true;
  const double middle = period > 0 ? 0 : (window.x_min + window.x_max) / 2;
  found.upright.origin_x += middle * found.upright.x_axis_x;
  found.upright.origin_z += middle * found.upright.x_axis_z;
  found.reach = {window.x_min - middle, window.x_max - middle, window.z_min, window.z_max};
}

void refuse_changed_period(double before, double now) {
  if (std::abs(now - before) > 1e-9 * before)
    throw InputError(
        "the period of this run changes its length along x: layers and maps take one for all snapshots "
        "(allowed: one length, or a cell that is periodic in z too)");
}

}  // namespace

Survey survey(const Recording& recording, std::size_t batches, std::shared_ptr<ScratchFile> file,
              const std::function<void()>& tick) {
  Survey found;
  RelativeVelocities velocity;
  Occupancy occupancy;
  std::size_t most_grains = 0;
  double period = 0, bottom = 0, top = 0;
  for (std::size_t s = 0; s < recording.count(); ++s) {
    const Snapshot snapshot = recording.read(s);
    const double radius = snapshot.container_radius;
    if (s == 0) {
      found.upright = upright_frame(snapshot);
      if (radius > 0)
        found.coverage.emplace(CoverageMap({-radius, radius, -radius, radius}), std::move(file));
    }
    if (s > 0 && radius <= 0 && !snapshot.cell) refuse_changed_period(period, snapshot.period_x);
    widen_reach(snapshot, found);
    if (snapshot.cell) {
      found.closed = true;
      found.cell_length += snapshot.period_x / static_cast<double>(recording.count());
      bottom += snapshot.cell->z / static_cast<double>(recording.count());
      top += (snapshot.cell->z + snapshot.cell->height) / static_cast<double>(recording.count());
    }
    found.series.time.push_back(snapshot.time);
    found.series.wall_angle.push_back(snapshot.wall_angle);
    add_motion(snapshot, velocity, found.series);
    if (radius > 0) {
      found.coverage->add(snapshot, found.upright, batch_of(s, recording.count(), batches));
      found.series.mass_angle.push_back(centre_of_mass_angle(snapshot, found.upright));
    } else {
      occupancy.add(snapshot, found.upright);
      period = snapshot.period_x;
      most_grains = std::max(most_grains, snapshot.x.size());
      add_bulk(snapshot, found.upright, found.series);
    }
    tick();
  }
  if (found.closed)
    found.reach.z_min = bottom, found.reach.z_max = top;  // beyond it are images
  else if (most_grains > 0)
    cut_to_window(occupancy, most_grains, period, found);
  return found;
}

SlopeEstimate slope_estimate(const Survey& found, double first_guess, const SlopeOptions& options) {
  const CoverageBatches& coverage = *found.coverage;
  const CoverageMap whole = coverage.whole();
  SlopeEstimate estimate;
  estimate.slope = isoline_slope(whole, first_guess, options);
  std::vector<double> leave_one_out;
  for (std::size_t b = 0; b < coverage.size() && coverage.size() > 1; ++b) {
    CoverageMap rest = whole;
    add_times(-1, coverage.batch(b), rest);
    leave_one_out.push_back(isoline_slope(rest, first_guess, options).theta);
  }
  estimate.ci99 = jackknife_ci99(leave_one_out);
  return estimate;
}

}  // namespace drumlin::particles
