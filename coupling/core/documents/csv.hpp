#pragma once
// Tables of numbers as text: fields between commas, one line per row, empty where a number was not computed.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drumlin {

/// Shortest digits that read back as the same number; empty for NaN.
std::string csv_number(double value);
/// At most so many significant digits, for tables whose numbers carry no more; empty for what is not finite.
std::string csv_number(double value, int digits);

/// A text as a field: in quotes where it begins with =, + or @, which spreadsheets would compute, holds
/// commas or quotes (then written twice), or has blanks at an end.
std::string csv_text(std::string_view text);
/// The fields, each as a text, with commas between them, and the end of the line.
std::string csv_line(const std::vector<std::string>& fields);

/// Without spaces, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text);
/// The fields of a line, trimmed or what stands between their quotes, as it stands there; of an empty line
/// one empty field. They live as long as the line.
std::vector<std::string_view> csv_fields(std::string_view line);
/// The same into a list that keeps its memory from line to line.
void csv_fields(std::string_view line, std::vector<std::string_view>& fields);

/// The finite number that the whole field is; nothing for any other text, an empty one included.
std::optional<double> finite_number(std::string_view field);
/// The same, and NaN for an empty field: a number that was not computed.
std::optional<double> csv_value(std::string_view field);

}  // namespace drumlin
