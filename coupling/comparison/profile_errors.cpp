#include "coupling/comparison/profile_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace drumlin {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* log_shear_rate = "log10_shear_rate";

/// Value at z between the two entries around it; NaN outside of the profile or beside a missing entry.
double interpolated(const std::vector<double>& z, const std::vector<double>& value, double at) {
  const auto upper = std::lower_bound(z.begin(), z.end(), at);
  if (upper == z.end()) return nan;
  const auto i = static_cast<std::size_t>(upper - z.begin());
  if (*upper == at) return value[i];
  if (i == 0) return nan;
  const double share = (at - z[i - 1]) / (z[i] - z[i - 1]);
  return (1 - share) * value[i - 1] + share * value[i];
}

double interval_at(const ProfileColumn& column, std::size_t layer) {
  return column.ci99.empty() ? nan : column.ci99[layer];
}

void take_logarithm(FieldOverlay& field) {
  for (std::size_t i = 0; i < field.z.size(); ++i) {
    const double rate = field.particles[i];
    // Without an interval a positive rate is taken as it is.
    const bool known = rate > 0 && !(field.ci99[i] >= rate);
    field.particles[i] = known ? std::log10(rate) : nan;
    field.ci99[i] = known ? field.ci99[i] / (rate * std::numbers::ln10) : nan;
    field.continuum[i] = field.continuum[i] > 0 ? std::log10(field.continuum[i]) : nan;
  }
}

}  // namespace

std::vector<Zone> zones_of(const ProfileSet& particles, double H, const ZoneOptions& options) {
  const double bottom = particles.z.empty() ? nan : particles.z.front() + options.wall_margin;
  // The interface itself belongs to the flowing layer.
  return {{"flowing", -H, -options.surface_margin},
          {"static", bottom, std::nextafter(-H, -std::numeric_limits<double>::infinity())},
          {"all", bottom, -options.surface_margin}};
}

const std::vector<std::string>& compared_fields() {
  static const std::vector<std::string> fields{"v_x", "sigma_zz", "sigma_xz", "sigma_xx", log_shear_rate};
  return fields;
}

FieldOverlay overlay(const std::string& field, const ProfileSet& particles, const ProfileSet& continuum) {
  const std::string column = field == log_shear_rate ? "shear_rate" : field;
  const ProfileColumn& ours = particles.column(column);
  const ProfileColumn& theirs = continuum.column(column);
  FieldOverlay result{field, particles.z, ours.value, {}, {}};
  for (std::size_t i = 0; i < result.z.size(); ++i) {
    result.ci99.push_back(interval_at(ours, i));
    result.continuum.push_back(interpolated(continuum.z, theirs.value, result.z[i]));
  }
  if (field == log_shear_rate) take_logarithm(result);
  return result;
}

FieldErrors errors_in(const FieldOverlay& field, const Zone& zone) {
  FieldErrors errors;
  double sum = 0, norm = 0, largest = 0;
  int with_band = 0, inside = 0;
  for (std::size_t i = 0; i < field.z.size(); ++i) {
    if (!(field.z[i] >= zone.from && field.z[i] <= zone.to) || std::isnan(field.particles[i])) continue;
    if (std::isnan(field.continuum[i])) {
      ++errors.undefined;
      continue;
    }
    const double difference = std::abs(field.continuum[i] - field.particles[i]);
    sum += difference * difference;
    norm += field.particles[i] * field.particles[i];
    largest = std::max(largest, difference);
    ++errors.layers;
    if (std::isnan(field.ci99[i])) continue;
    ++with_band;
    if (difference <= field.ci99[i]) ++inside;
  }
  errors.rms = errors.layers > 0 ? std::sqrt(sum / errors.layers) : nan;
  errors.max = errors.layers > 0 ? largest : nan;
  errors.rel_l2 = norm > 0 ? std::sqrt(sum / norm) : (errors.layers > 0 && sum == 0 ? 0 : nan);
  errors.inside_band = with_band > 0 ? static_cast<double>(inside) / with_band : nan;
  return errors;
}

}  // namespace drumlin
