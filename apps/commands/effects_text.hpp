#pragma once
#include <string>

#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// "gravity, friction, spin": the effects that a scene names; "none" without any.
std::string effects_text(const particles::Effects& effects);

}  // namespace drumlin::apps
