#include "apps/support/program_files.hpp"

#include <fmt/format.h>

#include "coupling/common/errors.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

/// The folder as it lies in a build tree or where the program is installed, as seen from the program.
fs::path beside_program(const char* what, const char* built, const char* installed) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {built, installed})
    if (const fs::path found = (program / place).lexically_normal(); fs::is_directory(found)) return found;
  throw IoError(fmt::format("{}: are missing; neither {} nor {} is a folder", what,
                            (program / built).lexically_normal().string(),
                            (program / installed).lexically_normal().string()));
}

}  // namespace

fs::path data_folder() { return beside_program("scenes and records", "data", DRUMLIN_DATA_FROM_PROGRAM); }

std::string shipped_scene(const std::string& name) {
  std::error_code none;
  if (fs::exists(name, none) || fs::path(name).has_parent_path()) return name;
  const fs::path scene = (data_folder() / "scenes" / name).replace_extension(".toml");
  return fs::exists(scene, none) ? scene.string() : name;
}

fs::path figures_folder() {
  // A wheel is installed beside the interpreter, whose version its folder names.
  const fs::path libraries = fs::read_symlink("/proc/self/exe").parent_path() / "../lib";
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(libraries, none))
    if (const fs::path found = entry.path() / "site-packages/drumlin/figures"; fs::is_directory(found, none))
      return found.lexically_normal();
  return beside_program("the scripts that draw figures", "python/drumlin/figures",
                        DRUMLIN_FIGURES_FROM_PROGRAM);
}

fs::path interpreter() {
  const fs::path beside = fs::read_symlink("/proc/self/exe").parent_path() / "python3";
  return fs::exists(beside) ? beside : fs::path(DRUMLIN_PYTHON);
}

}  // namespace drumlin::apps
