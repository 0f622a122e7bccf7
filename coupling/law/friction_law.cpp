#include "coupling/law/friction_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "coupling/common/errors.hpp"

namespace drumlin {
namespace {

constexpr double least_mu = 1e-3;  // m of kept_positive()

// dmu/dln I at the last point of what is straight in I through the last two; of the cubic before it at most
// three chords in ln I, beyond which it would not grow everywhere.
double last_slope(const std::vector<double>& I, const std::vector<double>& mu) {
  const std::size_t n = I.size() - 1;
  const double growth = mu[n] - mu[n - 1];
  return growth * std::min(I[n] / (I[n] - I[n - 1]), 3 / std::log(I[n] / I[n - 1]));
}

}  // namespace

FrictionValue kept_positive(double mu, double slope) {
  const double root = std::sqrt(mu * mu + 4 * least_mu * least_mu);
  return {0.5 * (mu + root), 0.5 * slope * (1 + mu / root)};
}

double positivity_slope(double kept) { return kept * kept / (kept * kept + least_mu * least_mu); }

FrictionValue LogLaw::friction(double I) const { return kept_positive(a + b * std::log(I), b); }

FrictionValue LogLinearLaw::friction(double I) const {
  return kept_positive(a + b * std::log(I) + c * I, b + c * I);
}

FrictionValue SaturatingLaw::friction(double I) const {
  const double share = I / (I_0 + I);
  return {mu_s + (mu_2 - mu_s) * share, (mu_2 - mu_s) * share * I_0 / (I_0 + I)};
}

FrictionValue ConstantLaw::friction(double /*I*/) const { return {mu, 0}; }

TabulatedLaw::TabulatedLaw(const std::vector<double>& I, const std::vector<double>& mu, Beyond beyond)
    : mu_of_ln_I_(logarithms(I), mu, MonotoneCubic::Outside::goes_on,
                  beyond == Beyond::straight_in_I ? last_slope(I, mu) : std::optional<double>()),
      straight_from_(beyond == Beyond::straight_in_I ? I.back() : std::numeric_limits<double>::infinity()) {}

FrictionValue TabulatedLaw::friction(double I) const {
  if (I > straight_from_) {
    const CurvePoint end = mu_of_ln_I_.at(std::log(straight_from_));
    const double share = I / straight_from_;
    return kept_positive(end.value + end.slope * (share - 1), end.slope * share);
  }
  const CurvePoint at = mu_of_ln_I_.at(std::log(I));
  return kept_positive(at.value, at.slope);
}

namespace {

// From what a file holds to what computes.
struct LawOfFile {
  FrictionLaw operator()(const LogFriction& mu) const { return LogLaw{mu.a, mu.b}; }
  FrictionLaw operator()(const LogLinearFriction& mu) const { return LogLinearLaw{mu.a, mu.b, mu.c}; }
  FrictionLaw operator()(const ConstantFriction& mu) const { return ConstantLaw{mu.mu}; }
  FrictionLaw operator()(const JopFriction& mu) const { return SaturatingLaw{mu.mu_s, mu.mu_2, mu.I_0}; }
  FrictionLaw operator()(const FrictionTable& mu) const { return TabulatedLaw(mu.I, mu.mu); }
};

struct Threshold {
  std::optional<double> operator()(const SaturatingLaw& law) const { return law.mu_s; }
  std::optional<double> operator()(const ConstantLaw& law) const { return law.mu; }
  std::optional<double> operator()(const LogLaw&) const { return {}; }
  std::optional<double> operator()(const LogLinearLaw&) const { return {}; }
  std::optional<double> operator()(const TabulatedLaw&) const { return {}; }
};

}  // namespace

FrictionTable sampled_friction(const std::function<double(double)>& mu, double I_min, double I_max,
                               int per_decade) {
  if (!(I_min > 0 && I_min < I_max && std::isfinite(I_max) && per_decade > 0))
    throw InputError(
        fmt::format("a friction is sampled from {:g} to {:g} with {} points to a decade (allowed: "
                    "0 < I_min < I_max, 1 point or more)",
                    I_min, I_max, per_decade));
  const int intervals = std::max(1, static_cast<int>(std::ceil(per_decade * std::log10(I_max / I_min))));
  FrictionTable table;
  for (int i = 0; i <= intervals; ++i) {
    table.I.push_back(I_min * std::pow(I_max / I_min, static_cast<double>(i) / intervals));
    table.mu.push_back(mu(table.I.back()));
    const double least = i == 0 ? 0 : table.mu[static_cast<std::size_t>(i) - 1];
    if (!(table.mu.back() > least && std::isfinite(table.mu.back())))
      throw InputError(
          fmt::format("mu({:.4g}) = {:.6g} (allowed: above {:.6g}, for a friction is positive and "
                      "grows with I)",
                      table.I.back(), table.mu.back(), least));
  }
  return table;
}

FrictionLaw friction_law(const MeasuredFriction& mu) { return std::visit(LawOfFile{}, mu); }

FrictionValue friction_at(const FrictionLaw& law, double I) {
  return std::visit([I](const auto& chosen) { return chosen.friction(I); }, law);
}

std::optional<double> threshold(const FrictionLaw& law) { return std::visit(Threshold{}, law); }

}  // namespace drumlin
