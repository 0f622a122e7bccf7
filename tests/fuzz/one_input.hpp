#pragma once
// What the targets share: a reader reads or refuses, and anything else is a finding.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::fuzz {

/// Runs a reader. Only InputError may leave it, with a text that says why; whatever else does ends the
/// program.
template <class Read>
int read_or_refused(Read read) {
  try {
    read();
  } catch (const InputError& refused) {
    if (*refused.what() == '\0') std::abort();
  }
  return 0;
}

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace drumlin::fuzz
