#include "apps/json/json_file.hpp"

#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

void write_json(const std::filesystem::path& file, const Json& content) {
  // The library writes NaN and infinity as null, which is what the formats ask for. A name of others may be
  // no UTF-8: it stands there with the sign for an unknown letter.
  replace_file(file, content.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void add_accepted_edits(Json& provenance, const std::vector<std::string>& edits) {
  if (!edits.empty()) provenance["accepted_edits"] = edits;
}

Json to_json(const Scalar& scalar) {
  if (!scalar.ci99) return number_or_null(scalar.value);
  return {{"value", number_or_null(scalar.value)}, {"ci99", number_or_null(*scalar.ci99)}};
}

void add_scalars(Json& content, const ScalarSet& scalars) {
  for (const auto& scalar : scalars.scalars) content[scalar.name] = to_json(scalar);
}

}  // namespace drumlin::apps
