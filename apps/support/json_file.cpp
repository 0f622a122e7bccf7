#include "apps/support/json_file.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {

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

void write_json(const std::filesystem::path& file, const Json& content) {
  // The library writes NaN and infinity as null, which is what the formats ask for.
  replace_file(file, content.dump(2) + "\n");
}

namespace {

/// In memory, too, what was not computed is null: a reader of the object need not know about NaN.
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

}  // namespace

Json to_json(const Scalar& scalar) {
  if (!scalar.ci99) return number_or_null(scalar.value);
  return {{"value", number_or_null(scalar.value)}, {"ci99", number_or_null(*scalar.ci99)}};
}

Json to_json(const Provenance& provenance) {
  return {{"revision", provenance.revision},
          {"compiler", provenance.compiler},
          {"build_type", provenance.build_type},
          {"machine", provenance.machine},
          {"processors", provenance.processors}};
}

Json to_json(const Scales& scales) {
  return {{"length_m", scales.length_m}, {"time_s", scales.time_s}, {"density_kg_m3", scales.density_kg_m3}};
}

void add_scalars(Json& content, const ScalarSet& scalars) {
  for (const auto& scalar : scalars.scalars) content[scalar.name] = to_json(scalar);
}

}  // namespace drumlin::apps
