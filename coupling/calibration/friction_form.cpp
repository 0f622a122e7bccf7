#include "coupling/calibration/friction_form.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::coupling {
namespace {

// A table that stands still would not say how fast its flow is: the growth of mu per unit of ln I that is
// left then.
constexpr double standing_growth = 1e-4;

double interval_of(const FrictionForm& form, std::size_t j) {
  return std::log(form.knots[j + 1] / form.knots[j]);
}

std::array<double, 3> covariance_of(const std::vector<Coefficients>& draws) {
  std::array<double, 3> covariance{};
  if (draws.size() < 2) return covariance;
  double a = 0, b = 0;
  const auto count = static_cast<double>(draws.size());
  for (const Coefficients& draw : draws) {
    a += draw[0] / count;
    b += draw[1] / count;
  }
  for (const Coefficients& draw : draws) {
    covariance[0] += (draw[0] - a) * (draw[0] - a) / (count - 1);
    covariance[1] += (draw[0] - a) * (draw[1] - b) / (count - 1);
    covariance[2] += (draw[1] - b) * (draw[1] - b) / (count - 1);
  }
  return covariance;
}

std::vector<double> values_at_knots(const Coefficients& law) {
  std::vector<double> values(law.size());
  std::partial_sum(law.begin(), law.end(), values.begin());
  return values;
}

void put_influence(const FrictionLaw& law, double I, std::span<double> to) {
  std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.influence(I); }) std::ranges::copy(of.influence(I), to.begin());
      },
      law);
}

// (k - 1)/(k + 1) over 2|D|/sqrt(p), and what one of its derivatives by k at a fixed I is by k at fixed
// 2|D|/sqrt(p), where I moves with k.
struct TurnState {
  ShearState at;
  double gain = 1;      // d ln I/d ln(2|D|/sqrt(p))
  double by_ratio = 0;  // of the turn by k
};

TurnState turn_state(const StressRatioLaw& k, double rate_number) {
  const ShearState at = shear_state(k, 0.5 * rate_number, 1);
  const double share = 2 / (1 + at.k);
  return {at, 1 / (1 - 0.25 * share * at.k_slope), 0.5 * share * share};
}

// Least I dmu/dI of a law that is well-posed in simple shear where it has this mu.
double least_slope(double mu) {
  const double linear = 4 + mu * mu, square = 4 + mu * mu / 4;
  return mu * (linear - std::sqrt(linear * linear - 4 * square * mu * mu)) / (2 * square);
}

}  // namespace

std::size_t FrictionForm::size() const {
  return kind == FormKind::formula ? coefficients_of(formula).size() : knots.size();
}

FormCurve::FormCurve(const FrictionForm& form, const Coefficients& law) : kind_(form.kind) {
  if (kind_ != FormKind::formula) {
    std::vector<double> ln_I;
    for (const double I : form.knots) ln_I.push_back(std::log(I));
    knots_.emplace_back(
        std::move(ln_I), values_at_knots(law),
        kind_ == FormKind::table ? MonotoneCubic::Outside::goes_on : MonotoneCubic::Outside::level);
  }
  if (kind_ == FormKind::stress_ratio || kind_ == FormKind::turn)
    law_ = Ratio{stress_ratio_law(measured_stress_ratio(form, law)), kind_ == FormKind::turn};
  else
    law_ = measured_friction(form, law, {}, 0, 0);
}

CurvePoint FormCurve::at(double I) const {
  if (const auto* mu = std::get_if<FrictionLaw>(&law_)) {
    const FrictionValue at = friction_at(*mu, I);
    return {at.mu, at.slope};
  }
  const Ratio& ratio = std::get<Ratio>(law_);
  if (!ratio.turn) return ratio.k.at_ln(std::log(I));
  const TurnState state = turn_state(ratio.k, I);
  return {(state.at.k - 1) / (state.at.k + 1), state.by_ratio * state.at.k_slope * state.gain};
}

void FormCurve::influence(double I, std::span<double> by_coefficient) const {
  if (kind_ == FormKind::formula) return put_influence(std::get<FrictionLaw>(law_), I, by_coefficient);
  double factor = 1, ln_I = std::log(I);
  if (const auto* mu = std::get_if<FrictionLaw>(&law_)) {
    factor = positivity_slope(friction_at(*mu, I).mu);
  } else if (const Ratio& ratio = std::get<Ratio>(law_); ratio.turn) {
    const TurnState state = turn_state(ratio.k, I);
    factor = state.by_ratio * state.gain;
    ln_I = std::log(state.at.I);
  }
  knots_.front().at(ln_I, by_coefficient);
  // A coefficient lifts its own knot and all beyond it.
  for (std::size_t j = by_coefficient.size(); j-- > 1;) by_coefficient[j - 1] += by_coefficient[j];
  for (double& entry : by_coefficient) entry *= factor;
}

double friction(const FrictionForm& form, const Coefficients& law, double I) {
  return FormCurve(form, law).at(I).value;
}

