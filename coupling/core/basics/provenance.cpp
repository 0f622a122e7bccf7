#include "coupling/core/basics/provenance.hpp"

#include <algorithm>
#include <fstream>
#include <thread>

namespace drumlin {

namespace {

/// "model name" of the first processor; "unknown" where the system does not say.
std::string processor_model() {
  std::ifstream description("/proc/cpuinfo");
  for (std::string line; std::getline(description, line);) {
    const auto colon = line.find(':');
    if (line.starts_with("model name") && colon != std::string::npos)
      return line.substr(std::min(line.find_first_not_of(' ', colon + 1), line.size()));
  }
  return "unknown";
}

}  // namespace

Provenance provenance() {
#ifdef __clang__
  const std::string compiler = __VERSION__;
#else
  const std::string compiler = std::string("GNU ") + __VERSION__;
#endif
  return {DRUMLIN_REVISION, compiler, DRUMLIN_BUILD_TYPE, processor_model(),
          static_cast<int>(std::thread::hardware_concurrency())};
}

std::string version_text() {
  const Provenance p = provenance();
  return DRUMLIN_VERSION " (revision " + p.revision + ", " + p.compiler + ", " + p.build_type + ")";
}

}  // namespace drumlin
