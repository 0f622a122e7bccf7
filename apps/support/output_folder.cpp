#include "apps/support/output_folder.hpp"

#include <algorithm>

#include "coupling/common/errors.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

namespace {

void remove_content(const fs::path& folder, const std::vector<std::string>& markers) {
  const bool ours = std::any_of(markers.begin(), markers.end(),
                                [&](const std::string& marker) { return fs::exists(folder / marker); });
  if (!ours) {
    std::string expected;
    for (const auto& marker : markers) expected += (expected.empty() ? "" : " or ") + marker;
    throw InputError(folder.string() +
                     ": is not overwritten, for this program did not make it (it holds no " + expected +
                     "); remove it yourself or name another folder");
  }
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
  for (const auto& entry : entries) fs::remove_all(entry);
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

}  // namespace

void prepare_output(const fs::path& folder, ExistingOutput existing, const std::vector<std::string>& markers,
                    const std::vector<fs::path>& inputs) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder))
      throw InputError(folder.string() + ": is a file, a folder is needed for the results");
    if (fs::exists(folder) && !fs::is_empty(folder)) {
      if (existing == ExistingOutput::refuse)
        throw InputError(folder.string() +
                         ": exists already; give --resume or --overwrite, or name another folder");
      if (existing == ExistingOutput::overwrite) {
        refuse_inside(folder, inputs);
        remove_content(folder, markers);
      }
    }
    fs::create_directories(folder);
  } catch (const fs::filesystem_error& error) {
    throw IoError(error.what());
  }
}

void prepare_output_file(const fs::path& file, ExistingOutput existing) {
  try {
    if (fs::is_directory(file)) throw InputError(file.string() + ": is a folder, a file is needed");
    if (fs::exists(file) && existing == ExistingOutput::refuse)
      throw InputError(file.string() + ": exists already; give --overwrite, or name another file");
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
  } catch (const fs::filesystem_error& error) {
    throw IoError(error.what());
  }
}

}  // namespace drumlin::apps
