#pragma once
// mu = a + b ln I, kept positive.
#include <array>

#include "coupling/core/law/form.hpp"

namespace drumlin {

struct LogLaw {
  static constexpr const char *name = "log", *sentence = "mu = a + b ln I, natural logarithm.";

  double a = 0;
  double b = 0;
  std::array<double, 3> covariance{0, 0, 0};  ///< var(a), cov(a, b), var(b)
  double I_min = 0;
  double I_max = 0;

  FrictionValue friction(double I) const { return kept_positive(a + b * std::log(I), b); }
  std::vector<double> coefficients() const { return {a, b}; }
  std::array<double, 2> influence(double I) const {
    const double slope = positivity_slope(friction(I).mu);
    return {slope, slope * std::log(I)};
  }
  LogLaw with(std::span<const double> c) const { return {c[0], c[1], covariance, I_min, I_max}; }
  std::string words() const { return "mu = " + in_words(a) + " + " + in_words(b) + " ln I"; }
  std::vector<FormFault> faults() const {
    std::vector<FormFault> faults = faults_of_fit(a + b * std::log(I_max), I_min, I_max);
    if (b < 0) faults.push_back({"b", mu_falls, ">= 0"});
    const auto& [var_a, cov_ab, var_b] = covariance;
    // The tolerance lets a covariance pass whose parts were rounded when it was written by hand.
    if (var_a < 0 || var_b < 0 || cov_ab * cov_ab > var_a * var_b * (1 + 1e-6))
      faults.push_back(
          {"covariance", "is no covariance", "var(a) >= 0, var(b) >= 0, cov^2 <= var(a) var(b)"});
    return faults;
  }
};

template <class Visitor>
void describe(Visitor& v, LogLaw& t) {
  v.value("a", t.a, required("", at_least(-10, 10), "Friction at I = 1."));
  v.value("b", t.b, required("", at_least(-10, 10), "Growth of the friction with ln I, not negative."));
  v.value("covariance", t.covariance, required("", at_least(-100, 100), "var(a), cov(a, b), var(b)."));
  describe_range(v, t);
}

}  // namespace drumlin
