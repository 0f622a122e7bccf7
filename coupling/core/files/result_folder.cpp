#include "coupling/core/files/result_folder.hpp"

#include <fmt/format.h>

#include <utility>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

namespace fs = std::filesystem;

namespace {

using Problems = std::vector<InputProblem>;

constexpr std::size_t most_problems = 20;  // of one folder that are told one by one

InputProblem problem(const fs::path& file, const std::string& what) {
  return {file.string(), 0, 0, "", what, ""};
}

std::string way_out(const fs::path& folder) {
  return fmt::format("drumlin accept {} --reason TEXT takes the folder as it is", folder.string());
}

[[noreturn]] void refuse(const fs::path& folder, Problems problems) {
  if (problems.size() > most_problems) {
    const std::size_t more = problems.size() - most_problems;
    problems.resize(most_problems);
    problems.push_back(problem(folder, fmt::format("{} more files are not as {} says", more, manifest_name)));
  }
  problems.push_back(problem(folder, "was changed since it was written; " + way_out(folder)));
  throw InputError(std::move(problems));
}

void check_size(const fs::path& file, const ManifestEntry& entry, Problems& problems) {
  std::error_code error;
  const bool is_there = fs::is_regular_file(fs::symlink_status(file, error));
  const auto size = is_there ? fs::file_size(file, error) : 0;
  if (error || !is_there)
    problems.push_back(problem(file, fmt::format("is missing; {} lists it", manifest_name)));
  else if (size < entry.sum.bytes || (size > entry.sum.bytes && !entry.grows))
    problems.push_back(
        problem(file, fmt::format("has {} bytes, {} in {}", size, entry.sum.bytes, manifest_name)));
}

/// A snapshot too many is as wrong as one too few; files of others elsewhere do not matter.
void check_extra(const ResultFolder& folder, Problems& problems) {
  const std::set<FileKind> kinds = kinds_in(*folder.manifest);
  if (kinds.empty()) return;
  for (const std::string& name : files_below(folder.path))
    if (kinds.contains(kind_of_file(name)) && !folder.manifest->files.contains(name))
      problems.push_back(problem(folder.path / name, fmt::format("is not listed in {}", manifest_name)));
}

}  // namespace

ResultFolder open_result_folder(const fs::path& path, WithoutManifest without) {
  if (!fs::is_directory(path)) throw InputError(path.string() + ": no such folder");
  ResultFolder folder{path, std::nullopt};
  if (!has_manifest(path)) {
    if (without == WithoutManifest::accept) return folder;
    throw InputError(
        fmt::format("{}: has no {}, so that nobody knows whether its files are as they were written; {}",
                    path.string(), manifest_name, way_out(path)));
  }
  folder.manifest = read_manifest(path);
  refuse_links(path, names_in(*folder.manifest));
  Problems problems;
  for (const auto& [name, entry] : folder.manifest->files) check_size(path / name, entry, problems);
  if (folder.manifest->complete) check_extra(folder, problems);
  if (!problems.empty()) refuse(path, std::move(problems));
  return folder;
}

fs::path checked_file(const ResultFolder& folder, const std::string& name) {
  const fs::path file = folder.path / name;
  if (!folder.manifest) return file;
  const auto entry = folder.manifest->files.find(name);
  if (entry == folder.manifest->files.end()) {
    if (folder.manifest->complete && fs::exists(file))
      refuse(folder.path, {problem(file, fmt::format("is not listed in {}", manifest_name))});
    return file;
  }
  const ManifestEntry& listed = entry->second;
  if (file_sum(file, listed.grows ? std::optional(listed.sum.bytes) : std::nullopt) != listed.sum)
    refuse(folder.path,
           {problem(file, fmt::format("damaged or changed: its checksum is not that of {}", manifest_name))});
  return file;
}

void check_all_files(const ResultFolder& folder) {
  if (!folder.manifest) return;
  for (const auto& [name, entry] : folder.manifest->files) (void)checked_file(folder, name);
}

void check_source(const ResultFolder& results, const ResultFolder& source, const std::string& again) {
  if (!results.manifest || !source.manifest || results.manifest->source == manifest_sum(*source.manifest))
    return;
  const std::string what =
      results.manifest->source.empty()
          ? fmt::format("does not say from which state of {} it was computed", source.path.string())
          : fmt::format("was computed from {} as it was before: that was resumed, replaced or edited since",
                        source.path.string());
  throw InputError(
      {problem(results.path, what),
       problem(results.path, fmt::format("{} computes it anew; {}", again, way_out(results.path)))});
}

std::vector<std::string> accepted_edits(const ResultFolder& folder) {
  std::vector<std::string> edits;
  if (!folder.manifest) return edits;
  for (const std::string& reason : folder.manifest->accepted)
    edits.push_back(folder.path.string() + ": " + reason);
  return edits;
}

}  // namespace drumlin
