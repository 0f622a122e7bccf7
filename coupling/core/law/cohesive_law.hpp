#pragma once
// Grains that hold together: tau = c + (mu_s + b I) p. Where nothing presses on them they bear the shear c.
#include "coupling/core/law/form.hpp"

namespace drumlin {

struct CohesiveLaw {
  static constexpr const char *name = "cohesive", *sentence = "Shear strength c + (mu_s + b I) p.";

  double c = 0;
  double mu_s = 0;
  double b = 0;

  Strength strength(double rate, double p) const {
    const double root = std::sqrt(p), slope = 2 * b * root;  // I p = 2 |D| sqrt(p)
    return {c + mu_s * p + slope * rate, slope, mu_s + b * rate / root};
  }
  std::string words() const {
    return "mu = " + in_words(mu_s) + " + " + in_words(b) + " I + " + in_words(c) + "/p";
  }
  std::vector<FormFault> faults() const { return {}; }
};

template <class Visitor>
void describe(Visitor& v, CohesiveLaw& t) {
  v.value("c", t.c, required("rho0 g d", at_least(0, 100), "Shear strength at rest without pressure."));
  v.value("mu_s", t.mu_s, required("", friction_range(), "Growth of the strength at rest with p."));
  v.value("b", t.b, required("", at_least(0, 100), "Growth of mu with I."));
}

}  // namespace drumlin
