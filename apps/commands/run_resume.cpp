#include "apps/commands/run_resume.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/commands/region_table.hpp"
#include "apps/commands/run_files.hpp"
#include "apps/commands/start_grains.hpp"
#include "apps/commands/wall_table.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_document.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/prolong.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

std::string snapshot_name(std::int64_t number) { return fmt::format("snapshots/{:06}.h5", number); }

void same_scene_or_refuse(const fs::path& output, const std::string& theirs, const std::string& ours) {
  if (theirs != ours)
    throw InputError(output.string() +
                     ": was made from another scene (compare its scene.toml with `drumlin scene show`); "
                     "use --overwrite to start over");
}

std::map<std::string, std::string> list_texts(particles::Scene scene) {
  const auto names = particles::grain_list_names(scene);
  std::map<std::string, std::string> texts;
  std::size_t k = 0;
  for (const auto* list : lists_of(scene))
    texts[names[k++]] = list->text ? *list->text : file_text(list->file);
  return texts;
}

void same_run_or_refuse(const fs::path& output, const particles::Scene& scene, const std::string& resolved) {
  std::map<std::string, std::string> texts = list_texts(scene);
  texts["scene.toml"] = resolved;
  for (const auto& [name, text] : texts)
    if (fs::exists(output / name)) same_scene_or_refuse(output, file_text(output / name), text);
}

bool is_finished(const fs::path& output, const particles::Scene& scene, const std::string& resolved) {
  if (!has_manifest(output) || read_manifest(output).command != "run" || !holds_results(output, "run.json"))
    return false;
  same_run_or_refuse(output, scene, resolved);
  // A lock is in use, or left by a killed call: then it goes.
  if (fs::exists(output / folder_lock_name)) FolderLock(output / folder_lock_name, "drumlin run");
  print_out(fmt::format("{}: already finished, nothing to do\n", output.string()));
  return true;
}

void cut_back(GrowingOutput& output, const std::optional<particles::Checkpoint>& from) {
  auto& files = output.manifest().files;
  std::map<std::string, ManifestEntry> entries;
  if (from) {
    for (std::int64_t number = 1; number <= from->state.snapshots; ++number) {
      const std::string name = snapshot_name(number);
      if (!files.contains(name))
        throw InputError(fmt::format("{}: is not listed in {}, and the checkpoint builds on it",
                                     (output.folder() / name).string(), manifest_name));
      entries[name] = files.at(name);
    }
    for (const auto& [name, entry] : files)
      if (!name.starts_with("snapshots/")) entries[name] = entry;
    for (const auto& [name, bytes] :
         {std::pair(log_name, from->log_bytes), std::pair(energy_name, from->energy_bytes),
          std::pair(wall_table_name, from->walls_bytes), std::pair(region_table_name, from->regions_bytes)}) {
      entries.erase(name);
      if (bytes > 0)
        entries[name] = {file_sum(output.folder() / name, static_cast<std::uint64_t>(bytes)), true};
    }
  }
  files = std::move(entries);
}

std::optional<particles::Checkpoint> checkpoint_in(const fs::path& output, const std::string& resolved) {
  // An interrupted --extend may leave a checkpoint of the longer scene beside one of the shorter.
  const auto read = [&](const fs::path& file) {
    particles::Checkpoint checkpoint = particles::read_checkpoint(file);
    same_scene_or_refuse(file, checkpoint.scene, resolved);
    return checkpoint;
  };
  auto last = last_whole_checkpoint(output, read);
  if (!last) return std::nullopt;
  if (!last->passed_over.empty()) {
    print_error(fmt::format("{}\ngoes on from {} instead\n", last->passed_over, previous_checkpoint_name));
    set_aside_passed_over_checkpoint(output);
  }
  return std::move(last->content);
}

void extend(GrowingOutput& output, double seconds, particles::Scene& scene,
            std::optional<particles::Checkpoint>& from) {
  if (!output.manifest().complete || !from)
    throw InputError(output.folder().string() + ": --extend takes a finished run; go on with --resume first");
  const double before = particles::duration_s(scene.stages.back());
  scene = particles::prolonged(scene, seconds, from->state);
  const double longer = particles::duration_s(scene.stages.back()) - before;
  if (std::abs(longer - seconds) > 1e-6 * seconds)
    print_out(fmt::format("--extend: by {:.6g} s, whole intervals between snapshots\n", longer));
  from->scene = particles::scene_text(particles::as_recorded(scene));
  // What an interruption leaves is a run of the longer scene or of the shorter one, never a mixture.
  output.forget(checkpoint_name);
  output.forget(previous_checkpoint_name);
  output.forget("scene.toml");
  output.forget("run.json");
  output.save();
  particles::keep_checkpoint(output.folder(), *from);
  replace_file(output.folder() / "scene.toml", from->scene);
}

}  // namespace drumlin::apps
