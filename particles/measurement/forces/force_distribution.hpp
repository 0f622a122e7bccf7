#pragma once
// Distribution of contact forces over their mean.
#include <array>
#include <cstddef>
#include <optional>

#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/forces/contact_forces.hpp"

namespace drumlin::particles {

/// Bins of f/<f>: eight per decade from 1e-4 to 0.1, then 0.1 wide up to 10. Strong forces fall off
/// exponentially, weak ones as a power: each needs its own spacing.
struct ForceBins {
  static constexpr std::size_t logarithmic = 24, linear = 99, count = logarithmic + linear;
  /// Lower edge of a bin; edge(count) is the upper one of the last.
  static double edge(std::size_t bin);
  /// Bin that holds a force; none outside 1e-4 ... 10.
  static std::optional<std::size_t> bin_of(double force);
};

/// Bins of |f_t|/f_n, 0.01 wide about 0, 0.01, ... 1.
struct RatioBins {
  static constexpr std::size_t count = 101;
  static constexpr double width = 0.01;
};

/// Sums over contacts; forces are given over their mean.
struct DistributionSums {
  double contacts = 0;
  std::array<double, ForceBins::count> normal{}, tangential{};  ///< numbers of f_n and of |f_t|
  std::array<double, RatioBins::count> ratio{};
  double ratio_sum = 0;                    ///< of |f_t|/f_n
  double sliding = 0;                      ///< with |f_t| = mu f_n
  double above_1 = 0, excess_above_1 = 0;  ///< number of f_n > 1, sum of f_n - 1 over them
  double above_2 = 0, excess_above_2 = 0;
  double weak = 0, weak_logarithm = 0;  ///< number within the window of weak forces, sum of ln f_n

  /// `scale`: 1 / mean normal force. Without a coefficient of friction nothing counts as sliding.
  void add(const ContactForce& contact, double scale, std::optional<double> friction);
  DistributionSums& operator+=(const DistributionSums& other);
  DistributionSums& operator-=(const DistributionSums& other);
};

/// Window of weak forces, over the mean. Below it stand grains that carry nothing but their own weight: 0.02
/// of the mean at 40 d.
constexpr double weakest_force = 0.1, weak_force_limit = 0.5;

/// Exponent p of a density x^p between `low` and `high` from the mean of ln x: maximum likelihood.
double power_of(double mean_logarithm, double low, double high);

/// tail_exponent (beta of P ~ exp(-beta f/<f>) above the mean, maximum likelihood), tail_exponent_above_2,
/// weak_exponent (P ~ f^p within the window above), f_t_over_f_n (mean over contacts); with friction also
/// mobilisation = f_t_over_f_n/mu and sliding_share.
ScalarSet distribution_scalars(const DistributionSums& sums, std::optional<double> friction);

}  // namespace drumlin::particles
