#pragma once
// What a form of the friction is, and what forms share.
//
// A form is one file of this folder and one line of coupling/core/law/friction_law.hpp. It holds a struct of
// the keys of the table [mu] of rheology.toml, describe() for these, and the members
//   name, sentence: as the file's reader shows them
//   faults(): what does not hold between the keys
//   words(): the law in messages
// the law itself, as one of
//   friction(I): mu and I dmu/dI, where the inertial number alone decides (OfInertialNumber)
//   strength(rate, p): the shear strength, where the pressure does, too
// and what of this it has
//   threshold(): mu_s, below which the material stands still
//   I_min, I_max: the range that it was fitted on
//   coefficients(), with(coefficients): what a fit determines, and the same form with others
//   influence(I): of a formula, derivatives of mu by each of them
#include <cmath>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/documents/key_spec.hpp"

namespace drumlin {

/// Friction coefficient at an inertial number I, and I dmu/dI.
struct FrictionValue {
  double mu = 0;
  double slope = 0;
};

/// Shear strength F(|D|, p) of a law and its slopes. F is the shear stress in simple shear, in rho0 g d.
struct Strength {
  double value = 0;
  double d_rate = 0;      ///< dF/d|D|
  double d_pressure = 0;  ///< dF/dp
};

/// mu -> (mu + sqrt(mu^2 + 4 m^2))/2 with m = 1e-3 keeps a mu that falls below nought at small I positive, so
/// that the law dissipates at any I; moves mu = 0.2 by 5e-6.
FrictionValue kept_positive(double mu, double slope);

/// Derivative of kept_positive(mu) by mu where its value is `kept`.
double positivity_slope(double kept);

/// What does not hold between the keys of a law: key within its table, what, and what is allowed.
struct FormFault {
  std::string key, what, allowed;
};
/// Why a law is refused whose mu falls with I.
extern const char* const mu_falls;

/// What a law may hold. Dense flows of any grains have mu of 0.1 to 1 at I of 1e-6 to 1; beyond these ranges
/// nothing flows as the equations say, and a solver would end without a reason.
inline Allowed friction_range() { return at_least(1e-3, 10); }
inline Allowed number_range() { return at_least(1e-12, 1e3); }

/// Faults of a fitted law that is mu at I_max. Below I_max it may fall to nothing, as the logarithm does.
std::vector<FormFault> faults_of_fit(double mu, double I_min, double I_max);

/// The keys of the range that a law was fitted on.
template <class Visitor, class Law>
void describe_range(Visitor& v, Law& t) {
  v.value("I_min", t.I_min, required("", number_range(), "Smallest inertial number of the fit."));
  v.value("I_max", t.I_max, required("", number_range(), "Largest inertial number of the fit."));
}

/// A number in a message: six digits at most.
std::string in_words(double number);

/// I alone decides over mu: k, memory and fluidity go with no other law.
template <class Law>
concept OfInertialNumber = requires(const Law& law) {
  law.friction(1.0);
};
template <class... Laws>
bool is_of_inertial_number(const std::variant<Laws...>& law) {
  return std::visit([]<class Law>(const Law&) { return OfInertialNumber<Law>; }, law);
}
template <class Law>
concept Fitted = requires(const Law& law) {
  law.coefficients();
};

}  // namespace drumlin
