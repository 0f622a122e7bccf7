#include "coupling/core/results/scalar_set.hpp"

#include <nlohmann/json.hpp>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_document.hpp"
#include "coupling/core/documents/json_numbers.hpp"

namespace drumlin {

const Scalar* ScalarSet::find(const std::string& name) const {
  for (const auto& scalar : scalars)
    if (scalar.name == name) return &scalar;
  return nullptr;
}

double ScalarSet::value(const std::string& name) const {
  if (const auto* found = find(name)) return found->value;
  throw InputError("the results have no scalar " + name);
}

ScalarSet read_scalars(const std::filesystem::path& json_file, const std::string& format) {
  const nlohmann::ordered_json json = read_json(json_file, format);
  const auto refuse = [&](const std::string& key, const std::string& what, const std::string& allowed) {
    throw InputError({InputProblem{json_file.string(), 0, 0, key, what, allowed}});
  };
  ScalarSet set;
  for (const auto& [name, value] : json.items()) {
    if (const auto number = number_or_nan(value)) {
      set.scalars.push_back({name, *number, std::nullopt});
    } else if (value.is_object() && value.contains("value")) {
      const auto number_inside = number_or_nan(value["value"]);
      if (!number_inside) refuse(name + ".value", value["value"].dump(), "a number or null");
      Scalar scalar{name, *number_inside, std::nullopt};
      if (value.contains("ci99")) {
        scalar.ci99 = number_or_nan(value["ci99"]);
        if (!scalar.ci99) refuse(name + ".ci99", value["ci99"].dump(), "a number or null");
      }
      set.scalars.push_back(scalar);
    }
  }
  return set;
}

}  // namespace drumlin
