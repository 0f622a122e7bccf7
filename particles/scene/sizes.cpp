#include "particles/scene/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace drumlin::particles {
namespace {

/// Integral of x^power between two bounds.
double integral(double power, double low, double high) {
  if (power == -1) return std::log(high / low);
  return (std::pow(high, power + 1) - std::pow(low, power + 1)) / (power + 1);
}

double drawn(const PowerLawSizes& law, double low, double high, RandomStream& random) {
  const double share = random.uniform(), power = 1 - law.exponent;
  if (power == 0) return low * std::pow(high / low, share);
  const double from = std::pow(low, power), to = std::pow(high, power);
  return std::pow(from + share * (to - from), 1 / power);
}

/// Box and Muller's normal numbers, until one falls between the bounds.
double drawn(const LognormalSizes& law, double low, double high, RandomStream& random) {
  for (;;) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
    const double normal = radius * std::cos(2 * std::numbers::pi * random.uniform());
    const double diameter = law.median_mm * std::exp(law.sigma * normal);
    if (diameter >= low && diameter <= high) return diameter;
  }
}

double drawn(const TwoSizes& law, double low, double high, RandomStream& random) {
  return random.uniform() < law.small_share ? low : high;
}

double mean_power(const PowerLawSizes& law, double low, double high, int power) {
  return integral(power - law.exponent, low, high) / integral(-law.exponent, low, high);
}

double mean_power(const LognormalSizes& law, double low, double high, int power) {
  const auto share_below = [&](double bound, double shift) {
    return std::erfc(-(std::log(bound / law.median_mm) / law.sigma - shift) / std::numbers::sqrt2) / 2;
  };
  const auto share = [&](double shift) { return share_below(high, shift) - share_below(low, shift); };
  const double shift = power * law.sigma;
  return std::pow(law.median_mm, power) * std::exp(shift * shift / 2) * share(shift) / share(0);
}

double mean_power(const TwoSizes& law, double low, double high, int power) {
  return law.small_share * std::pow(low, power) + (1 - law.small_share) * std::pow(high, power);
}

}  // namespace

double drawn_diameter_mm(const GeneratedGrains& grains, RandomStream& random) {
  const double low = grains.diameter_min_mm, high = grains.diameter_max_mm;
  if (!grains.sizes || low == high) return random.uniform(low, high);
  const double diameter =
      std::visit([&](const auto& law) { return drawn(law, low, high, random); }, *grains.sizes);
  return std::clamp(diameter, low, high);  // powers round
}

std::vector<double> diameters_mm(const GeneratedGrains& grains, RandomStream& random) {
  std::vector<double> diameters;
  const auto* two = grains.sizes ? std::get_if<TwoSizes>(&*grains.sizes) : nullptr;
  if (!two) {
    for (int g = 0; g < grains.count; ++g) diameters.push_back(drawn_diameter_mm(grains, random));
    return diameters;
  }
  const auto small = std::llround(two->small_share * grains.count);
  diameters.assign(static_cast<std::size_t>(small), grains.diameter_min_mm);
  diameters.resize(static_cast<std::size_t>(grains.count), grains.diameter_max_mm);
  for (std::size_t left = diameters.size(); left > 1; --left)
    std::swap(diameters[left - 1],
              diameters[static_cast<std::size_t>(random.uniform() * static_cast<double>(left))]);
  return diameters;
}

double mean_power_mm(const GeneratedGrains& grains, int power) {
  const double low = grains.diameter_min_mm, high = grains.diameter_max_mm;
  if (low == high) return std::pow(low, power);
  if (!grains.sizes) return integral(power, low, high) / (high - low);
  return std::visit([&](const auto& law) { return mean_power(law, low, high, power); }, *grains.sizes);
}

}  // namespace drumlin::particles
