#include "coupling/documents/json_document.hpp"

#include <nlohmann/json.hpp>

#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"

namespace drumlin {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& file, const std::string& format) {
  Json content;
  try {
    content = Json::parse(file_text(file));
  } catch (const Json::exception& error) {  // out of range, too: 1e999
    throw InputError(file.string() + ": is no JSON: " + error.what());
  }
  const bool known = content.is_object() && content.contains("format") && content["format"] == format;
  if (!known)
    throw InputError(file.string() + ": format: is missing or not known here (allowed: \"" + format + "\")");
  return content;
}

std::string plain_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace drumlin
