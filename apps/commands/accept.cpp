// drumlin accept: a result folder as it is now, edits by hand included, is taken for what it should be. The
// reason becomes part of the provenance of what is read from it.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "apps/command_line/command.hpp"
#include "apps/commands/result_folders.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/files/folder_lock.hpp"
#include "coupling/core/files/manifest.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

struct AcceptOptions {
  fs::path folder;
  std::string reason;

  void describe(Description& d) {
    d.add("folder", folder, "DIR", "Result folder of any command").required();
    d.add("--reason", reason, "TEXT", "Why, in one line: it is told wherever the folder is read").required();
  }
};

constexpr std::size_t longest_reason = 500, most_named = 5;

/// By which file a folder without a manifest is known, and the command that leaves it.
constexpr std::pair<const char*, const char*> signs[] = {
    {"import.toml", "import"},   {"run.json", "run"},          {"flow.json", "flow"},
    {"flow_scene.toml", "flow"}, {"measured.json", "measure"}, {"comparison.json", "compare"},
    {"study.json", "study"},     {"cost.json", "cost"},        {"sweep.json", "cost"},
    {"plots.json", "plot"},      {"grains.pvd", "export"}};

std::optional<std::string> command_of(const fs::path& folder) {
  for (const auto& [file, command] : signs)
    if (fs::is_regular_file(folder / file)) return command;
  return std::nullopt;
}

std::string checked_reason(const std::string& reason) {
  const bool is_line = std::none_of(reason.begin(), reason.end(), [](char letter) {
    return static_cast<unsigned char>(letter) < ' ' || letter == 127;
  });
  if (reason.find_first_not_of(' ') == std::string::npos || reason.size() > longest_reason || !is_line)
    throw InputError(fmt::format("--reason: one line of 1 to {} bytes is needed", longest_reason));
  return reason;
}

/// What an older version left. Of an unfinished folder what stands in sub-folders: a call that goes on writes
/// all else anew.
Manifest first_manifest(const fs::path& folder, const std::string& command) {
  Manifest manifest{.command = command, .complete = true, .accepted = {}, .files = {}};
  if (command == "run")
    manifest.complete = read_record<RunRecord>(folder / "run.json").status == name_of(RunStatus::finished);
  else if (command == "flow" || command == "import")
    manifest.complete = fs::exists(folder / (command == "flow" ? "flow.json" : "run.json"));
  for (const std::string& name : files_below(folder))
    if (manifest.complete || fs::path(name).has_parent_path()) manifest.files[name];
  return manifest;
}

/// The same manifest for the files as they are now.
Manifest as_it_is(const fs::path& folder, const Manifest& before) {
  const std::set<FileKind> kinds = kinds_in(before);
  Manifest now = before;
  now.files.clear();
  for (const std::string& name : files_below(folder)) {
    const auto old = before.files.find(name);
    const bool is_listed = old != before.files.end();
    if (!can_be_listed(name) || (!is_listed && !kinds.contains(kind_of_file(name)))) continue;
    const bool grows = is_listed && old->second.grows;  // the part that was summed counts
    now.files[name] = {file_sum(folder / name, grows ? std::optional(old->second.sum.bytes) : std::nullopt),
                       grows};
  }
  return now;
}

/// A manifest that can be read; damaged it counts as none.
std::optional<Manifest> readable_manifest(const fs::path& folder) {
  if (!has_manifest(folder)) return std::nullopt;
  try {
    return read_manifest(folder);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// What was measured belongs to the run around it, as that is now.
std::string source_now(const fs::path& folder, const Manifest& manifest) {
  const auto run = manifest.command == "measure" ? readable_manifest(folder / "..") : std::nullopt;
  return run ? manifest_sum(*run) : manifest.source;
}

/// Whether a folder that was computed from another one is taken for computed from that as it is now.
enum class Source { as_before, accepted };

/// Says what was accepted; nothing if all is as it should be.
std::string accept_one(const fs::path& folder, const std::string& reason, Source source) {
  const FolderLock lock(folder / folder_lock_name, "drumlin accept");
  const auto old = readable_manifest(folder);
  const Manifest before = old ? *old : first_manifest(folder, command_of(folder).value_or("unknown"));
  Manifest now = as_it_is(folder, before);
  if (source == Source::accepted) now.source = source_now(folder, now);
  const bool of_another = now.source != before.source;
  const auto listed = old ? old->files : decltype(old->files){};
  auto files = now.files;
  files.insert(listed.begin(), listed.end());
  std::vector<std::string> changed;
  std::string lines;
  for (const auto& [name, entry] : files) {
    const bool is_there = now.files.contains(name), was_there = listed.contains(name);
    if (is_there && was_there && listed.at(name) == entry) continue;
    changed.push_back(name);
    lines += fmt::format("  {:8} {}\n", !is_there ? "missing" : was_there ? "changed" : "new", name);
  }
  if (old && changed.empty() && !of_another) return "";
  const std::size_t named = std::min(changed.size(), most_named);
  std::string what =
      old ? fmt::format("{}", fmt::join(std::span(changed).first(named), ", ")) : std::string("all files");
  if (old && changed.size() > named) what += fmt::format(" and {} more", changed.size() - named);
  if (of_another) what += changed.empty() ? "of another state of the run" : ", of another state of the run";
  now.accepted.push_back(fmt::format("{}: {} ({})", time_text(), reason, what));
  write_manifest(folder, now);
  return fmt::format("{}: {} files accepted{}\n{}", folder.string(), changed.size(),
                     of_another ? ", and that they are of another state of the run" : "", lines);
}

/// Writes the manifests of the folder and of the result folders within anew, where they are not as they say;
/// also the first one of a folder that a version without manifests has left.
int accept(const AcceptOptions& options) {
  const std::string reason = checked_reason(options.reason);
  if (!fs::is_directory(options.folder)) throw InputError(options.folder.string() + ": no such folder");
  if (!has_manifest(options.folder) && !command_of(options.folder))
    throw InputError(options.folder.string() + ": is no result folder of this program");
  std::string said;
  std::vector<fs::path> signed_first;
  for (const fs::path& folder : result_folders(options.folder)) {
    if (!readable_manifest(folder)) signed_first.push_back(folder);
    said += accept_one(folder, reason, folder == options.folder ? Source::accepted : Source::as_before);
  }
  // Only now is known what the folder around them was signed as.
  for (const fs::path& folder : signed_first) {
    Manifest manifest = read_manifest(folder);
    manifest.source = source_now(folder, manifest);
    write_manifest(folder, manifest);
  }
  print_out(said.empty() ? options.folder.string() + ": all files are as they were written\n" : said);
  return static_cast<int>(ExitCode::done);
}

}  // namespace

std::vector<fs::path> result_folders(const fs::path& folder) {
  std::vector<fs::path> found;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    if (!entry->is_directory() || entry->is_symlink()) continue;
    const fs::path& path = entry->path();
    if (path.filename() == "replaced" || path.filename().string().starts_with(".drumlin-"))
      entry.disable_recursion_pending();
    else if (has_manifest(path) || command_of(path))
      found.push_back(path);
  }
  std::reverse(found.begin(), found.end());
  found.push_back(folder);
  return found;
}

Command accept_command() {
  return command("accept", "Takes a result folder as it is after an edit by hand", accept);
}

}  // namespace drumlin::apps
