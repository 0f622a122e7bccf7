#include "apps/output/output_folder.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <set>
#include <utility>

#include "apps/process/interruption.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char *staging_name = ".drumlin-new", *replaced_name = "replaced";

/// Whether publish() had all new results there, and was ended while it put them in their places.
bool is_being_published(const fs::path& folder) {
  const fs::path staging = folder / staging_name;
  return fs::is_directory(fs::symlink_status(staging)) && has_manifest(staging);
}

/// Nothing but what a command leaves that was killed: empty folders, files aside.
bool holds_nothing(const fs::path& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), [](const auto& entry) {
    const std::string name = entry.path().filename().string();
    return name == folder_lock_name || name == staging_name || is_left_aside(name) ||
           (entry.is_directory() && !entry.is_symlink() && holds_nothing(entry.path()));
  });
}

void refuse_foreign(const fs::path& folder) {
  const auto status = input_status(folder);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError(folder.string() + ": is a file, a folder is needed for the results");
  if (holds_nothing(folder) || has_manifest(folder)) return;
  throw InputError(fmt::format(
      "{0}: nothing is written there, for it is not empty and this program did not make it (it holds no "
      "{1}); "
      "name another folder. Results of a version without manifests: drumlin accept {0} --reason TEXT",
      folder.string(), manifest_name));
}

/// What another command left is not replaced by this one.
void refuse_other_command(const fs::path& folder, const std::string& command) {
  if (!has_manifest(folder)) return;
  if (const std::string theirs = read_manifest(folder).command; theirs != command)
    throw InputError(
        fmt::format("{}: holds the results of drumlin {}, not of drumlin {}; name another folder",
                    folder.string(), theirs, command));
}

/// An output folder that holds what the command is about to read must not be emptied.
void refuse_inside(const fs::path& folder, const std::vector<fs::path>& inputs) {
  const fs::path ours = fs::weakly_canonical(folder);
  for (const auto& input : inputs) {
    const fs::path theirs = fs::weakly_canonical(input);
    if (std::mismatch(ours.begin(), ours.end(), theirs.begin(), theirs.end()).first == ours.end())
      throw InputError(folder.string() + ": is not overwritten, for " + input.string() +
                       " is read and lies in it; name another folder");
  }
}

void remove_left_aside(const fs::path& folder) {
  std::vector<fs::path> left;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    const fs::path& path = entry->path();
    // Another command may be at work in a result folder within.
    if (entry->is_directory() && (has_manifest(path) || fs::exists(path / folder_lock_name)))
      entry.disable_recursion_pending();
    else if (is_left_aside(path) && entry->is_regular_file())
      left.push_back(path);
  }
  for (const fs::path& file : left) fs::remove(file);
}

/// Removes folders of these files that hold nothing any more.
void remove_empty_folders(const fs::path& folder, const std::vector<std::string>& names) {
  std::set<fs::path, std::greater<>> parents;  // the inner ones first
  for (const std::string& name : names)
    for (fs::path parent = fs::path(name).parent_path(); !parent.empty(); parent = parent.parent_path())
      parents.insert(parent);
  std::error_code still_in_use;
  for (const fs::path& parent : parents) fs::remove(folder / parent, still_in_use);
}

void move_file(const fs::path& from, const fs::path& to) {
  make_folders(to.parent_path());
  fs::rename(from, to);
}

/// Puts what is published in the place of the old results; goes on where it was interrupted.
void take_over(const fs::path& folder) {
  const fs::path staging = folder / staging_name;
  const Manifest fresh = read_manifest(staging);
  for (const fs::path& within : {staging, folder}) refuse_links(within, names_in(fresh));
  const Manifest old = has_manifest(folder) ? read_manifest(folder) : Manifest{};
  std::vector<std::string> gone;
  for (const auto& [name, entry] : old.files)
    if (!fresh.files.contains(name)) gone.push_back(name);
  for (const std::string& name : gone) fs::remove(folder / name);
  std::set<fs::path> touched;
  for (const auto& [name, entry] : fresh.files) {
    if (fs::exists(staging / name)) move_file(staging / name, folder / name);
    touched.insert((folder / name).parent_path());
  }
  remove_empty_folders(folder, gone);
  for (const fs::path& parent : touched) force_to_disk(parent);
  move_file(staging / manifest_name, folder / manifest_name);
  force_to_disk(folder);
  fs::remove_all(staging);
}

