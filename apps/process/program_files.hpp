#pragma once
// Files that the programs use and do not hold: found from the place of the running program, in a build tree
// as where it is installed, so that an installed tree may be moved.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::apps {

/// Scenes, laws, records and the paper's numbers. Throws IoError where there are none.
std::filesystem::path data_folder();
std::optional<std::filesystem::path> data_folder_if_any();
/// Names of shipped files without ".toml", sorted: of data/scenes but for flows, of its flows, of
/// data/rheology.
std::vector<std::string> shipped_scenes();
std::vector<std::string> shipped_flow_scenes();
std::vector<std::string> shipped_laws();
/// The shipped file of that name, with or without ".toml", where no file has it; a folder does not count. A
/// name with a folder stands for itself. Throws InputError with what may have been meant where there is
/// neither.
std::string shipped_scene(const std::string& name);
std::string shipped_flow_scene(const std::string& name);
std::string shipped_law(const std::string& name);
std::string shipped_scene_of_any_kind(const std::string& name);
/// The program of this name in the folder of the running one. Throws InputError, which says what to install,
/// if it is missing: the continuum is not built everywhere.
std::filesystem::path program_beside(const std::string& name);
/// The Python scripts that draw; the templates of pages stand beside it. Throws IoError likewise.
std::filesystem::path figures_folder();
/// The Python that draws: that of the wheel which the program is of, else the one of the build.
std::filesystem::path interpreter();

}  // namespace drumlin::apps
