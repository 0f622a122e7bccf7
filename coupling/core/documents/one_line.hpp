#pragma once
// Texts that stand on one line: titles, names, paths. They go into file headers, figures and messages.
#include <cstddef>
#include <string>
#include <string_view>

namespace drumlin {

/// Why a text is not one line of at most `longest` characters (code points of UTF-8): "holds a control
/// character (U+000A)", "has 20000 characters", "is no UTF-8"; empty: it is. Control characters are those of
/// Unicode's class Cc, and its separators of lines and paragraphs.
std::string fault_of_line(std::string_view text, std::size_t longest);

}  // namespace drumlin
