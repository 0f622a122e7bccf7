#include "apps/commands/effects_text.hpp"

#include <algorithm>

namespace drumlin::apps {

std::string effects_text(const particles::Effects& effects) {
  std::string text;
  particles::each_effect(
      [&text]<class E>(const std::optional<E>& effect) {
        if (effect) text += (text.empty() ? "" : ", ") + std::string(E::name);
      },
      effects);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text.empty() ? "none" : text;
}

}  // namespace drumlin::apps
