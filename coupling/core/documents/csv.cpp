#include "coupling/core/documents/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "coupling/core/documents/number_text.hpp"

namespace drumlin {

std::string csv_number(double value) { return std::isnan(value) ? std::string() : fmt::format("{}", value); }

std::string csv_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : std::string();
}

std::string csv_text(std::string_view text) {
  const bool begins_a_formula = !text.empty() && std::string_view("=+@").find(text.front()) != text.npos;
  if (!begins_a_formula && text.find_first_of(",\"") == text.npos && trimmed(text) == text)
    return std::string(text);
  std::string quoted = "\"";
  for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted + '"';
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (&field == &fields.front() ? "" : ",") + csv_text(field);
  return line + "\n";
}

std::string_view trimmed(std::string_view text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

namespace {

/// Place of the quote that closes the field at the beginning of the line; 0: it is not quoted.
std::size_t closing_quote(std::string_view line) {
  if (!line.starts_with('"')) return 0;
  std::size_t quote = line.find('"', 1);
  while (quote != line.npos && line.substr(quote + 1).starts_with('"')) quote = line.find('"', quote + 2);
  if (quote == line.npos) return 0;
  const std::string_view behind = trimmed(line.substr(quote + 1));
  return behind.empty() || behind.front() == ',' ? quote : 0;
}

}  // namespace

void csv_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t quote = closing_quote(line);
    const auto comma = line.find(',', quote);
    fields.push_back(quote > 0 ? line.substr(1, quote - 1) : trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::string_view> csv_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  csv_fields(line, fields);
  return fields;
}

std::optional<double> finite_number(std::string_view field) {
  const auto value = parsed_number<double>(field);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> csv_value(std::string_view field) {
  return field.empty() ? std::numeric_limits<double>::quiet_NaN() : finite_number(field);
}

}  // namespace drumlin
