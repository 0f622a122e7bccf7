#pragma once
// drumlin accept: a result folder as it is now, edits by hand included, is taken for what it should be. The
// reason becomes part of the provenance of what is read from it.
#include <filesystem>
#include <string>

namespace drumlin::apps {

struct AcceptOptions {
  std::filesystem::path folder;
  std::string reason;
};

/// Writes the manifests of the folder and of the result folders within anew, where they are not as they say;
/// also the first one of a folder that a version without manifests has left. Throws InputError if the folder
/// is none of ours or is being written, or if the reason is not one line of text.
int accept(const AcceptOptions&);

}  // namespace drumlin::apps
