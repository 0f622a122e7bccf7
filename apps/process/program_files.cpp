#include "apps/process/program_files.hpp"

#include <fmt/format.h>

#include <optional>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// The folder as it lies in a build tree or where the program is installed, as seen from the program.
std::optional<fs::path> found_beside_program(const char* built, const char* installed) {
  for (const char* place : {built, installed})
    if (const fs::path found = (program_folder() / place).lexically_normal(); fs::is_directory(found))
      return found;
  return std::nullopt;
}

fs::path beside_program(const char* what, const char* built, const char* installed) {
  if (const auto found = found_beside_program(built, installed)) return *found;
  const fs::path program = program_folder();
  throw IoError(fmt::format("{}: are missing; neither {} nor {} is a folder", what,
                            (program / built).lexically_normal().string(),
                            (program / installed).lexically_normal().string()));
}

/// The scripts of a wheel, in the packages of the interpreter beside the program; none elsewhere. The folder
/// has that interpreter's version in its name.
std::optional<fs::path> figures_of_wheel() {
  const fs::path program = program_folder();
  std::error_code none;
  if (!fs::exists(program / "python3", none)) return std::nullopt;
  for (const auto& entry : fs::directory_iterator(program.parent_path() / "lib", none))
    if (const fs::path found = entry.path() / "site-packages/drumlin/figures"; fs::is_directory(found, none))
      return found;
  return std::nullopt;
}

}  // namespace

fs::path data_folder() { return beside_program("scenes and records", "data", DRUMLIN_DATA_FROM_PROGRAM); }

std::optional<fs::path> data_folder_if_any() {
  return found_beside_program("data", DRUMLIN_DATA_FROM_PROGRAM);
}

std::string shipped_scene(const std::string& name) {
  std::error_code none;
  if (fs::exists(name, none) || fs::path(name).has_parent_path()) return name;
  const fs::path scene = data_folder() / "scenes" / (name.ends_with(".toml") ? name : name + ".toml");
  return fs::exists(scene, none) ? scene.string() : name;
}

fs::path figures_folder() {
  if (const auto of_wheel = figures_of_wheel()) return *of_wheel;
  return beside_program("the scripts that draw figures", "python/drumlin/figures",
                        DRUMLIN_FIGURES_FROM_PROGRAM);
}

fs::path interpreter() {
  return figures_of_wheel() ? program_folder() / "python3" : fs::path(DRUMLIN_PYTHON);
}

}  // namespace drumlin::apps
