#pragma once
// The law of the friction: every form of it, and the one evaluation that calibration, continuum and figures
// share.
#include <cassert>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/law/cohesive_law.hpp"
#include "coupling/core/law/constant_law.hpp"
#include "coupling/core/law/jop_law.hpp"
#include "coupling/core/law/log_law.hpp"
#include "coupling/core/law/log_linear_law.hpp"
#include "coupling/core/law/tabulated_law.hpp"

namespace drumlin {

/// The one list of the forms (coupling/core/law/form.hpp says what a form is). Code that evaluates a law at
/// many points visits it once.
using FrictionLaw = std::variant<LogLaw, LogLinearLaw, ConstantLaw, JopLaw, TabulatedLaw, CohesiveLaw>;

/// The shear strength, with I = 2|D|/sqrt(p); p > 0 and |D| > 0 are the caller's regularised values (p =
/// sigma_zz where k = 1).
template <class Law>
Strength strength(const Law& law, double rate, double pressure) {
  assert(rate > 0 && pressure > 0);
  if constexpr (OfInertialNumber<Law>) {
    const FrictionValue f = law.friction(2 * rate / std::sqrt(pressure));
    return {f.mu * pressure, f.slope * pressure / rate, f.mu - 0.5 * f.slope};
  } else {
    return law.strength(rate, pressure);
  }
}

/// mu and I dmu/dI at I > 0. Throws InputError where the pressure decides, too.
FrictionValue friction_at(const FrictionLaw& law, double I);

/// mu_s, the friction below which the material of such a law stands still. Absent for a law that creeps at
/// any stress (logarithms, tables).
std::optional<double> threshold(const FrictionLaw& law);

/// Largest I that the friction was measured at; infinite for a form that is given, not fitted.
double largest_measured_I(const FrictionLaw& law);

/// The friction in words, for messages: "mu = 0.35 + 0.013 ln I".
std::string described(const FrictionLaw& law);

/// What does not hold between the keys of the law: none of one that grows, and of a fitted one that is
/// between 0.001 and 10 at the largest I.
std::vector<FormFault> faults_of(const FrictionLaw& law);

/// As files and commands call it: "log".
std::string name_of(const FrictionLaw& law);

/// One of each form that a fit determines, and their names.
std::vector<FrictionLaw> fitted_laws();
std::vector<std::string> fitted_names();

/// The numbers that tell a fitted law from others of its form; none of a form that is not fitted.
std::vector<double> coefficients_of(const FrictionLaw& law);
/// The same form with others, as many.
FrictionLaw with_coefficients(const FrictionLaw& law, std::span<const double> coefficients);

}  // namespace drumlin
