#include "coupling/core/documents/described.hpp"

#include "coupling/core/documents/one_line.hpp"

namespace drumlin {

void JsonReader::read(const Json& json, const std::string& key, std::string& target) {
  if (expect(json.is_string(), json, key, "a text")) target = json.get<std::string>();
}

void JsonReader::read(const Json& json, const std::string& key, Line&) {
  expect(json.is_string() && fault_of_line(json.get_ref<const std::string&>(), std::string::npos).empty(),
         json, key, "a text of one line");
}

bool JsonReader::expect(bool holds, const Json& json, const std::string& key, const char* allowed) {
  const auto shortened = [](std::string text) {
    constexpr std::size_t enough = 60;
    if (text.size() > enough) text = text.substr(0, enough) + "...";
    return text;
  };
  if (!holds)
    problems.push_back({file, 0, 0, shortened(key.substr(1)),
                        json.is_discarded() ? "is missing" : "is " + shortened(json.dump()), allowed});
  return holds;
}

}  // namespace drumlin
