#include "coupling/calibration/friction_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

// A table that stands still would not say how fast its flow is: the growth of mu per unit of ln I that is
// left then.
constexpr double least_growth = 1e-4;

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

}  // namespace

std::size_t FrictionForm::size() const {
  switch (kind) {
    case FormKind::log:
      return 2;
    case FormKind::log_linear:
      return 3;
    case FormKind::table:
      return knots.size();
  }
  return 0;
}

std::vector<double> functions_at(const FrictionForm& form, double I) {
  if (form.kind == FormKind::log) return {1, std::log(I)};
  if (form.kind == FormKind::log_linear) return {1, std::log(I), I};
  std::vector<double> functions(form.knots.size(), 0.0);
  functions[0] = 1;
  const std::size_t last = form.knots.size() - 2;
  for (std::size_t j = 0; j <= last; ++j) {
    const double share = std::log(I / form.knots[j]) / interval_of(form, j);
    const double low = j == 0 ? -std::numeric_limits<double>::infinity() : 0;
    const double high = j == last ? std::numeric_limits<double>::infinity() : 1;
    functions[j + 1] = std::clamp(share, low, high);
  }
  return functions;
}

double friction(const FrictionForm& form, const Coefficients& law, double I) {
  const std::vector<double> functions = functions_at(form, I);
  double mu = 0;
  for (std::size_t j = 0; j < functions.size(); ++j) mu += law[j] * functions[j];
  return mu;
}

double friction_slope(const FrictionForm& form, const Coefficients& law, double I) {
  if (form.kind == FormKind::log) return law[1];
  if (form.kind == FormKind::log_linear) return law[1] + law[2] * I;
  std::size_t j = 0;
  while (j + 2 < form.knots.size() && I > form.knots[j + 1]) ++j;
  return law[j + 1] / interval_of(form, j);
}

double least_coefficient(const FrictionForm& form, std::size_t index) {
  if (index == 0 || !form.growing) return -std::numeric_limits<double>::infinity();
  if (form.kind != FormKind::table) return 0;
  const double growth = form.least_growth.empty() ? least_growth : form.least_growth[index - 1];
  return growth * interval_of(form, index - 1);
}

FrictionForm kept_well_posed(const FrictionForm& form, const Coefficients& law) {
  FrictionForm kept = form;
  if (form.kind != FormKind::table || !form.growing) return kept;
  kept.least_growth.clear();
  for (std::size_t j = 0; j + 1 < form.knots.size(); ++j) {
    const double mu = friction(form, law, std::sqrt(form.knots[j] * form.knots[j + 1]));
    const double linear = 4 + mu * mu, square = 4 + mu * mu / 4;
    const double y = (linear - std::sqrt(linear * linear - 4 * square * mu * mu)) / (2 * square);
    kept.least_growth.push_back(std::max(least_growth, mu * y));
  }
  return kept;
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

MeasuredFriction measured_friction(const FrictionForm& form, const Coefficients& law,
                                   const std::vector<Coefficients>& draws, double I_min, double I_max) {
  if (form.kind == FormKind::log) return LogFriction{law[0], law[1], covariance_of(draws), I_min, I_max};
  if (form.kind == FormKind::log_linear) return LogLinearFriction{law[0], law[1], law[2], I_min, I_max};
  FrictionTable table{form.knots, {}};
  for (const double I : form.knots) table.mu.push_back(friction(form, law, I));
  return table;
}

std::string name_of(FormKind kind) {
  switch (kind) {
    case FormKind::log:
      return "log";
    case FormKind::log_linear:
      return "log-linear";
    case FormKind::table:
      return "table";
  }
  return "";
}

FormKind form_named(const std::string& name) {
  for (const FormKind kind : {FormKind::log, FormKind::log_linear, FormKind::table})
    if (name == name_of(kind)) return kind;
  throw InputError("no form of mu(I) is named \"" + name + "\" (allowed: log, log-linear, table)");
}

}  // namespace drumlin
