#pragma once
// The texts that stand for enumerators in files and tables.
#include <cstddef>
#include <string>
#include <utility>

namespace drumlin::apps {

/// One enumerator and its text.
template <typename Enum>
using EnumName = std::pair<Enum, const char*>;

/// The text of `value` in a table that names every enumerator; empty for a value outside of the enumeration.
template <typename Enum, std::size_t size>
std::string enum_name(const EnumName<Enum> (&names)[size], Enum value) {
  for (const auto& [enumerator, name] : names)
    if (enumerator == value) return name;
  return {};
}

}  // namespace drumlin::apps
