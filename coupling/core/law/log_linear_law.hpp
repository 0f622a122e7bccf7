#pragma once
// mu = a + b ln I + c I, kept positive: the logarithm of slow flow, and what fast flow adds.
#include <array>

#include "coupling/core/law/form.hpp"

namespace drumlin {

struct LogLinearLaw {
  static constexpr const char *name = "log-linear", *sentence = "mu = a + b ln I + c I.";

  double a = 0;
  double b = 0;
  double c = 0;
  double I_min = 0;
  double I_max = 0;

  FrictionValue friction(double I) const { return kept_positive(a + b * std::log(I) + c * I, b + c * I); }
  std::vector<double> coefficients() const { return {a, b, c}; }
  std::array<double, 3> influence(double I) const {
    const double slope = positivity_slope(friction(I).mu);
    return {slope, slope * std::log(I), slope * I};
  }
  LogLinearLaw with(std::span<const double> of) const { return {of[0], of[1], of[2], I_min, I_max}; }
  std::string words() const {
    return "mu = " + in_words(a) + " + " + in_words(b) + " ln I + " + in_words(c) + " I";
  }
  std::vector<FormFault> faults() const {
    std::vector<FormFault> faults = faults_of_fit(a + b * std::log(I_max) + c * I_max, I_min, I_max);
    if (b < 0) faults.push_back({"b", mu_falls, ">= 0"});
    if (c < 0) faults.push_back({"c", mu_falls, ">= 0"});
    return faults;
  }
};

template <class Visitor>
void describe(Visitor& v, LogLinearLaw& t) {
  v.value("a", t.a, required("", at_least(-10, 10), "Friction at I = 1 without the linear term."));
  v.value("b", t.b, required("", at_least(-10, 10), "Growth of the friction with ln I, not negative."));
  v.value("c", t.c, required("", at_least(-1e3, 1e3), "Growth of the friction with I, not negative."));
  describe_range(v, t);
}

}  // namespace drumlin
