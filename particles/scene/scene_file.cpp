#include "particles/scene/scene_file.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "particles/scene/grain_list.hpp"
#include "particles/scene/scene_keys.hpp"
#include "particles/scene/validate.hpp"

namespace drumlin::particles {

namespace {

/// Whether one path is the other or stands below it.
bool touches(const std::string& a, const std::string& b) {
  const auto& [shorter, longer] = a.size() < b.size() ? std::pair(a, b) : std::pair(b, a);
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '.');
}

bool rests_on_a_problem(const SceneFault& fault, const std::vector<InputProblem>& problems) {
  return std::any_of(fault.about.begin(), fault.about.end(), [&](const std::string& path) {
    return std::any_of(problems.begin(), problems.end(),
                       [&](const InputProblem& problem) { return touches(path, problem.key); });
  });
}

/// Lists of grains and other runs count from the folder of the scene, wherever the program was started.
void resolve_paths(Scene& scene, const std::string& scene_name) {
  const auto folder = std::filesystem::absolute(std::filesystem::path(scene_name)).parent_path();
  const auto resolve = [&folder](std::filesystem::path& path) {
    if (!path.empty() && !path.is_absolute()) path = (folder / path).lexically_normal();
  };
  for (ListedGrains* list : lists_of(scene)) resolve(list->file);
  if (auto* other = std::get_if<GrainsOfRun>(&scene.grains.source)) resolve(other->run);
}

/// The problems inside lists of grains, which have places of their own.
void add_problems_of_lists(Scene& scene, std::vector<InputProblem>& problems) {
  for (const ListedGrains* list : lists_of(scene)) {
    if (std::error_code unknown; !std::filesystem::is_regular_file(list->file, unknown)) continue;
    try {
      (void)listed(*list);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
}

Scene scene_of(const Document& document) {
  std::vector<InputProblem> problems;
  Scene scene = read_keys<Scene>(document, problems);
  // Of a file of another version nothing was read that could contradict itself.
  if (document.root.find("format") && !problems.empty() && problems.front().key == "format")
    throw InputError(problems);
  resolve_paths(scene, document.file);
  scene.title =
      title_with_changes(scene.title, document,
                         {"output", "reduced", "solver.capture_unconverged", "solver.stop_when_unconverged"});
  const std::vector<InputProblem> key_problems = problems;
  for (const auto& fault : validate(scene))
    if (!rests_on_a_problem(fault, key_problems))
      problems.push_back(problem_at(document, fault.key, fault.what, fault.allowed));
  sort_by_place(problems);
  add_problems_of_lists(scene, problems);
  return accepted(std::move(scene), problems);
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return scene_of(read_toml(file, overrides));
}

Scene parse_scene(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides) {
  return scene_of(parse_toml(text, name, overrides));
}

std::string scene_text(const Scene& scene) { return toml_text(write_keys(scene)); }

std::vector<KeyRow> scene_keys() { return list_keys<Scene>(); }

}  // namespace drumlin::particles
