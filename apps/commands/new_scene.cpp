// drumlin new: a commented scene of grains, or of a flow, to start from.
#include <fmt/format.h>

#include <algorithm>

#include "apps/command_line/command.hpp"
#include "apps/commands/scene_templates.hpp"
#include "apps/output/next_step.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

struct NewSceneOptions {
  std::string kind;
  fs::path output;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    std::vector<std::string> kinds;
    for (const SceneTemplate& one : all_scene_templates()) kinds.emplace_back(one.name);
    d.add("kind", kind, "KIND", one_of(kinds), "What flows: of grains, or with -flow as a continuum")
        .required();
    d.output(output, "SCENE.toml", "File for the scene");
    d.overwrite(existing, "Replaces a file that is there");
  }
};

/// Whether a name can stand in a comment, and in a command that somebody copies from it.
bool is_plain(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || c == '/';
  });
}

/// The template with the file's own name in the commands of its head.
std::string named(std::string_view text, const std::string& file) {
  constexpr std::string_view placeholder = "THIS.toml";
  std::string result(text);
  if (!is_plain(file)) return result;
  for (std::size_t at = result.find(placeholder); at != std::string::npos;
       at = result.find(placeholder, at + file.size()))
    result.replace(at, placeholder.size(), file);
  return result;
}

int new_scene(const NewSceneOptions& options) {
  const auto& known = all_scene_templates();
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const SceneTemplate& one) { return one.name == options.kind; });
  const FolderLock lock = prepare_output_file(options.output, options.existing);
  replace_file(options.output, named(found->text, options.output.string()));
  const bool is_flow = options.kind.ends_with("-flow");
  print_out(fmt::format("{}: a commented {}scene\n", options.output.string(), is_flow ? "flow " : "") +
            next_step(is_flow ? "new flow" : "new", Flowing::open, Verdict::done, options.output.string()));
  return static_cast<int>(ExitCode::done);
}

}  // namespace

Command new_scene_command() {
  return command("new", "Writes a commented scene of grains or of a flow to start from", new_scene);
}

}  // namespace drumlin::apps
