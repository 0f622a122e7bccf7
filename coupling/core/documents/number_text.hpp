#pragma once
// Numbers as they stand in text files, read whole or refused with their place.
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace drumlin {

/// The number that the whole of a text is, independent of the locale; nothing when it is none or does not fit
/// into T. A plus may stand before it; "nan" and "inf" are numbers of a floating T.
template <class T>
std::optional<T> parsed_number(std::string_view text) {
  T value{};
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
#ifndef __cpp_lib_to_chars  // Emscripten's library reads whole numbers alone; its strtod has no locale
  if constexpr (std::is_floating_point_v<T>) {
    const std::string whole(text);
    char* end = nullptr;
    value = static_cast<T>(std::strtod(whole.c_str(), &end));
    const bool good = !whole.empty() && whole[0] > ' ' && end == whole.c_str() + whole.size();
    return good ? std::optional(value) : std::nullopt;
  } else
#endif
  {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }
}

/// Where a text stands, for the message of a refusal. The line counts from 1; 0: it has none.
struct TextPlace {
  std::string file;
  int line = 0;
  std::string key;
};

/// Throws InputError with file, line, key and the text unless the text is a finite number.
double checked_number(std::string_view text, const TextPlace& place);
/// The same for a whole number from 0 up.
int checked_count(std::string_view text, const TextPlace& place);

}  // namespace drumlin
