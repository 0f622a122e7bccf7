#pragma once
// A table of the values of an enumeration and their names in files and messages.
#include <array>
#include <cstddef>
#include <utility>

namespace drumlin {

template <class Enum, std::size_t n>
using EnumNames = std::array<std::pair<Enum, const char*>, n>;

/// The name of `value`, empty if the table has none.
template <class Enum, std::size_t n>
constexpr const char* name_in(const EnumNames<Enum, n>& names, Enum value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  return "";
}

}  // namespace drumlin
