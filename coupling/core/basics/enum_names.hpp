#pragma once
// Names of enumerators in files and messages. Beside an enumeration that counts from 0 stands a list of them,
// in its order:
//   constexpr auto names_of(RunSide) { return std::array{"particles", "continuum"}; }
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace drumlin {

template <class E>
concept Named = std::is_enum_v<E> && requires(E value) {
  names_of(value);
};

template <Named E>
constexpr const char* name_of(E value) {
  return names_of(value)[static_cast<std::size_t>(value)];
}

/// The enumerator of that name; nothing where there is none.
template <Named E>
constexpr std::optional<E> enumerator(std::string_view name) {
  constexpr auto names = names_of(E{});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i]) return static_cast<E>(i);
  return std::nullopt;
}

}  // namespace drumlin
