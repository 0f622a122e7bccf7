#pragma once
// The forms of mu(I) that a calibration chooses from: each a sum of coefficients times functions of I.
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "coupling/exchange/rheology_fit.hpp"

namespace drumlin {

enum class FormKind { log, log_linear, table };

/// log: mu = c0 + c1 ln I. log_linear: c0 + c1 ln I + c2 I. table: mu at the first knot, then what it grows
/// by from each knot to the next; straight in ln I between them, and beyond the two ends as next to them.
struct FrictionForm {
  FormKind kind = FormKind::log;
  std::vector<double> knots;              ///< of a table: inertial numbers, ascending, two at least
  bool growing = true;                    ///< false: of something else than mu, which may fall with I
  std::vector<double> least_growth = {};  ///< of a table, per unit of ln I and interval; empty: 1e-4
  std::size_t size() const;               ///< number of coefficients
};

using Coefficients = std::vector<double>;

/// Functions of I that the coefficients multiply.
std::vector<double> functions_at(const FrictionForm& form, double I);
double friction(const FrictionForm& form, const Coefficients& law, double I);
/// I dmu/dI.
double friction_slope(const FrictionForm& form, const Coefficients& law, double I);

/// The table with the least growth that keeps a law well-posed in simple shear where mu is that of `law`: y =
/// I mu'/mu at the lower root of 4 y^2 - 4 y + mu^2 (1 - y/2)^2 = 0 (Barker, Schaeffer, Bohorquez & Gray, J.
/// Fluid Mech. 779 (2015)), about mu^3/4 per unit of ln I. A flatter law has no flow that a mesh could
/// resolve.
FrictionForm kept_well_posed(const FrictionForm& form, const Coefficients& law);

/// Intervals of a table that are held at their least growth.
std::size_t held_intervals(const FrictionForm& form, const Coefficients& law);

/// Least value of a coefficient: a mu that falls with I has no steady flow. Minus
/// infinity for mu itself, and for all of a form that need not grow.
double least_coefficient(const FrictionForm& form, std::size_t index);

/// Knots of a table: at most `per_decade` of them, with `least_points` points at least from each to the next,
/// from the smallest I to the largest.
std::vector<double> table_knots(std::vector<double> I, double per_decade = 2, std::size_t least_points = 6);

/// The law as it crosses to the continuum; the covariance of the logarithm is that of `draws`.
MeasuredFriction measured_friction(const FrictionForm& form, const Coefficients& law,
                                   const std::vector<Coefficients>& draws, double I_min, double I_max);

std::string name_of(FormKind kind);            ///< "log", "log-linear", "table"
FormKind form_named(const std::string& name);  ///< throws InputError

}  // namespace drumlin
