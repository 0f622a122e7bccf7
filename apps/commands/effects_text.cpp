#include "apps/commands/effects_text.hpp"

namespace drumlin::apps {

std::string effects_text(const particles::Effects& effects) {
  std::string text;
  const auto add = [&text](bool acts, const char* name) {
    if (acts) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  add(effects.gravity.has_value(), "gravity");
  add(effects.friction.has_value(), "friction");
  add(effects.restitution.has_value(), "restitution");
  add(effects.spin.has_value(), "spin");
  add(effects.rolling_resistance.has_value(), "rolling resistance");
  add(effects.cohesion.has_value(), "cohesion");
  add(effects.rotating_frame.has_value(), "rotating frame");
  return text.empty() ? "none" : text;
}

}  // namespace drumlin::apps
