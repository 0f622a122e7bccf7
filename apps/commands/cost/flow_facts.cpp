#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/cost/cost.hpp"
#include "coupling/core/documents/document.hpp"
#include "coupling/core/documents/toml_text.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

std::string text_without(Node table, const std::string& key) {
  std::erase_if(std::get<Node::Table>(table.value), [&](const auto& entry) { return entry.key == key; });
  return toml_text(table);
}

}  // namespace

Json flow_facts(const CostOptions& options) {
  const Node scene = read_toml(options.scene, options.overrides).root;
  const Node law = read_toml(*options.rheology).root;
  const Node* reduced = scene.find("reduced");
  const bool* is_reduced = reduced != nullptr ? std::get_if<bool>(&reduced->value) : nullptr;
  Json named = Json::object();
  if (const Node* effects = scene.find("effects"))
    if (const auto* entries = std::get_if<Node::Table>(&effects->value))
      for (const auto& [name, keys] : *entries)
        named[name] = fmt::format("effects.{}={}", name, toml_value(keys));
  return {{"kind", "continuum"},
          {"reduced", is_reduced != nullptr && *is_reduced},
          {"scene", toml_text(scene)},
          {"law", file_text(*options.rheology)},
          {"plain_scene", text_without(scene, "effects")},
          {"plain_law", text_without(law, "k")},
          {"law_has_k", law.find("k") != nullptr},
          {"named", named}};
}

}  // namespace drumlin::apps
