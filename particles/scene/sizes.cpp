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

/// Exponent of the numbers: the mass of a disc is as D^2.
double exponent_of(const PowerLawSizes& law) {
  return law.by == CountedBy::mass ? law.exponent + 2 : law.exponent;
}

double drawn(const PowerLawSizes& law, double low, double high, RandomStream& random) {
  const double share = random.uniform(), power = 1 - exponent_of(law);
  if (power == 0) return low * std::pow(high / low, share);
  const double from = std::pow(low, power), to = std::pow(high, power);
  return std::pow(from + share * (to - from), 1 / power);
}

/// Median of the numbers: D^-2 times a normal distribution of ln D is one that lies 2 sigma^2 lower.
double median_of(const LognormalSizes& law) {
  return law.by == CountedBy::mass ? law.median_mm * std::exp(-2 * law.sigma * law.sigma) : law.median_mm;
}

/// Share of the numbers above a bound, where ln D lies `shift` deviations higher.
double share_above(const LognormalSizes& law, double bound, double shift) {
  return std::erfc((std::log(bound / median_of(law)) / law.sigma - shift) / std::numbers::sqrt2) / 2;
}

/// Halves the interval of the diameter above which the drawn share of the numbers lies.
double drawn_from_tail(const LognormalSizes& law, double low, double high, RandomStream& random) {
  const double most = share_above(law, low, 0), least = share_above(law, high, 0);
  const double share = most - random.uniform() * (most - least);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (share_above(law, middle, 0) > share ? low : high) = middle;
  }
  return low;
}

/// Box and Muller's normal numbers, until one falls between the bounds. By mass, few of them may.
double drawn(const LognormalSizes& law, double low, double high, RandomStream& random) {
  if (law.by == CountedBy::mass) return drawn_from_tail(law, low, high, random);
  for (;;) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
    const double normal = radius * std::cos(2 * std::numbers::pi * random.uniform());
    const double diameter = law.median_mm * std::exp(law.sigma * normal);
    if (diameter >= low && diameter <= high) return diameter;
  }
}

/// Diameters of one size, or between two with the mass spread evenly over ln D, so the numbers as D^-3.
struct SizeClass {
  double low = 0, high = 0;
  double share = 0;  ///< by number
};
constexpr double exponent_within = 3;

std::vector<SizeClass> classes_of(const TwoSizes& law, double low, double high) {
  double small = law.small_share;
  if (law.by == CountedBy::mass) {
    const double smalls = small / (low * low), larges = (1 - small) / (high * high);
    small = smalls / (smalls + larges);
  }
  return {{low, low, small}, {high, high, 1 - small}};
}

std::vector<SizeClass> classes_of(const SieveSizes& law, double low, double high) {
  std::vector<SizeClass> classes;
  double passed = 0, numbers = 0;
  const auto add = [&](double opening, double share) {
    if (opening > low && share > passed) {
      const double per_mass =
          integral(-exponent_within, low, opening) / integral(2 - exponent_within, low, opening);
      classes.push_back({low, opening, (share - passed) * per_mass});
      numbers += classes.back().share;
    }
    low = opening, passed = share;
  };
  for (std::size_t k = 0; k < law.openings_mm.size(); ++k) add(law.openings_mm[k], law.passing_share[k]);
  add(high, 1);
  for (SizeClass& one : classes) one.share /= numbers;
  return classes;
}

double drawn(const SizeClass& one, RandomStream& random) {
  if (one.low == one.high) return one.low;
  return std::clamp(drawn(PowerLawSizes{exponent_within}, one.low, one.high, random), one.low, one.high);
}

template <class Law>
double drawn(const Law& law, double low, double high, RandomStream& random) {
  const auto classes = classes_of(law, low, high);
  double place = random.uniform();
  std::size_t k = 0;
  while (k + 1 < classes.size() && place >= classes[k].share) place -= classes[k++].share;
  return drawn(classes[k], random);
}

double mean_power(const PowerLawSizes& law, double low, double high, int power) {
  return integral(power - exponent_of(law), low, high) / integral(-exponent_of(law), low, high);
}

double mean_power(const LognormalSizes& law, double low, double high, int power) {
  const auto share_below = [&](double bound, double shift) {
    return std::erfc(-(std::log(bound / law.median_mm) / law.sigma - shift) / std::numbers::sqrt2) / 2;
  };
  const auto share = [&](double shift) {
    return law.by == CountedBy::mass ? share_above(law, low, shift) - share_above(law, high, shift)
                                     : share_below(high, shift) - share_below(low, shift);
  };
  const double shift = power * law.sigma;
  return std::pow(median_of(law), power) * std::exp(shift * shift / 2) * share(shift) / share(0);
}

template <class Law>
double mean_power(const Law& law, double low, double high, int power) {
  double mean = 0;
  for (const SizeClass& one : classes_of(law, low, high))
    mean += one.share * (one.low == one.high ? std::pow(one.low, power)
                                             : integral(power - exponent_within, one.low, one.high) /
                                                   integral(-exponent_within, one.low, one.high));
  return mean;
}

/// As many diameters of each class as its share asks for, then shuffled.
std::vector<double> dealt(const std::vector<SizeClass>& classes, int count, RandomStream& random) {
  std::vector<double> diameters;
  double shares = 0;
  for (const SizeClass& one : classes) {
    shares += one.share;
    const auto until = &one == &classes.back() ? count : std::llround(shares * count);
    while (static_cast<std::int64_t>(diameters.size()) < until) diameters.push_back(drawn(one, random));
  }
  for (std::size_t left = diameters.size(); left > 1; --left)
    std::swap(diameters[left - 1],
              diameters[static_cast<std::size_t>(random.uniform() * static_cast<double>(left))]);
  return diameters;
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
  const double low = grains.diameter_min_mm, high = grains.diameter_max_mm;
  if (const auto* two = grains.sizes ? std::get_if<TwoSizes>(&*grains.sizes) : nullptr)
    return dealt(classes_of(*two, low, high), grains.count, random);
  if (const auto* sieves = grains.sizes ? std::get_if<SieveSizes>(&*grains.sizes) : nullptr;
      sieves && low < high)
    return dealt(classes_of(*sieves, low, high), grains.count, random);
  std::vector<double> diameters;
  for (int g = 0; g < grains.count; ++g) diameters.push_back(drawn_diameter_mm(grains, random));
  return diameters;
}

double mean_power_mm(const GeneratedGrains& grains, int power) {
  const double low = grains.diameter_min_mm, high = grains.diameter_max_mm;
  if (low == high) return std::pow(low, power);
  if (!grains.sizes) return integral(power, low, high) / (high - low);
  return std::visit([&](const auto& law) { return mean_power(law, low, high, power); }, *grains.sizes);
}

}  // namespace drumlin::particles
