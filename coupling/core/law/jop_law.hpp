#pragma once
// Jop, Forterre & Pouliquen, Nature 441 (2006): mu = mu_s + (mu_2 - mu_s)/(I_0/I + 1).
#include "coupling/core/law/form.hpp"

namespace drumlin {

struct JopLaw {
  static constexpr const char *name = "jop", *sentence = "mu_s + (mu_2 - mu_s)/(I_0/I + 1).";

  double mu_s = 0;
  double mu_2 = 0;
  double I_0 = 0;

  FrictionValue friction(double I) const {
    const double share = I / (I_0 + I);
    return {mu_s + (mu_2 - mu_s) * share, (mu_2 - mu_s) * share * I_0 / (I_0 + I)};
  }
  double threshold() const { return mu_s; }
  std::string words() const {
    return "mu = " + in_words(mu_s) + " + " + in_words(mu_2 - mu_s) + "/(" + in_words(I_0) + "/I + 1)";
  }
  std::vector<FormFault> faults() const {
    if (mu_2 < mu_s) return {{"mu_2", mu_falls, ">= mu_s"}};
    return {};
  }
};

template <class Visitor>
void describe(Visitor& v, JopLaw& t) {
  v.value("mu_s", t.mu_s, required("", friction_range(), "Friction for I -> 0."));
  v.value("mu_2", t.mu_2, required("", friction_range(), "Friction for I -> infinity, not below mu_s."));
  v.value("I_0", t.I_0, required("", number_range(), "Inertial number half way between the two."));
}

}  // namespace drumlin
