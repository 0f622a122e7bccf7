#pragma once
// A result folder as a reader meets it: what stands in it is checked against its manifest.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coupling/core/files/manifest.hpp"

namespace drumlin {

struct ResultFolder {
  std::filesystem::path path;
  std::optional<Manifest> manifest;  ///< absent: files cut out of a result folder, read as they are
};

/// What to do with a folder that has no manifest.
enum class WithoutManifest { refuse, accept };

/// Reads the manifest and checks the listing, not the content: throws InputError that names every file that
/// is missing, has another size, or stands unlisted among listed ones of its kind (a snapshot more, say). In
/// an unfinished folder files may stand that are not listed yet.
ResultFolder open_result_folder(const std::filesystem::path& folder,
                                WithoutManifest without = WithoutManifest::refuse);

/// The path of a file of the folder, its bytes checked: throws InputError if they are not those of the
/// manifest, or if the manifest of a complete folder does not list it. Where it is not there, the path alone.
std::filesystem::path checked_file(const ResultFolder& folder, const std::string& name);

/// Every file that is listed, as checked_file().
void check_all_files(const ResultFolder& folder);

/// Throws InputError unless `results` were computed from `source` as it is now: what was resumed, replaced or
/// edited since is another. `again` is the command that computes them anew. Files cut out of either folder,
/// without a manifest, are taken as they are.
void check_source(const ResultFolder& results, const ResultFolder& source, const std::string& again);

/// Edits by hand that were accepted, each with the folder: part of the provenance of what is read from it.
std::vector<std::string> accepted_edits(const ResultFolder& folder);

}  // namespace drumlin
