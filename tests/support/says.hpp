#pragma once
// What texts and errors say.
#include <gtest/gtest.h>

#include <source_location>
#include <string>
#include <string_view>

namespace drumlin {

using Place = std::source_location;

inline void expect_has(std::string_view text, std::string_view part, const Place& at = Place::current()) {
  if (text.find(part) == text.npos)
    ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << '"' << part << "\" is not in: " << text;
}

inline void expect_lacks(std::string_view text, std::string_view part, const Place& at = Place::current()) {
  if (text.find(part) != text.npos)
    ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << '"' << part << "\" is in: " << text;
}

/// The message of the error that `action` throws.
template <class Error, class Action>
std::string message_of(Action action, const Place& at = Place::current()) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE_AT(at.file_name(), static_cast<int>(at.line())) << "nothing was refused";
  return {};
}

}  // namespace drumlin
