#include "apps/process/program_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/suggestion.hpp"

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

/// What a wheel is installed with.
struct OfWheel {
  fs::path figures;
  fs::path interpreter;
};

/// Where a wheel was installed: below the folder of packages whose name has the interpreter's version
/// (lib/python3.11/site-packages; Debian's own Python: dist-packages). That interpreter stands beside the
/// program, or it is the system's, or PATH finds it.
std::optional<OfWheel> of_wheel() {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(program_folder().parent_path() / "lib", none)) {
    const fs::path name = entry.path().filename();
    if (!name.string().starts_with("python3.")) continue;
    for (const char* packages : {"site-packages", "dist-packages"})
      if (const fs::path figures = entry.path() / packages / "drumlin/figures";
          fs::is_directory(figures, none)) {
        for (const fs::path& folder : {program_folder(), fs::path("/usr/bin")})
          if (fs::exists(folder / name, none)) return OfWheel{figures, folder / name};
        return OfWheel{figures, name};
      }
  }
  return std::nullopt;
}

bool is_flow(const std::string& name) { return name.ends_with("-flow"); }

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::ranges::binary_search(names, name);
}

std::vector<std::string> names_in(const char* folder,
                                  const std::function<bool(const std::string&)>& is_wanted) {
  std::vector<std::string> names;
  std::error_code none;
  if (const auto data = data_folder_if_any())
    for (const auto& file : fs::directory_iterator(*data / folder, none))
      if (const std::string name = file.path().stem().string();
          file.path().extension() == ".toml" && is_wanted(name))
        names.push_back(name);
  std::ranges::sort(names);
  return names;
}

/// Those that stand for the same drum or packing: one name begins with the other.
std::string beside(const std::string& name, const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& other : names)
    if (name.starts_with(other + "-") || other.starts_with(name + "-")) found.push_back(other);
  return found.empty() ? "" : fmt::format("; its other side: {}", fmt::join(found, ", "));
}

/// `of_another_kind`: why a shipped file of that name is none of these; empty if it is.
std::string shipped(
    const std::string& name, const char* folder, const std::vector<std::string>& names, const char* what,
    const std::function<std::string(const std::string&)>& of_another_kind = [](auto&) { return ""; }) {
  std::error_code none;
  const bool is_file = fs::exists(name, none) && !fs::is_directory(name, none);
  if (is_file || fs::path(name).has_parent_path()) return name;
  const std::string stem = name.ends_with(".toml") ? name.substr(0, name.size() - 5) : name;
  if (is_one_of(stem, names)) return (data_folder() / folder / (stem + ".toml")).string();
  const std::string other = of_another_kind(stem);
  if (!other.empty()) throw InputError(name + ": " + other);
  if (fs::exists(name, none)) return name;
  throw InputError(fmt::format("{}: is no file, and no {} of that name is shipped{}", name, what,
                               suggestion(stem, names)));
}

}  // namespace

fs::path data_folder() { return beside_program("scenes and records", "data", DRUMLIN_DATA_FROM_PROGRAM); }

std::optional<fs::path> data_folder_if_any() {
  return found_beside_program("data", DRUMLIN_DATA_FROM_PROGRAM);
}

std::vector<std::string> shipped_scenes() {
  return names_in("scenes", [](auto& name) { return !is_flow(name); });
}
std::vector<std::string> shipped_flow_scenes() { return names_in("scenes", is_flow); }
std::vector<std::string> shipped_laws() {
  return names_in("rheology", [](auto&) { return true; });
}

std::string shipped_scene(const std::string& name) {
  return shipped(name, "scenes", shipped_scenes(), "scene of particles", [&](const std::string& stem) {
    return is_flow(stem) ? "is a scene of the continuum, for drumlin flow" + beside(stem, shipped_scenes())
                         : "";
  });
}

std::string shipped_flow_scene(const std::string& name) {
  return shipped(name, "scenes", shipped_flow_scenes(), "flow scene", [](const std::string& stem) {
    return is_one_of(stem, shipped_scenes())
               ? "is a scene of particles, for drumlin run" + beside(stem, shipped_flow_scenes())
               : "";
  });
}

std::string shipped_scene_of_any_kind(const std::string& name) {
  return shipped(name, "scenes", names_in("scenes", [](auto&) { return true; }), "scene");
}

std::string shipped_law(const std::string& name) { return shipped(name, "rheology", shipped_laws(), "law"); }

fs::path program_beside(const std::string& name) {
  const fs::path program = program_folder() / name;
  if (!fs::exists(program))
    throw InputError(
        program.string() +
        ": is missing: the continuum and runs on ranks need deal.II, PETSc and MPI, which a wheel does not "
        "hold; install Debian's libdeal.ii-dev and libhdf5-openmpi-dev and build from source (target "
        "programs, DRUMLIN_CONTINUUM=ON), or install the project's Debian package (docs/install.md)");
  return program;
}

fs::path figures_folder() {
  if (const auto wheel = of_wheel()) return wheel->figures;
  return beside_program("the scripts that draw figures", "python/drumlin/figures",
                        DRUMLIN_FIGURES_FROM_PROGRAM);
}

fs::path interpreter() {
  const auto wheel = of_wheel();
  return wheel ? wheel->interpreter : fs::path(DRUMLIN_PYTHON);
}

}  // namespace drumlin::apps
