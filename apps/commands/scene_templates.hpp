#pragma once
// The commented scenes of data/templates as they stood when the program was built.
#include <string_view>
#include <vector>

namespace drumlin::apps {

struct SceneTemplate {
  std::string_view name, text;
};

/// All of them, by name.
const std::vector<SceneTemplate>& all_scene_templates();

}  // namespace drumlin::apps
