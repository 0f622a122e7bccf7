#include "coupling/study/run_scalars.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "coupling/exchange/profile_scalars.hpp"
#include "coupling/study/law_fit.hpp"

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;
constexpr double surface_margin = 2, bulk_margin = 4, wall_margin = 3;  // d; those of the measurement
constexpr double logarithmic_from = 1e-4;                               // I; below it mu falls faster

struct Value {
  double value = nan;
  double ci99 = nan;
};

Value value_of(const ScalarSet& scalars, const std::string& name) {
  const Scalar* found = scalars.find(name);
  return found == nullptr ? Value{} : Value{found->value, found->ci99.value_or(nan)};
}

/// One layer's entry; NaN where the column or its interval is missing.
Value at(const ProfileSet& profiles, const std::string& name, std::size_t layer) {
  const ProfileColumn* column = profiles.find(name);
  if (column == nullptr) return {};
  return {column->value[layer], column->ci99.empty() ? nan : column->ci99[layer]};
}

using LayerValue = std::function<Value(std::size_t)>;

/// Mean over the layers from <= z <= to where it is known.
Value mean_between(const ProfileSet& profiles, double from, double to, const LayerValue& value) {
  double sum = 0, intervals = 0, n = 0;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    if (!(profiles.z[l] >= from && profiles.z[l] <= to)) continue;
    const Value one = value(l);
    if (!std::isfinite(one.value)) continue;
    sum += one.value;
    intervals += one.ci99;
    n += 1;
  }
  return n < 3 ? Value{} : Value{sum / n, intervals / n};
}

Value difference(const Value& a, const Value& b) { return {a.value - b.value, std::hypot(a.ci99, b.ci99)}; }

/// a^p b^q with independent relative errors.
Value product(const Value& a, double p, const Value& b, double q) {
  const double value = std::pow(a.value, p) * std::pow(b.value, q);
  return {value, std::abs(value) * std::hypot(p * a.ci99 / a.value, q * b.ci99 / b.value)};
}

Value tangent(const Value& angle_deg) {
  const double tangent = std::tan(angle_deg.value * degree);
  return {tangent, (1 + tangent * tangent) * angle_deg.ci99 * degree};
}

/// Layers below the flowing one where the sign of the shear rate is known.
bool creeps(const ProfileSet& profiles, std::size_t layer, double H) {
  const Value rate = at(profiles, "shear_rate", layer);
  const double wall = number_or_nan(profiles.header, &RunHeader::wall_z);
  const bool below = profiles.z[layer] < -H;
  const bool off_the_wall = std::isnan(wall) || profiles.z[layer] > wall + wall_margin;
  return below && off_the_wall && rate.value > (std::isfinite(rate.ci99) ? rate.ci99 : 0);
}

Value friction_slope_below(const ProfileSet& profiles, double H) {
  std::vector<LawPoint> points;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    const Value inertial = at(profiles, "I", l), friction = at(profiles, "mu", l);
    if (creeps(profiles, l, H) && inertial.value < logarithmic_from)
      points.push_back(
          {std::log(inertial.value), friction.value, inertial.ci99 / inertial.value, friction.ci99});
  }
  const LawFit fit = fit_line(points);
  return fit.points < 4 ? Value{} : Value{fit.coefficients[1].value, fit.coefficients[1].ci99};
}

/// Relative change of the shear rate over the straight part of v_x(z).
Value shear_rate_change(const ProfileSet& profiles, const ProfileScalars& line) {
  const double top = std::fmin(line.fit_top, -surface_margin);
  const double middle = (line.fit_bottom + top) / 2;
  const LayerValue rate = [&](std::size_t l) { return at(profiles, "shear_rate", l); };
  const Value upper = mean_between(profiles, middle, top, rate);
  const Value lower = mean_between(profiles, line.fit_bottom, middle, rate);
  const double mean = (upper.value + lower.value) / 2;
  const Value change = difference(upper, lower);
  return {change.value / mean, change.ci99 / mean};
}

}  // namespace

ScalarSet with_derived(const ScalarSet& measured, const ProfileSet& profiles) {
  ScalarSet set = measured;
  const auto add = [&](const std::string& name, const Value& value) {
    if (measured.find(name) != nullptr) return;
    set.scalars.push_back({name, value.value, std::nullopt});
    if (std::isfinite(value.ci99)) set.scalars.back().ci99 = value.ci99;
  };
  const auto known = [&](const std::string& name) { return value_of(measured, name); };
  const Value H = known("H"), Q = known("Q");
  const double wall = number_or_nan(profiles.header, &RunHeader::wall_z);

  add("mu_eff", tangent(known("theta_deg")));
  add("mu_eff_com", tangent(known("theta_com_deg")));
  add("H_over_sqrt_Q", product(H, 1, Q, -0.5));
  const double expected = known("Q_expected").value;
  add("Q_over_expected", {Q.value / expected, Q.ci99 / expected});

  const LayerValue fraction = [&](std::size_t l) { return at(profiles, "nu", l); };
  add("nu_flowing_drop", difference(mean_between(profiles, wall + bulk_margin, -H.value, fraction),
                                    mean_between(profiles, -H.value, -bulk_margin, fraction)));
  const Value speed = mean_between(profiles, -H.value, -surface_margin,
                                   [&](std::size_t l) { return at(profiles, "v_x", l); });
  const Value normal = mean_between(profiles, -H.value, -surface_margin, [&](std::size_t l) {
    const Value v_z = at(profiles, "v_z", l);
    return Value{std::abs(v_z.value), v_z.ci99};
  });
  add("v_z_share", {normal.value / speed.value, normal.ci99 / speed.value});
  add("kinetic_share", mean_between(profiles, -H.value, -surface_margin, [&](std::size_t l) {
        const double whole = at(profiles, "sigma_zz", l).value;
        const Value kinetic = at(profiles, "sigma_zz_kinetic", l);
        return Value{kinetic.value / whole, kinetic.ci99 / whole};
      }));
  const ProfileScalars line = profile_scalars(profiles);
  add("shear_rate_change", shear_rate_change(profiles, line));
  const Value below = friction_slope_below(profiles, H.value);
  add("mu_b_below", below);
  add("mu_b_excess", difference(below, known("mu_b")));
  const Value beside = known("sigma_xz_over_weight_static");
  add("shear_stress_departure", {beside.value - 1, beside.ci99});
  const double weight = std::cos(known("theta_deg").value * degree);
  const double rotation = number_or_nan(profiles.header, &RunHeader::rotation);
  const Value speed_at_surface = known("surface_speed");
  const Value rate = known("shear_rate");
  add("shear_rate_laboratory", {rate.value + rotation, rate.ci99});
  add("coriolis_share",
      {2 * rotation * speed_at_surface.value / weight, 2 * rotation * speed_at_surface.ci99 / weight});
  add("centrifugal_share",
      {rotation * rotation * number_or_nan(profiles.header, &RunHeader::drum_radius) / weight, nan});
  return set;
}

}  // namespace drumlin::coupling
