#include "coupling/comparison/field_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/comparison/registration.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin::coupling {

namespace {

/// Half widths that are not known count as none.
double band(double half_width) { return std::isfinite(half_width) ? half_width : 0; }

/// One place of a zone.
struct Difference {
  double value = 0;  ///< |c - p|
  double ours = 0, theirs = 0, both = 0;
};

/// What of the squared differences lies outside a band.
double explained(const std::vector<Difference>& differences, double Difference::*half_width) {
  double outside = 0, all = 0;
  bool any_band = false;
  for (const Difference& d : differences) {
    any_band |= d.*half_width > 0;
    outside += std::pow(std::max(0.0, d.value - d.*half_width), 2);
    all += d.value * d.value;
  }
  return any_band && all > 0 ? 1 - outside / all : no_value;
}

/// Share of the places inside a band, among those that have one.
double share_inside(const std::vector<Difference>& differences, double Difference::*half_width) {
  int with_band = 0, inside = 0;
  for (const Difference& d : differences) {
    if (!std::isfinite(d.ours)) continue;
    ++with_band;
    if (d.value <= d.*half_width) ++inside;
  }
  return with_band > 0 ? static_cast<double>(inside) / with_band : no_value;
}

}  // namespace

std::vector<Zone> zones_of(const ProfileSet& particles, double H, const ZoneOptions& options) {
  const double bottom = particles.z.empty() ? no_value : particles.z.front() + options.wall_margin;
  // The interface itself belongs to the flowing layer.
  return {{"flowing", -H, -options.surface_margin},
          {"static", bottom, std::nextafter(-H, -std::numeric_limits<double>::infinity())},
          {"all", bottom, -options.surface_margin}};
}

FieldOverlay overlay(const std::string& field, const ProfileSet& particles, const ProfileSet& continuum) {
  const FieldValues ours = profile_field(field, particles), theirs = profile_field(field, continuum);
  const double position = number_or_nan(particles.header, &RunHeader::position);
  FieldOverlay result{field,
                      std::vector<double>(particles.z.size(), position),
                      particles.z,
                      ours.value,
                      ours.ci99,
                      {},
                      {},
                      ours.noise,
                      ours.present && theirs.present};
  const std::vector<double> lost(theirs.noise.begin(), theirs.noise.end());
  for (std::size_t i = 0; i < result.z.size(); ++i) {
    result.continuum.push_back(interpolated(continuum.z, theirs.value, result.z[i]));
    result.continuum_ci99.push_back(interpolated(continuum.z, theirs.ci99, result.z[i]));
    if (interpolated(continuum.z, lost, result.z[i]) > 0) result.noise[i] = 1;
  }
  return result;
}

FieldErrors errors_at(const FieldOverlay& field, const std::vector<std::size_t>& places) {
  FieldErrors errors;
  errors.max_x = errors.max_z = no_value;
  const double period = period_of(field.field);
  double sum = 0, norm = 0, largest = 0, intervals = 0;
  std::vector<Difference> differences;
  for (const std::size_t i : places) {
    if (field.present && field.noise[i] != 0) ++errors.noise;
    if (!field.present || field.noise[i] != 0 || std::isnan(field.particles[i])) continue;
    if (std::isnan(field.continuum[i])) {
      ++errors.undefined;
      continue;
    }
    const double signed_difference = field.continuum[i] - field.particles[i];
    const double difference =
        std::abs(period > 0 ? nearest_turn(signed_difference, period) : signed_difference);
    sum += difference * difference;
    norm += field.particles[i] * field.particles[i];
    if (difference > largest || errors.layers == 0) {
      errors.max_x = field.x[i];
      errors.max_z = field.z[i];
    }
    largest = std::max(largest, difference);
    ++errors.layers;
    const double ours = field.ci99[i], theirs = band(field.continuum_ci99[i]);
    intervals += band(ours) * band(ours);
    differences.push_back({difference, ours, theirs, std::hypot(band(ours), theirs)});
  }
  const bool any = errors.layers > 0;
  errors.rms = any ? std::sqrt(sum / errors.layers) : no_value;
  errors.max = any ? largest : no_value;
  errors.particles_rms = any ? std::sqrt(norm / errors.layers) : no_value;
  errors.rel_l2 = norm > 0 ? std::sqrt(sum / norm) : (any && sum == 0 ? 0 : no_value);
  errors.inside_band = share_inside(differences, &Difference::ours);
  errors.inside_both = share_inside(differences, &Difference::both);
  errors.interval_rms = std::isnan(errors.inside_band) ? no_value : std::sqrt(intervals / errors.layers);
  errors.explained_by_calibration = explained(differences, &Difference::theirs);
  for (Difference& d : differences) d.ours = band(d.ours);
  errors.explained_by_particles = explained(differences, &Difference::ours);
  errors.explained_by_both = explained(differences, &Difference::both);
  return errors;
}

FieldErrors errors_in(const FieldOverlay& field, const Zone& zone) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < field.z.size(); ++i)
    if (field.z[i] >= zone.from && field.z[i] <= zone.to) places.push_back(i);
  return errors_at(field, places);
}

}  // namespace drumlin::coupling
