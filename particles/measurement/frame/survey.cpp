#include "particles/measurement/frame/survey.hpp"

#include <algorithm>
#include <numbers>

#include "coupling/documents/enum_names.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
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
double kinetic_energy(const Snapshot& snapshot, RelativeVelocities& velocity) {
  relative_velocities(snapshot, VelocityKind::instantaneous, velocity);
  double energy = 0;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i)
    energy += mass_of(snapshot, i) / 2 *
              (velocity.x[i] * velocity.x[i] + velocity.z[i] * velocity.z[i]);
  return energy;
}

void widen_extent(const Snapshot& snapshot, bool first, Survey& found) {
  if (snapshot.x.empty()) return;
  if (first) {
    const double x = found.upright.x_of(snapshot.x[0], snapshot.z[0]);
    const double z = found.upright.z_of(snapshot.x[0], snapshot.z[0]);
    found.x_min = found.x_max = x;
    found.z_min = found.z_max = z;
  }
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double x = found.upright.x_of(snapshot.x[i], snapshot.z[i]);
    const double z = found.upright.z_of(snapshot.x[i], snapshot.z[i]), r = snapshot.radius[i];
    found.x_min = std::min(found.x_min, x - r);
    found.x_max = std::max(found.x_max, x + r);
    found.z_min = std::min(found.z_min, z - r);
    found.z_max = std::max(found.z_max, z + r);
  }
}

}  // namespace

Survey survey(const Recording& recording, std::size_t batches, const std::function<void()>& tick) {
  Survey found;
  RelativeVelocities velocity;
  for (std::size_t s = 0; s < recording.count(); ++s) {
    const Snapshot snapshot = recording.read(s);
    const double radius = snapshot.container_radius;
    if (s == 0) {
      found.upright = upright_frame(snapshot);
      if (radius > 0) found.maps.assign(batches, CoverageMap(-radius, radius, -radius, radius));
    }
    widen_extent(snapshot, s == 0, found);
    found.series.time.push_back(snapshot.time);
    found.series.wall_angle.push_back(snapshot.wall_angle);
    found.series.kinetic_energy.push_back(kinetic_energy(snapshot, velocity));
    if (radius > 0) {
      found.maps[batch_of(s, recording.count(), batches)].add(snapshot, found.upright);
      found.series.mass_angle.push_back(centre_of_mass_angle(snapshot, found.upright));
    }
    tick();
  }
  return found;
}

SlopeEstimate slope_estimate(const Survey& found, double first_guess, const SlopeOptions& options) {
  CoverageMap total = found.maps.front();
  for (std::size_t b = 1; b < found.maps.size(); ++b) total += found.maps[b];
  SlopeEstimate estimate;
  estimate.slope = isoline_slope(total, first_guess, options);
  std::vector<double> leave_one_out;
  for (std::size_t b = 0; b < found.maps.size() && found.maps.size() > 1; ++b) {
    CoverageMap rest = total;
    rest -= found.maps[b];
    leave_one_out.push_back(isoline_slope(rest, first_guess, options).theta);
  }
  estimate.ci99 = jackknife_ci99(leave_one_out);
  return estimate;
}

std::string name_of(FrameSource source) {
  static constexpr EnumNames<FrameSource, 4> names{{{FrameSource::isoline, "isoline"},
                                                    {FrameSource::centre_of_mass, "centre of mass"},
                                                    {FrameSource::gravity, "gravity"},
                                                    {FrameSource::domain, "domain"}}};
  return name_in(names, source);
}

}  // namespace drumlin::particles
