#pragma once
// mu(I): the friction laws.
#include <vector>

#include "continuum/rheology/monotone_cubic.hpp"

namespace drumlin {

/// Friction coefficient at an inertial number I, and I dmu/dI.
struct Friction {
  double mu = 0;
  double slope = 0;
};

/// mu -> (mu + sqrt(mu^2 + 4 m^2))/2 with m = 1e-3 keeps a mu that falls below nought at small I positive, so
/// that the law dissipates at any I; moves mu = 0.2 by 5e-6.
Friction kept_positive(double mu, double slope);

/// mu = a + b ln I, kept positive.
struct LogLaw {
  double a = 0;
  double b = 0;
  Friction friction(double I) const;
};

/// mu = a + b ln I + c I, kept positive.
struct LogLinearLaw {
  double a = 0;
  double b = 0;
  double c = 0;
  Friction friction(double I) const;
};

/// Jop, Forterre & Pouliquen, Nature 441 (2006): mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1).
struct SaturatingLaw {
  double mu_s = 0;
  double mu_2 = 0;
  double I_0 = 0;
  Friction friction(double I) const;
};

/// The same friction at every rate: Drucker and Prager's plasticity.
struct ConstantLaw {
  double mu = 0;
  Friction friction(double I) const;
};

/// mu over ln I through the points of a table: MonotoneCubic between them, and outside straight in ln I as
/// the two outermost points say, so that mu goes on growing as a logarithm does (a table that ended level
/// would be ill-posed there); kept positive.
class TabulatedLaw {
 public:
  /// I ascending, mu growing, two points at least.
  TabulatedLaw(const std::vector<double>& I, std::vector<double> mu);
  Friction friction(double I) const;

 private:
  MonotoneCubic mu_of_ln_I_;
};

}  // namespace drumlin
