#include "coupling/core/documents/one_line.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace drumlin {
namespace {

constexpr std::uint32_t none = 0xFFFFFFFF;

/// Takes the first character off a text; `none` if its bytes are no UTF-8 (RFC 3629).
std::uint32_t taken(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80 ? 1 : byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if ((length > 1 && byte(0) < 0xC2) || byte(0) > 0xF4 || text.size() < length) return none;
  std::uint32_t character = length == 1 ? byte(0) : byte(0) & (0x7F >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return none;
    character = character << 6 | (byte(i) & 0x3F);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (character < least[length] || character > 0x10FFFF || (character >= 0xD800 && character < 0xE000))
    return none;
  text.remove_prefix(length);
  return character;
}

bool is_control(std::uint32_t character) {
  return character < 0x20 || (character >= 0x7F && character < 0xA0) || character == 0x2028 ||
         character == 0x2029;
}

}  // namespace

std::string fault_of_line(std::string_view text, std::size_t longest) {
  std::size_t length = 0;
  for (; !text.empty(); ++length) {
    const std::uint32_t character = taken(text);
    if (character == none) return "is no UTF-8";
    if (is_control(character)) return fmt::format("holds a control character (U+{:04X})", character);
  }
  return length > longest ? fmt::format("has {} characters", length) : "";
}

}  // namespace drumlin
