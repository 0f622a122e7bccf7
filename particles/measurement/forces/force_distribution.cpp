#include "particles/measurement/forces/force_distribution.hpp"

#include <cmath>

namespace drumlin::particles {
namespace {

constexpr double least = 1e-4, first_linear = 0.1, linear_width = 0.1;
constexpr double per_decade = 8;

/// A contact slides when its friction is used up to this share: single precision stands between.
constexpr double sliding_mobilisation = 0.999;

/// Applies an action to each pair of sums, so that none is forgotten.
template <class Action>
void for_each_sum(DistributionSums& a, const DistributionSums& b, Action action) {
  for (std::size_t k = 0; k < ForceBins::count; ++k) {
    action(a.normal[k], b.normal[k]);
    action(a.tangential[k], b.tangential[k]);
  }
  for (std::size_t k = 0; k < RatioBins::count; ++k) action(a.ratio[k], b.ratio[k]);
  for (auto member :
       {&DistributionSums::contacts, &DistributionSums::ratio_sum, &DistributionSums::sliding,
        &DistributionSums::above_1, &DistributionSums::excess_above_1, &DistributionSums::above_2,
        &DistributionSums::excess_above_2, &DistributionSums::weak, &DistributionSums::weak_logarithm})
    action(a.*member, b.*member);
}

}  // namespace

double ForceBins::edge(std::size_t bin) {
  if (bin < logarithmic) return least * std::pow(10, static_cast<double>(bin) / per_decade);
  return first_linear + linear_width * static_cast<double>(bin - logarithmic);
}

std::optional<std::size_t> ForceBins::bin_of(double force) {
  const double place = force < first_linear ? std::floor(std::log10(force / least) * per_decade)
                                            : logarithmic + std::floor((force - first_linear) / linear_width);
  if (!(place >= 0 && place < count)) return std::nullopt;
  return static_cast<std::size_t>(place);
}

void DistributionSums::add(const ContactForce& contact, double scale, std::optional<double> friction) {
  const double f_n = contact.normal * scale, f_t = std::abs(contact.tangential) * scale;
  if (!(f_n > 0)) return;  // held together by an attraction: neither ratio nor tail means anything
  contacts += 1;
  if (const auto bin = ForceBins::bin_of(f_n)) normal[*bin] += 1;
  if (const auto bin = ForceBins::bin_of(f_t)) tangential[*bin] += 1;
  const double share = f_t / f_n, place = share / RatioBins::width + 0.5;
  if (place < RatioBins::count) ratio[static_cast<std::size_t>(place)] += 1;
  ratio_sum += share;
  if (friction && share >= sliding_mobilisation * *friction) sliding += 1;
  if (f_n > 1) {
    above_1 += 1;
    excess_above_1 += f_n - 1;
  }
  if (f_n > 2) {
    above_2 += 1;
    excess_above_2 += f_n - 2;
  }
  if (f_n > weakest_force && f_n < weak_force_limit) {
    weak += 1;
    weak_logarithm += std::log(f_n);
  }
}

DistributionSums& DistributionSums::operator+=(const DistributionSums& other) {
  for_each_sum(*this, other, [](double& a, double b) { a += b; });
  return *this;
}

DistributionSums& DistributionSums::operator-=(const DistributionSums& other) {
  for_each_sum(*this, other, [](double& a, double b) { a -= b; });
  return *this;
}

double power_of(double mean_logarithm, double low, double high) {
  const double length = std::log(high / low);
  const double wanted = (mean_logarithm - std::log(low)) / length;
  if (!(wanted > 0 && wanted < 1)) return std::nan("");
  // With t = ln(x/low)/length the density is exp(k t), k = (p + 1) length; its mean grows with k.
  const auto mean_of = [](double k) {
    return std::abs(k) < 1e-4 ? 0.5 + k / 12 : 1 / -std::expm1(-k) - 1 / k;
  };
  double below = -700, above = 700;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (below + above) / 2;
    (mean_of(middle) < wanted ? below : above) = middle;
  }
  return (below + above) / 2 / length - 1;
}

ScalarSet distribution_scalars(const DistributionSums& sums, std::optional<double> friction) {
  ScalarSet set;
  const auto add = [&](const char* name, double value) {
    set.scalars.push_back({name, value, std::nullopt});
  };
  add("tail_exponent", sums.above_1 / sums.excess_above_1);
  add("tail_exponent_above_2", sums.above_2 / sums.excess_above_2);
  add("weak_exponent", power_of(sums.weak_logarithm / sums.weak, weakest_force, weak_force_limit));
  add("f_t_over_f_n", sums.ratio_sum / sums.contacts);
  if (friction) {
    add("mobilisation", sums.ratio_sum / sums.contacts / *friction);
    add("sliding_share", sums.sliding / sums.contacts);
  }
  return set;
}

}  // namespace drumlin::particles
