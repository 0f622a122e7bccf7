#pragma once
// Options of a command that check what they read: numbers within a range, paths, changes of a scene's keys.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/output/commands.hpp"
#include "coupling/core/documents/key_spec.hpp"

namespace CLI {
class App;
}

namespace drumlin::apps {

inline constexpr const char* keep_what_is_done = "Keeps what an earlier call has finished";

/// A number with its unit and range in the help, and held to that range; its value before is the default.
void add_number(CLI::App& command, const std::string& name, double& target, const std::string& unit,
                const Allowed& allowed, const std::string& sentence);
void add_number(CLI::App& command, const std::string& name, int& target, const std::string& unit,
                const Allowed& allowed, const std::string& sentence);
/// Numbers between commas, each held to the range.
void add_numbers(CLI::App& command, const std::string& name, std::vector<int>& target, const Allowed& allowed,
                 const std::string& sentence);
/// A number that may be absent.
void add_optional_number(CLI::App& command, const std::string& name, std::optional<double>& target,
                         const std::string& unit, const Allowed& allowed, const std::string& sentence);

/// A path that has to be given; `kind` stands for it in the help.
void add_folder_or_file(CLI::App& command, const std::string& name, std::filesystem::path& target,
                        const std::string& kind, const std::string& sentence);
/// The scene that a command reads: a file, or a shipped scene by its name (shipped_scene).
void add_scene_file(CLI::App& command, std::filesystem::path& target, const std::string& sentence);
/// A path that may be absent.
void add_optional_path(CLI::App& command, const std::string& name,
                       std::optional<std::filesystem::path>& target, const std::string& kind,
                       const std::string& sentence);

/// --set KEY=VALUE, repeatable.
void add_overrides(CLI::App& command, std::vector<std::string>& overrides);
/// --resume and --overwrite; without either an existing output is refused.
void add_existing(CLI::App& command, ExistingOutput& existing, const std::string& resume_sentence);
/// --accuracy COST.
void add_accuracy(CLI::App& command, std::optional<std::filesystem::path>& accuracy);

}  // namespace drumlin::apps
