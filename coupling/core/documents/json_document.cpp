#include "coupling/core/documents/json_document.hpp"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"

namespace drumlin {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::uint64_t largest_file = std::uint64_t{64} << 20;  // bytes; a long record has 1 MB
// What is written again is written level by level, each on the stack; keys are compared one by one.
constexpr int deepest = 32;
constexpr int most_keys = 10000;

}  // namespace

Json parse_json(const std::string& text, const std::string& name) {
  std::array<int, deepest + 2> keys{};  // of the table that is open at each level
  const auto watch = [&](int depth, Json::parse_event_t event, Json&) {
    if (depth > deepest) throw InputError(fmt::format("{}: is deeper than {} levels", name, deepest));
    if (event == Json::parse_event_t::object_start) keys[static_cast<std::size_t>(depth) + 1] = 0;
    if (event == Json::parse_event_t::key && ++keys[static_cast<std::size_t>(depth)] > most_keys)
      throw InputError(fmt::format("{}: holds a table of more than {} keys", name, most_keys));
    return true;
  };
  try {
    return Json::parse(text, watch);
  } catch (const Json::exception& error) {  // out of range, too: 1e999
    throw InputError(name + ": is no JSON: " + error.what());
  }
}

Json read_json(const std::filesystem::path& file, const std::string& format) {
  Json content = parse_json(input_text(file, largest_file), file.string());
  const bool known = content.is_object() && content.contains("format") && content["format"] == format;
  if (!known)
    throw InputError(file.string() + ": format: is missing or not known here (allowed: an object with \"" +
                     format + "\")");
  return content;
}

}  // namespace drumlin
