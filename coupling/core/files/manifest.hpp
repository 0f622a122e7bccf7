#pragma once
// manifest.txt: what a command has left in its result folder, every file with size and checksum
// (docs/formats/manifest.md). It marks the folder as ours.
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupling/core/files/checksum.hpp"

namespace drumlin {

inline constexpr const char* manifest_name = "manifest.txt";

struct ManifestEntry {
  FileSum sum;
  bool grows = false;  ///< more may follow the bytes that were summed: a log of an unfinished run
  bool operator==(const ManifestEntry&) const = default;
};

struct Manifest {
  std::string command;                         ///< that made the folder: "run", "measure", ...
  bool complete = false;                       ///< its results are all there
  std::vector<std::string> accepted;           ///< when and why edits by hand were accepted
  std::map<std::string, ManifestEntry> files;  ///< by their paths in the folder
  std::string source = {};  ///< manifest_sum() of the folder that the results were computed from; empty: none
  std::string requested = {};  ///< checksum of what the command was asked for; empty: not known
};

/// Whether the folder carries our marker.
bool has_manifest(const std::filesystem::path& folder);

/// The paths of its files.
std::vector<std::string> names_in(const Manifest& manifest);

/// Folder and ending: files that agree in both are of one kind, snapshots say.
using FileKind = std::pair<std::filesystem::path, std::filesystem::path>;
FileKind kind_of_file(const std::filesystem::path& name);
/// Those of the files in sub-folders.
std::set<FileKind> kinds_in(const Manifest& manifest);

/// Whether a manifest may list a file by this path in its folder: plain names, none hidden, as deep as any
/// command writes (measured/slices/1.csv).
bool can_be_listed(const std::filesystem::path& name);

/// Throws InputError where the way from `folder` to one of these names in it leads over a symbolic link:
/// nothing outside of a folder that somebody else made is written or removed.
void refuse_links(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Throws InputError if it is missing, damaged or of another version.
Manifest read_manifest(const std::filesystem::path& folder);

/// What stands behind "sum" in its file: another one after any change of the folder that is on record, a new
/// file, an edit that was accepted, another state.
std::string manifest_sum(const Manifest& manifest);

/// Throws IoError, an older manifest being intact then.
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

/// All regular files below a folder by their paths in it, but for the manifest, the lock, files that begin
/// with ".drumlin-" and what lies in result folders within (those with a manifest of their own).
std::vector<std::string> files_below(const std::filesystem::path& folder);

/// Sums of these files, as they are now.
std::map<std::string, ManifestEntry> entries_of(const std::filesystem::path& folder,
                                                const std::vector<std::string>& names);

}  // namespace drumlin
