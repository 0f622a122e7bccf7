#pragma once
// Where a result comes from: stands in every JSON file.
#include <string>

namespace drumlin {

struct Provenance {
  std::string
      revision;  ///< git revision of the sources at configure time, "-dirty" appended if they were changed
  std::string compiler;
  std::string build_type;
  std::string machine;  ///< processor model
  int processors = 0;
};

Provenance provenance();

/// "0.1.0 (revision 0123456789ab, GNU 12.2.0, Release)": what the programs answer to --version.
std::string version_text();

}  // namespace drumlin
