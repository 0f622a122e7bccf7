#pragma once
// The same friction at every rate: Drucker and Prager's plasticity.
#include "coupling/core/law/form.hpp"

namespace drumlin {

struct ConstantLaw {
  static constexpr const char *name = "constant", *sentence = "The same mu at every I.";

  double mu = 0;

  FrictionValue friction(double /*I*/) const { return {mu, 0}; }
  double threshold() const { return mu; }
  std::string words() const { return "mu = " + in_words(mu); }
  std::vector<FormFault> faults() const { return {}; }
};

template <class Visitor>
void describe(Visitor& v, ConstantLaw& t) {
  v.value("mu", t.mu, required("", friction_range(), "Friction at every inertial number."));
}

}  // namespace drumlin
