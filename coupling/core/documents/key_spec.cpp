#include "coupling/core/documents/key_spec.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace drumlin {

namespace {

std::string interval_text(const Allowed& allowed) {
  const auto [min, max] = std::pair(allowed.min, allowed.max);
  const bool below = std::isfinite(min), over = std::isfinite(max);
  if (!below && !over) return "any finite";
  if (!over) return fmt::format("{} {}", allowed.min_open ? ">" : ">=", min);
  if (!below) return fmt::format("{} {}", allowed.max_open ? "<" : "<=", max);
  return fmt::format("{}{} to {}{}", allowed.min_open ? "above " : "", min, allowed.max_open ? "below " : "",
                     max);
}

std::string choices_text(const Allowed& allowed) {
  if (allowed.longest < Allowed().longest)
    return fmt::format("one line, at most {} characters", allowed.longest);
  if (allowed.choices.empty()) return allowed.may_be_empty ? "any" : "not empty";
  std::string text;
  for (const auto& word : allowed.choices) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
  return text;
}

/// What is above 0 in a unit of nature is at least this: squares and quotients of it stay finite.
double least_in(const std::string& unit) {
  static const std::map<std::string, double> least = {
      {"mm", 1e-9},   {"m", 1e-12},   {"s", 1e-12},    {"mm/s", 1e-12}, {"kg", 1e-18},  {"kg/m", 1e-15},
      {"Pa", 1e-9},   {"N/m2", 1e-9}, {"1/s", 1e-12},  {"Hz", 1e-12},   {"rpm", 1e-12}, {"turns", 1e-12},
      {"m/s2", 1e-9}, {"d", 1e-15},   {"kg/m3", 1e-6}, {"deg", 1e-9}};
  const auto found = least.find(unit);
  return found == least.end() ? 0 : found->second;
}

KeySpec spec_of(Need need, std::string unit, Allowed allowed, std::string sentence) {
  const double least = least_in(unit);
  if (allowed.min == 0 && allowed.min_open && least > 0) allowed.min = least, allowed.min_open = false;
  return {need, std::move(unit), std::move(allowed), std::move(sentence)};
}

}  // namespace

bool Allowed::holds(double number) const {
  return std::isfinite(number) && (min_open ? number > min : number >= min) &&
         (max_open ? number < max : number <= max);
}

std::string allowed_text(const std::string& type, const Allowed& allowed) {
  if (type == "true or false") return "";
  return type.find("number") != std::string::npos || type == "integer" ? interval_text(allowed)
                                                                       : choices_text(allowed);
}

Allowed anything() {
  Allowed allowed;
  allowed.may_be_empty = true;
  return allowed;
}

Allowed above(double min, double max) {
  Allowed allowed = at_least(min, max);
  allowed.min_open = true;
  return allowed;
}

Allowed at_least(double min, double max) {
  Allowed allowed;
  allowed.min = min;
  allowed.max = max;
  return allowed;
}

Allowed not_empty() { return {}; }

Allowed title_line() {
  Allowed allowed = anything();
  allowed.longest = 200;
  return allowed;
}

Allowed one_of(std::vector<std::string> words) {
  Allowed allowed;
  allowed.choices = std::move(words);
  return allowed;
}

KeySpec required(std::string unit, Allowed allowed, std::string sentence) {
  return spec_of(Need::required, std::move(unit), std::move(allowed), std::move(sentence));
}

KeySpec defaulted(std::string unit, Allowed allowed, std::string sentence) {
  return spec_of(Need::defaulted, std::move(unit), std::move(allowed), std::move(sentence));
}

KeySpec when_given(std::string unit, Allowed allowed, std::string sentence) {
  return spec_of(Need::optional, std::move(unit), std::move(allowed), std::move(sentence));
}

}  // namespace drumlin
