#pragma once
// Jop, Forterre & Pouliquen, Nature 441 (2006): mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1).
#include <algorithm>
#include <array>
#include <optional>

#include "coupling/core/law/form.hpp"

namespace drumlin {

struct JopLaw {
  static constexpr const char *name = "jop", *sentence = "mu_s + (mu_2 - mu_s)/(I_0/I + 1).";

  double mu_s = 0;
  double mu_2 = 0;
  double I_0 = 0;
  std::optional<double> I_min = {}, I_max = {};  ///< absent: given, not fitted

  FrictionValue friction(double I) const {
    const double share = I / (I_0 + I);
    return {mu_s + (mu_2 - mu_s) * share, (mu_2 - mu_s) * share * I_0 / (I_0 + I)};
  }
  double threshold() const { return mu_s; }
  std::vector<double> coefficients() const { return {mu_s, mu_2 - mu_s, I_0}; }
  /// Where mu stands still that of a small growth, for I_0 would move nothing.
  std::array<double, 3> influence(double I) const {
    const double share = I / (I_0 + I);
    return {1, share, -std::max(mu_2 - mu_s, 1e-9) * share / (I_0 + I)};
  }
  JopLaw with(std::span<const double> c) const { return {c[0], c[0] + c[1], c[2], I_min, I_max}; }
  std::string words() const {
    return "mu = " + in_words(mu_s) + " + " + in_words(mu_2 - mu_s) + "/(" + in_words(I_0) + "/I + 1)";
  }
  std::vector<FormFault> faults() const {
    std::vector<FormFault> faults;
    if (mu_2 < mu_s) faults.push_back({"mu_2", mu_falls, ">= mu_s"});
    if (!(friction_range().holds(mu_s) && friction_range().holds(mu_2) && number_range().holds(I_0)))
      faults.push_back({"mu_2", "lies with mu_s and I_0 out of range", "0.001 to 10, I_0 of 1e-12 to 1000"});
    if (I_min && I_max && !(*I_min < *I_max)) faults.push_back({"I_max", "is not above I_min", "> I_min"});
    return faults;
  }
};

template <class Visitor>
void describe(Visitor& v, JopLaw& t) {
  v.value("mu_s", t.mu_s, required("", friction_range(), "Friction for I -> 0."));
  v.value("mu_2", t.mu_2, required("", friction_range(), "Friction for I -> infinity, not below mu_s."));
  v.value("I_0", t.I_0, required("", number_range(), "Inertial number half way between the two."));
  v.value("I_min", t.I_min, when_given("", number_range(), "Smallest inertial number of the fit."));
  v.value("I_max", t.I_max, when_given("", number_range(), "Largest inertial number of the fit."));
}

}  // namespace drumlin