/// Files of a result folder within: those listed, or all where it is unfinished.
void add_inner(const fs::path& inner, const fs::path& place, std::set<std::string>& names) {
  const Manifest manifest = read_manifest(inner);
  for (const auto& [name, entry] : manifest.files) names.insert((place / name).generic_string());
  if (!manifest.complete)
    for (const std::string& name : files_below(inner)) names.insert((place / name).generic_string());
  names.insert((place / manifest_name).generic_string());
}

/// Whether a name is of one of these patterns, whose * does not stand for /.
bool is_of(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0;
  });
}

/// Listed files, and those that the command knows, of a folder and of the result folders in it.
std::vector<std::string> our_files(const fs::path& folder, const std::vector<std::string>& known) {
  std::set<std::string> names;
  for (const auto& [name, entry] : read_manifest(folder).files) names.insert(name);
  for (const std::string& name : files_below(folder))
    if (is_of(known, name)) names.insert(name);
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    if (!entry->is_directory() || entry->is_symlink()) continue;
    const fs::path inner = entry->path(), name = inner.lexically_relative(folder);
    if (name == replaced_name || name == staging_name)
      entry.disable_recursion_pending();
    else if (has_manifest(inner))
      add_inner(inner, name, names);
  }
  std::vector<std::string> list(names.begin(), names.end());
  // Manifests of folders within last: what is left by an interruption is still known by them.
  std::stable_partition(list.begin(), list.end(),
                        [](const std::string& name) { return fs::path(name).filename() != manifest_name; });
  return list;
}

/// Moves our files to FOLDER/replaced; if results wait there already, what has come since is removed.
void set_aside(const fs::path& folder, const std::vector<std::string>& known) {
  const fs::path aside = folder / replaced_name;
  const Manifest old = read_manifest(folder);
  if (!has_manifest(aside)) {
    if (fs::exists(aside) && !(fs::is_directory(aside) && holds_nothing(aside)))
      throw InputError(aside.string() + ": lies where the old results are to wait for the new ones; move it");
    make_folders(aside);
    write_manifest(aside, old);
  }
  const bool is_theirs = read_manifest(aside).files == old.files;  // or an interrupted call has moved some
  const std::vector<std::string> names = our_files(folder, known);
  for (const fs::path& within : {folder, aside}) refuse_links(within, names);
  for (const std::string& name : names) {
    if (is_theirs && fs::exists(fs::symlink_status(folder / name)))
      move_file(folder / name, aside / name);
    else
      fs::remove(folder / name);
  }
  remove_empty_folders(folder, names);
}

/// Whether an interrupted call has moved some of the results and not all.
bool is_half_aside(const fs::path& folder) {
  const fs::path aside = folder / replaced_name;
  if (!has_manifest(aside)) return false;
  const auto old = read_manifest(folder).files;
  return read_manifest(aside).files == old && std::any_of(old.begin(), old.end(), [&](const auto& file) {
           return !fs::exists(folder / file.first) && fs::exists(aside / file.first);
         });
}

}  // namespace

FolderLock claim(const OutputRequest& request) {
  outlive_readers();
  const fs::path& folder = request.folder;
  if (folder.empty()) throw InputError("the output folder has no name");
  refuse_foreign(folder);
  if (fs::is_symlink(fs::symlink_status(folder)))
    throw InputError(folder.string() + ": is a symbolic link; name the folder that it leads to");
  make_folders(folder);
  FolderLock lock(folder / folder_lock_name, "drumlin " + request.command);
  refuse_foreign(folder);
  const bool half_published = is_being_published(folder);
  if ((half_published || !holds_nothing(folder)) && request.existing == ExistingOutput::refuse)
    throw InputError(folder.string() +
                     (request.goes_on
                          ? ": exists already; give --resume or --overwrite, or name another folder"
                          : ": exists already; give --overwrite, or name another folder"));
  refuse_other_command(folder, request.command);
  if (request.existing == ExistingOutput::overwrite) refuse_inside(folder, request.inputs);
  if (has_manifest(folder)) refuse_links(folder, names_in(read_manifest(folder)));
  if (half_published) take_over(folder);
  fs::remove_all(folder / staging_name);
  remove_left_aside(folder);
  return lock;
}

