#include "coupling/core/documents/number_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

[[noreturn]] void refuse(std::string_view text, const TextPlace& place, const char* allowed) {
  throw InputError(
      {InputProblem{place.file, place.line, 0, place.key, fmt::format("is \"{}\"", text), allowed}});
}

}  // namespace

double checked_number(std::string_view text, const TextPlace& place) {
  const auto value = parsed_number<double>(text);
  if (!value || !std::isfinite(*value)) refuse(text, place, "a finite number");
  return *value;
}

int checked_count(std::string_view text, const TextPlace& place) {
  const auto value = parsed_number<int>(text);
  if (!value || *value < 0) refuse(text, place, "a whole number from 0 up");
  return *value;
}

}  // namespace drumlin
