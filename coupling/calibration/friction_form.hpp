#pragma once
// The forms of a law that a calibration fits, each a few coefficients; how a form is evaluated is the law's
// own affair (coupling/core/law): what is fitted and scored is what a flow computes with.
#include <cstddef>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/knot_influence.hpp"
#include "coupling/core/law/rheology_fit.hpp"
#include "coupling/core/law/stress_ratio.hpp"

namespace drumlin::coupling {

/// formula: mu, a law with an influence (coupling/core/law/form.hpp). The others are tables whose
/// coefficients are the value at the first knot and the growth from each knot to the next. table: mu, which
/// grows. stress_ratio: k over I. turn: k as well, fitted to the stress across the strain rate over the
/// pressure, (k - 1)/(k + 1), measured over 2|D|/sqrt(p).
enum class FormKind { formula, table, stress_ratio, turn };

struct FrictionForm {
  FormKind kind = FormKind::formula;
  FrictionLaw formula = LogLaw{};         ///< of a formula, with any coefficients
  std::vector<double> knots = {};         ///< of a table: inertial numbers, ascending, two at least
  std::vector<double> least_growth = {};  ///< of `table`, per unit of ln I and interval; empty: 1e-4
  double slope_besides = 0;               ///< of a law that adds to the table, per unit of ln I
  std::size_t size() const;               ///< number of coefficients
};

/// The name of its law; "stress-ratio", "turn".
std::string name_of(const FrictionForm& form);
/// A form of mu by the name of its law, a table without knots; throws InputError.
FrictionForm form_named(const std::string& name);
/// Every formula.
std::vector<FrictionForm> formulas();

using Coefficients = std::vector<double>;

/// A form with its coefficients, evaluated by the functions of coupling/core/law: the value over I, its
/// slope, and how it moves with each coefficient.
class FormCurve {
 public:
  FormCurve(const FrictionForm& form, const Coefficients& law);
  /// The value (mu; k; (k - 1)/(k + 1)) and I d/dI of it, at the inertial number that the form is over.
  CurvePoint at(double I) const;
  /// Derivatives of the value by each coefficient; of a table's limiter those of one side.
  void influence(double I, std::span<double> by_coefficient) const;

 private:
  struct Ratio {
    StressRatioLaw k;
    bool turn = false;  // the value is that of the turn
  };
  FormKind kind_;
  std::variant<FrictionLaw, Ratio> law_;
  std::vector<KnotInfluence> knots_;  // one of a table, else none
};

/// As FormCurve, for one value.
double friction(const FrictionForm& form, const Coefficients& law, double I);
/// I dmu/dI.
double friction_slope(const FrictionForm& form, const Coefficients& law, double I);

/// The table with its least growth raised where `law` is ill-posed in simple shear: there I mu'/mu lies below
/// the lower root y of 4 y^2 - 4 y + mu^2 (1 - y/2)^2 = 0 (Barker, Schaeffer, Bohorquez & Gray, J. Fluid
/// Mech. 779 (2015)), about mu^2/4. A flatter law has no flow that a mesh could resolve. `slope_besides` is
/// counted in, as in the margin that a flow states. What is no table of mu, or well-posed at each of its I,
/// comes back as it is.
FrictionForm well_posed_form(const FrictionForm& form, const Coefficients& law);

/// Intervals of a table of mu that are held at their least growth.
std::size_t held_intervals(const FrictionForm& form, const Coefficients& law);

/// Least value of a coefficient: a mu that falls with I has no steady flow. Minus infinity for mu itself, and
/// for all of a form that may fall.
double least_coefficient(const FrictionForm& form, std::size_t index);

/// Knots of a table: at most `per_decade` of them, with `least_points` points at least from each to the next,
/// from the smallest I to the largest.
std::vector<double> table_knots(std::vector<double> I, double per_decade = 2, std::size_t least_points = 6);

/// A form of mu as it crosses to the continuum; the covariance of the logarithm is that of `draws`.
FrictionLaw measured_friction(const FrictionForm& form, const Coefficients& law,
                              const std::vector<Coefficients>& draws, double I_min, double I_max);

/// k of `stress_ratio` or `turn` as it crosses to the continuum.
NormalStressRatio measured_stress_ratio(const FrictionForm& form, const Coefficients& law);

}  // namespace drumlin::coupling
