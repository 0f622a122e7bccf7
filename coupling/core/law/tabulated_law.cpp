#include "coupling/core/law/tabulated_law.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

// dmu/dln I at the last point of what is straight in I through the last two; of the cubic before it at most
// three chords in ln I, beyond which it would not grow everywhere.
double last_slope(const FrictionTable& points) {
  const auto& [I, mu] = points;
  const std::size_t n = I.size() - 1;
  const double growth = mu[n] - mu[n - 1];
  return growth * std::min(I[n] / (I[n] - I[n - 1]), 3 / std::log(I[n] / I[n - 1]));
}

}  // namespace

std::vector<FormFault> faults_of(const FrictionTable& points) {
  const auto& [I, mu] = points;
  std::vector<FormFault> faults;
  if (I.size() < 2) faults.push_back({"I", "has fewer than two entries", "two at least"});
  if (I.size() != mu.size()) faults.push_back({"mu", "has another length than I", "one mu for each I"});
  if (std::adjacent_find(I.begin(), I.end(), std::greater_equal<>()) != I.end())
    faults.push_back({"I", "is not sorted", "ascending"});
  const auto stop = std::adjacent_find(mu.begin(), mu.end(), std::greater_equal<>());
  if (stop == mu.end()) return faults;
  const auto entry = stop - mu.begin() + 1;
  faults.push_back({"mu",
                    fmt::format("from entry {} to {}, {}", entry, entry + 1,
                                stop[1] < stop[0] ? mu_falls
                                                  : "mu does not change: the law would not say how fast its "
                                                    "flow is"),
                    "growing"});
  return faults;
}

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

TabulatedLaw::TabulatedLaw(std::vector<double> I, std::vector<double> mu, Beyond beyond)
    : points_{std::move(I), std::move(mu)} {
  if (points_.I.size() < 2 || points_.I.size() != points_.mu.size()) return;  // faults()
  const bool in_I = beyond == Beyond::straight_in_I;
  mu_of_ln_I_.emplace(logarithms(points_.I), points_.mu, MonotoneCubic::Outside::goes_on,
                      in_I ? last_slope(points_) : std::optional<double>());
  if (in_I) straight_from_ = points_.I.back();
}

FrictionValue TabulatedLaw::friction(double I) const {
  if (I > straight_from_) {
    const CurvePoint end = mu_of_ln_I_->at(std::log(straight_from_));
    const double share = I / straight_from_;
    return kept_positive(end.value + end.slope * (share - 1), end.slope * share);
  }
  const CurvePoint at = mu_of_ln_I_->at(std::log(I));
  return kept_positive(at.value, at.slope);
}

std::string TabulatedLaw::words() const {
  const auto& [I, mu] = points_;
  return "mu from " + in_words(mu.front()) + " at I = " + in_words(I.front()) + " to " + in_words(mu.back()) +
         " at I = " + in_words(I.back()) + ", " + std::to_string(I.size()) + " points";
}

}  // namespace drumlin
