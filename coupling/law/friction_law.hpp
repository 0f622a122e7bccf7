#pragma once
// mu(I) and its derivative: the one evaluation that calibration, continuum and figures share.
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "coupling/law/monotone_cubic.hpp"
#include "coupling/law/rheology_fit.hpp"

namespace drumlin {

/// Friction coefficient at an inertial number I, and I dmu/dI.
struct FrictionValue {
  double mu = 0;
  double slope = 0;
};

/// mu -> (mu + sqrt(mu^2 + 4 m^2))/2 with m = 1e-3 keeps a mu that falls below nought at small I positive, so
/// that the law dissipates at any I; moves mu = 0.2 by 5e-6.
FrictionValue kept_positive(double mu, double slope);

/// Derivative of kept_positive(mu) by mu where its value is `kept`.
double positivity_slope(double kept);

/// mu = a + b ln I, kept positive.
struct LogLaw {
  double a = 0;
  double b = 0;
  FrictionValue friction(double I) const;
};

/// mu = a + b ln I + c I, kept positive.
struct LogLinearLaw {
  double a = 0;
  double b = 0;
  double c = 0;
  FrictionValue friction(double I) const;
};

/// Jop, Forterre & Pouliquen, Nature 441 (2006): mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1).
struct SaturatingLaw {
  double mu_s = 0;
  double mu_2 = 0;
  double I_0 = 0;
  FrictionValue friction(double I) const;
};

/// The same friction at every rate: Drucker and Prager's plasticity.
struct ConstantLaw {
  double mu = 0;
  FrictionValue friction(double I) const;
};

/// mu over ln I through the points of a table: MonotoneCubic between them, and outside straight in ln I as
/// the two outermost points say, so that mu goes on growing as a logarithm does (a table that ended level
/// would be ill-posed there); kept positive.
class TabulatedLaw {
 public:
  /// How mu goes on above the last point, straight as the last two say.
  enum class Beyond { straight_in_ln_I, straight_in_I };
  /// I ascending, mu growing, two points at least.
  TabulatedLaw(const std::vector<double>& I, const std::vector<double>& mu,
               Beyond beyond = Beyond::straight_in_ln_I);
  FrictionValue friction(double I) const;

 private:
  MonotoneCubic mu_of_ln_I_;
  double straight_from_;  // I; infinite: nowhere
};

/// Every form of mu(I) that a file can hold. Code that evaluates a law at many points visits it once.
using FrictionLaw = std::variant<LogLaw, LogLinearLaw, SaturatingLaw, ConstantLaw, TabulatedLaw>;

/// What evaluates the law of a file (or of a calibration).
FrictionLaw friction_law(const MeasuredFriction& mu);

/// A friction of one's own as a table, `per_decade` points to a decade of I. A flow evaluates the table:
/// between its points and beyond them it is TabulatedLaw. Throws InputError where mu is not positive, finite
/// and growing, or the range is none.
FrictionTable sampled_friction(const std::function<double(double)>& mu, double I_min, double I_max,
                               int per_decade = 8);

/// mu and I dmu/dI at I > 0.
FrictionValue friction_at(const FrictionLaw& law, double I);

/// mu_s, the friction below which the material of such a law stands still: of Jop's form and of a constant.
/// Absent for a law that creeps at any stress (logarithms, tables).
std::optional<double> threshold(const FrictionLaw& law);

}  // namespace drumlin
