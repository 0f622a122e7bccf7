#pragma once
// Scene files (docs/formats/scene.md): read with all problems at once, written back resolved, listed key by
// key.
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/core/documents/key_lister.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Reads and validates. Throws InputError with every problem of the file and of the overrides
/// ("solver.max_sweeps=50").
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from a text; `name` stands for the file in messages, its folder for the file's.
Scene parse_scene(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides = {});

/// The scene with all its defaults as TOML. Reading it back gives the same scene to the last bit.
std::string scene_text(const Scene& scene);

/// Every key of a scene file, in the order of docs/formats/scene.md.
std::vector<KeyRow> scene_keys();

}  // namespace drumlin::particles