double friction_slope(const FrictionForm& form, const Coefficients& law, double I) {
  return FormCurve(form, law).at(I).slope;
}

double least_coefficient(const FrictionForm& form, std::size_t index) {
  if (index == 0 || form.kind == FormKind::stress_ratio || form.kind == FormKind::turn)
    return -std::numeric_limits<double>::infinity();
  if (form.kind != FormKind::table) return 0;
  const double growth = form.least_growth.empty() ? standing_growth : form.least_growth[index - 1];
  return growth * interval_of(form, index - 1);
}

FrictionForm well_posed_form(const FrictionForm& form, const Coefficients& law) {
  if (form.kind != FormKind::table) return form;
  FrictionForm constrained = form;
  bool flat = false;
  constrained.least_growth.resize(form.knots.size() - 1, standing_growth);
  const FormCurve curve(form, law);
  for (std::size_t j = 0; j + 1 < form.knots.size(); ++j) {
    constexpr int places = 40;
    double lacks = 0;  // largest quotient of the slope that is needed and that of the curve
    double needed = 0;
    for (int i = 0; i <= places; ++i) {
      const double share = static_cast<double>(i) / places;
      const CurvePoint at = curve.at(form.knots[j] * std::pow(form.knots[j + 1] / form.knots[j], share));
      const double least = least_slope(at.value) - form.slope_besides;
      needed = std::max(needed, least);
      lacks = std::max(lacks, least / at.slope);
    }
    // Inside an interval the cubic is half as steep as its chord at least; what its ends lack beside a flat
    // neighbour is the neighbour's to mend. One per cent more: the curve may be flatter between two places.
    const double chord = law[j + 1] / interval_of(form, j);
    const double raised = 1.01 * std::min(lacks * chord, 2 * needed);
    if (lacks <= 1 || raised <= chord) continue;
    constrained.least_growth[j] = raised;
    flat = true;
  }
  return flat ? constrained : form;
}

std::size_t held_intervals(const FrictionForm& form, const Coefficients& law) {
  std::size_t held = 0;
  for (std::size_t j = 1; j < law.size(); ++j)
    held += form.kind == FormKind::table && law[j] <= least_coefficient(form, j) * (1 + 1e-9);
  return held;
}

std::vector<double> table_knots(std::vector<double> I, double per_decade, std::size_t least_points) {
  std::sort(I.begin(), I.end());
  if (I.size() < 2 * least_points || !(I.front() > 0) || !(I.front() < I.back()))
    throw InputError("a table of mu(I) needs at least " + std::to_string(2 * least_points) +
                     " points of different positive I, there are " + std::to_string(I.size()));
  const double step = std::log(10.0) / per_decade;
  std::vector<double> knots{I.front()};
  std::size_t first = 0;
  for (std::size_t i = 0; i + 1 < I.size(); ++i) {
    const bool far = std::log(I[i] / knots.back()) >= step;
    const bool enough = i - first >= least_points && I.size() - i > least_points;
    if (!far || !enough) continue;
    knots.push_back(I[i]);
    first = i;
  }
  // What is left above the last knot is an interval of its own, or joins the one below.
  if (knots.size() > 1 && std::log(I.back() / knots.back()) < step / 2) knots.pop_back();
  knots.push_back(I.back());
  return knots;
}

FrictionLaw measured_friction(const FrictionForm& form, const Coefficients& law,
                              const std::vector<Coefficients>& draws, double I_min, double I_max) {
  if (form.kind != FormKind::formula) return TabulatedLaw(form.knots, values_at_knots(law));
  return std::visit(
      [&]<class Law>(Law of) -> FrictionLaw {
        if constexpr (Fitted<Law>) of = of.with(law);
        if constexpr (requires { of.covariance; }) of.covariance = covariance_of(draws);
        if constexpr (requires { of.I_min; }) of.I_min = I_min, of.I_max = I_max;
        return of;
      },
      form.formula);
}

NormalStressRatio measured_stress_ratio(const FrictionForm& form, const Coefficients& law) {
  return {form.knots, values_at_knots(law)};
}

std::string name_of(const FrictionForm& form) {
  if (form.kind == FormKind::formula) return name_of(form.formula);
  return form.kind == FormKind::table  ? TabulatedLaw::name
         : form.kind == FormKind::turn ? "turn"
                                       : "stress-ratio";
}

FrictionForm form_named(const std::string& name) {
  for (const FrictionLaw& law : fitted_laws())
    if (name == name_of(law))
      return {std::holds_alternative<TabulatedLaw>(law) ? FormKind::table : FormKind::formula, law};
  throw InputError(
      fmt::format("no form of mu(I) is named \"{}\" (allowed: {})", name, fmt::join(fitted_names(), ", ")));
}

std::vector<FrictionForm> formulas() {
  std::vector<FrictionForm> forms;
  for (const std::string& name : fitted_names())
    if (const FrictionForm form = form_named(name); form.kind == FormKind::formula) forms.push_back(form);
  return forms;
}

}  // namespace drumlin::coupling
