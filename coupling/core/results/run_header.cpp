#include "coupling/core/results/run_header.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/documents/number_text.hpp"

namespace drumlin {
namespace {

/// The one list of keys: visits each typed member with its key.
template <class Header, class Visit>
void visit_keys(Header& header, const Visit& visit) {
  visit("side", header.side);
  visit("reduced", header.reduced);
  visit("title", header.title);
  visit("geometry", header.geometry);
  visit("revision", header.revision);
  visit("theta_deg", header.theta_deg);
  visit("axis_depth", header.axis_depth);
  visit("wall_z", header.wall_z);
  visit("rotation", header.rotation);
  visit("drum_radius", header.drum_radius);
  visit("diameter_m", header.diameter_m);
  visit("inner_radius", header.inner_radius);
  visit("outer_radius", header.outer_radius);
  visit("gap", header.gap);
  visit("position", header.position);
  visit("slice_width", header.slice_width);
  visit("layer_thickness", header.layer_thickness);
  visit("H", header.H);
  visit("snapshots", header.snapshots);
  visit("batches", header.batches);
  visit("interval_factor", header.interval_factor);
  visit("band", header.band);
  visit("kernel", header.kernel);
  visit("kernel_width", header.kernel_width);
}

template <Named E>
std::string text_of(E value) {
  return name_of(value);
}
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const std::string& text) { return text; }
std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(std::size_t count) { return std::to_string(count); }

/// Reads a value; returns what would be allowed where the text is none.
template <Named E>
std::string read_value(std::string_view text, std::optional<E>& value) {
  value = enumerator<E>(text);
  return value ? "" : fmt::format("{}", fmt::join(names_of(E{}), ", "));
}
std::string read_value(std::string_view text, std::optional<bool>& value) {
  if (text == "true" || text == "false") value = text == "true";
  return value ? "" : "true, false";
}
std::string read_value(std::string_view text, std::optional<std::string>& value) {
  value = std::string(text);
  return "";
}
std::string read_value(std::string_view text, std::optional<double>& value) {
  value = parsed_number<double>(text);
  if (value && !(std::abs(*value) > largest_value)) return "";
  return fmt::format("a number of at most {:g} from 0, or nan where it was not measured", largest_value);
}
std::string read_value(std::string_view text, std::optional<std::size_t>& value) {
  value = parsed_number<std::size_t>(text);
  return value ? "" : "a whole number from 0 up";
}

/// Puts the value into the member of that key; what would be allowed where it is none.
std::string read_entry(RunHeader& header, const std::string& key, std::string_view text) {
  std::string allowed;
  bool known = false;
  visit_keys(header, [&](const char* name, auto& member) {
    if (key != name) return;
    known = true;
    allowed = read_value(text, member);
  });
  if (!known) header.further[key] = std::string(text);
  return allowed;
}

}  // namespace

std::string key_of(HeaderNumber number) {
  std::string key;
  const RunHeader header;
  visit_keys(header, [&](const char* name, const auto& member) {
    if (static_cast<const void*>(&member) == static_cast<const void*>(&(header.*number))) key = name;
  });
  return key;
}

RunHeader header_of_maps(RunHeader profile) {
  profile.position = profile.slice_width = profile.layer_thickness = profile.wall_z = std::nullopt;
  return profile;
}

double number_or_nan(const RunHeader& header, HeaderNumber number) {
  return (header.*number).value_or(std::numeric_limits<double>::quiet_NaN());
}

double needed_number(const RunHeader& header, HeaderNumber number, const std::string& file) {
  const auto& value = header.*number;
  if (!value || !std::isfinite(*value))
    throw InputError(
        {InputProblem{file, 0, 0, key_of(number), value ? text_of(*value) + " is no number" : "is missing",
                      "a finite number"}});
  return *value;
}

std::map<std::string, std::string> header_texts(const RunHeader& header) {
  std::map<std::string, std::string> texts = header.further;
  visit_keys(header, [&](const char* key, const auto& member) {
    if (member) texts[key] = text_of(*member);
  });
  return texts;
}

std::optional<std::string> header_text(const RunHeader& header, const std::string& key) {
  const auto texts = header_texts(header);
  const auto found = texts.find(key);
  return found == texts.end() ? std::nullopt : std::optional(found->second);
}

std::string header_lines(const RunHeader& header, std::string_view prefix) {
  std::string lines;
  for (const auto& [key, text] : header_texts(header))
    lines.append(prefix).append(key).append(" = ").append(text).append("\n");
  return lines;
}

std::string fault_of(const RunHeader& header) {
  for (const auto& [key, text] : header_texts(header))
    if (key.empty() || key.find_first_of("=\n") != std::string::npos || text.find('\n') != std::string::npos)
      return fmt::format("\"{}\" cannot be in the header: one line, no = in the key", key);
  std::string fault;
  visit_keys(header, [&]<class T>(const char* key, const std::optional<T>& member) {
    if constexpr (std::is_floating_point_v<T>)
      if (member && std::abs(*member) > largest_value)
        fault = fmt::format("{} of the header is {}", key, *member);
  });
  for (const auto& [key, text] : header.further)
    visit_keys(header, [&, &key = key](const char* name, const auto&) {
      if (key == name) fault = fmt::format("{} appears twice in the header", key);
    });
  return fault;
}

RunHeader read_header(const std::vector<HeaderLine>& lines, const std::string& file) {
  RunHeader header;
  std::vector<InputProblem> problems;
  std::set<std::string> keys;
  for (const HeaderLine& line : lines) {
    const auto equals = line.text.find('=');
    const std::string key(trimmed(line.text.substr(0, equals)));
    if (equals == std::string_view::npos || key.empty()) {
      problems.push_back({file, line.line, 0, key, "is no header line", "key = value"});
      continue;
    }
    if (!keys.insert(key).second) {
      problems.push_back({file, line.line, 0, key, "appears twice", "each key once"});
      continue;
    }
    const std::string_view text = trimmed(line.text.substr(equals + 1));
    const std::string allowed = read_entry(header, key, text);
    if (!allowed.empty())
      problems.push_back({file, line.line, 0, key, fmt::format("is \"{}\"", text), allowed});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return header;
}

}  // namespace drumlin
