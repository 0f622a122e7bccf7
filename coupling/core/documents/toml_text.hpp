#pragma once
// Writes a tree as TOML.
#include <string>

#include "coupling/core/documents/document.hpp"

namespace drumlin {

/// TOML text of a table: plain values first, then sub-tables under [headers]. Reals are printed with the
/// fewest digits that read back to the same number, so that parse_toml(toml_text(t)) is t again, places
/// apart.
std::string toml_text(const Node& table);

/// A single value as it stands to the right of "=".
std::string toml_value(const Node& value);

}  // namespace drumlin
