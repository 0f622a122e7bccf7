#pragma once
// Small files of other programs, imported.
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/import/import_run.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::testing {

struct Imported {
  particles::ImportReport report;
  std::vector<particles::Snapshot> snapshots;
};

/// Writes the description into the folder and imports what it names there.
inline Imported imported(const TemporaryFolder& folder, const std::string& description) {
  Imported result;
  const particles::ImportDescription read =
      particles::read_import_description(folder.with("import.toml", description));
  result.report = particles::import_run(read, folder.path(),
                                        [&](const particles::Snapshot& s) { result.snapshots.push_back(s); });
  return result;
}

inline std::string refusal(const TemporaryFolder& folder, const std::string& description) {
  return message_of<InputError>([&] { imported(folder, description); });
}

}  // namespace drumlin::testing
