#pragma once
// How deep a TOML text goes, known before it is parsed: the parser calls itself for each level, so that a
// text of 32 kB could end the program.
#include <string_view>

namespace drumlin {

inline constexpr int deepest_level = 32;  ///< the formats of the project need ten

/// The first line, counted from 1, on which a dotted key has more than `deepest_level` parts, or as many
/// arrays and inline tables lie in each other; 0: there is none. Of a text that is no TOML it looks at least
/// as far as a parser would.
int first_line_too_deep(std::string_view text);

}  // namespace drumlin