StagedOutput::StagedOutput(OutputRequest request)
    : request_(std::move(request)),
      made_(!fs::exists(input_status(request_.folder))),
      lock_(claim(request_)),
      staging_(request_.folder / staging_name) {
  fs::create_directory(staging_);
}

StagedOutput::~StagedOutput() {
  std::error_code ignored;
  if (!has_manifest(staging_)) fs::remove_all(staging_, ignored);
  { const FolderLock released = std::move(lock_); }
  if (made_) fs::remove(request_.folder, ignored);  // only if nothing was published
}

void StagedOutput::publish() {
  const Manifest manifest{.command = request_.command,
                          .complete = true,
                          .accepted = {},
                          .files = entries_of(staging_, files_below(staging_)),
                          .source = request_.source,
                          .requested = request_.requested};
  const Manifest old = has_manifest(request_.folder) ? read_manifest(request_.folder) : Manifest{};
  refuse_links(request_.folder, names_in(manifest));
  for (const auto& [name, entry] : manifest.files) {
    const fs::path there = request_.folder / name;
    if (fs::exists(fs::symlink_status(there)) && !old.files.contains(name))
      throw InputError(there.string() + ": is not of this program and lies where a result is to go; move it");
    force_to_disk(staging_ / name);
  }
  write_manifest(staging_, manifest);
  take_over(request_.folder);
}

GrowingOutput::GrowingOutput(OutputRequest request, std::vector<std::string> known)
    : request_(std::move(request)), known_(std::move(known)), lock_(claim(request_)) {
  const bool is_there = has_manifest(request_.folder);
  refuse_links(request_.folder, known_);
  refuse_links(request_.folder, {std::string(replaced_name) + "/" + manifest_name});
  if (is_there && request_.existing == ExistingOutput::resume && !is_half_aside(request_.folder)) {
    const ResultFolder there = open_result_folder(request_.folder);
    check_all_files(there);
    manifest_ = *there.manifest;
    manifest_.requested = request_.requested;
    return;
  }
  if (is_there) set_aside(request_.folder, known_);
  manifest_.command = request_.command;
  manifest_.requested = request_.requested;
  save();
}

void GrowingOutput::list(const std::string& name) {
  manifest_.files[name] = {file_sum(request_.folder / name), false};
}

void GrowingOutput::forget(const std::string& pattern) {
  std::erase_if(manifest_.files, [&](const auto& file) { return is_of({pattern}, file.first); });
}

void GrowingOutput::save() const {
  Manifest unfinished = manifest_;
  unfinished.complete = false;
  write_manifest(request_.folder, unfinished);
}

void GrowingOutput::finish() {
  for (const std::string& name : files_below(request_.folder)) {
    const auto entry = manifest_.files.find(name);
    if (is_of(known_, name) && (entry == manifest_.files.end() || entry->second.grows)) list(name);
  }
  manifest_.complete = true;
  write_manifest(request_.folder, manifest_);
  const fs::path aside = request_.folder / replaced_name;
  if (has_manifest(aside)) fs::remove_all(aside);
}

bool holds_results(const fs::path& folder, const std::string& finished) {
  if (!fs::exists(folder / finished) || !has_manifest(folder) || is_half_aside(folder)) return false;
  const ResultFolder there = open_result_folder(folder);
  if (!there.manifest->complete) return false;
  check_all_files(there);
  return true;
}

FolderLock prepare_output_file(const fs::path& file, ExistingOutput existing) {
  outlive_readers();
  if (file.empty()) throw InputError("the output file has no name");
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (has_manifest(folder) && read_manifest(folder).files.contains(file.filename().string()))
    throw InputError(file.string() + ": is one of the results in its folder; name another file");
  const auto there = input_status(file);
  if (fs::exists(there) && !fs::is_regular_file(there))
    throw InputError(file.string() + ": is a folder or a device, a file is needed");
  if (fs::exists(there) && existing == ExistingOutput::refuse)
    throw InputError(file.string() + ": exists already; give --overwrite, or name another file");
  make_folders(folder);
  return FolderLock(folder / ("." + file.filename().string() + folder_lock_name),
                    "drumlin, for " + file.filename().string());
}

}  // namespace drumlin::apps
