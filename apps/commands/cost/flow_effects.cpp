// drumlin cost --effects FLOW_SCENE: the flow without any effect, with each alone, and as it is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/flow_points.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/exchange/document.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "coupling/exchange/toml_text.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Effect {
  const char* name;
  const char* change;  ///< as for --set, at the strength that a scene without it gets
  bool needs_k;
};
// k is a part of the law: it has no change of the scene.
const std::vector<Effect> effects = {{"inertia", "effects.inertia={}", false},
                                     {"wall_slip", "effects.wall_slip={friction=0.95}", false},
                                     {"rotating_frame", "effects.rotating_frame={}", false},
                                     {"k", "", true},
                                     {"fabric", "effects.fabric={relaxation=1}", true},
                                     {"nonlocal", "effects.nonlocal={length=1}", false},
                                     {"moving_surface", "effects.moving_surface={}", false}};

void erase(Node& table, const std::string& key) {
  auto& entries = std::get<Node::Table>(table.value);
  std::erase_if(entries, [&](const auto& entry) { return entry.first == key; });
}

// The plain scene and law, as files beside the points.
struct Plain {
  fs::path scene, law;
  std::vector<std::pair<std::string, Node>> named;  ///< effects of the scene, with their keys
  bool law_has_k = false;
};

Plain plain_files(const CostOptions& options, const PointStore& store) {
  Plain plain{store.beside("plain-scene.toml"), store.beside("plain-law.toml"), {}, false};
  Document scene = read_toml(options.scene, options.overrides);
  if (const Node* table = scene.root.find("effects"))
    if (const auto* entries = std::get_if<Node::Table>(&table->value)) plain.named = *entries;
  erase(scene.root, "effects");
  replace_file(plain.scene, toml_text(scene.root));
  Document law = read_toml(*options.rheology);
  plain.law_has_k = law.root.find("k") != nullptr;
  erase(law.root, "k");
  replace_file(plain.law, toml_text(law.root));
  return plain;
}

std::vector<std::string> changes_for(const Effect& effect, const Plain& plain) {
  std::vector<std::string> changes;
  for (const auto& [name, node] : plain.named)
    if (name == effect.name) {
      changes.push_back(fmt::format("effects.{}={}", name, toml_value(node)));
      return changes;
    }
  if (*effect.change != '\0') changes.emplace_back(effect.change);
  return changes;
}

Json row_of(const std::string& name, const Json& point, const Json& base) {
  Json row{{"effect", name}};
  for (const char* key :
       {"changes", "load_before", "unknowns", "iterations", "seconds", "cpu_seconds", "scalars", "failure"})
    if (point.contains(key)) row[key] = point.at(key);
  if (point.contains("failure")) return row;
  Json change = Json::object();
  for (const auto& [scalar, value] : scalars_of(base))
    if (point.at("scalars").contains(scalar) && point.at("scalars").at(scalar).is_number())
      change[scalar] = point.at("scalars").at(scalar).get<double>() - value;
  row["change"] = change;
  row["v_x_change"] = relative_differences(point, base).at("v_x");
  return row;
}

void print(const Json& row) {
  if (row.contains("refused") || row.contains("failure")) {
    fmt::print("{:<16} {}\n", row.at("effect").get<std::string>(),
               row.contains("refused") ? row.at("refused").get<std::string>()
                                       : row.at("failure").get<std::string>());
    return;
  }
  fmt::print("{:<16} {:8.1f} s {:6}", row.at("effect").get<std::string>(),
             row.at("cpu_seconds").get<double>(), row.at("iterations").get<int>());
  for (const auto& [name, change] : row.at("change").items())
    fmt::print("  {} {:.4g} ({:+.2g})", name, row.at("scalars").at(name).get<double>(), change.get<double>());
  if (row.at("v_x_change").is_number())
    fmt::print("  v_x {:.2g} %", 100 * row.at("v_x_change").get<double>());
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int price_flow_effects(const CostOptions& options) {
  if (!options.output) throw InputError("cost: the effects of a flow need --output COST for its points");
  prepare_output(*options.output, options.existing, {"sweep.json", "cost.json"},
                 {options.scene, *options.rheology});
  const PointStore store(*options.output,
                         {{"kind", "continuum effects"},
                          {"scene", toml_text(read_toml(options.scene, options.overrides).root)},
                          {"rheology", file_text(*options.rheology)}});
  catch_interruptions();
  const Plain plain = plain_files(options, store);
  fmt::print("{}: processor seconds, iterations, scalars (what the effect changes)\n",
             options.scene.string());
  Json rows = Json::array();
  const auto add = [&](Json row) {
    print(row);
    rows.push_back(std::move(row));
  };
  const Json base = solved_point(store, {"none", plain.scene, plain.law, {}});
  if (base.contains("failure")) throw NotConvergedError("without any effect the flow did not converge");
  add(row_of("none", base, base));
  for (const Effect& effect : effects) {
    if (effect.needs_k && !plain.law_has_k) {
      add({{"effect", effect.name}, {"refused", "the law has no table [k]"}});
      continue;
    }
    const fs::path law = effect.needs_k ? *options.rheology : plain.law;
    add(row_of(effect.name, solved_point(store, {effect.name, plain.scene, law, changes_for(effect, plain)}),
               base));
  }
  if (!plain.named.empty() || plain.law_has_k) {
    add(row_of("as it is",
               solved_point(store, {"as-it-is", options.scene, *options.rheology, options.overrides}), base));
  }
  // What differs between the two is noise of the machine.
  add(row_of("none, again", solved_point(store, {"none-again", plain.scene, plain.law, {}}), base));

  Json report{{"format", "drumlin-flow-effect-prices-1"}, {"title", base.at("settings").at("title")}};
  const Document document = read_toml(options.scene, options.overrides);
  const Node* reduced = document.root.find("reduced");
  report["reduced"] =
      reduced != nullptr && std::get_if<bool>(&reduced->value) != nullptr && std::get<bool>(reduced->value);
  report["scene_file"] = options.scene.filename().string();
  report["law"] = base.at("settings").at("law");
  report["effects"] = rows;
  report["provenance"] = to_json(provenance());
  const fs::path unfinished = *options.output / "cost.json.part";
  write_json(unfinished, report);
  draw_figures("flow_price_figures.py", {unfinished.string(), (*options.output / "prices.png").string()});
  fs::remove(unfinished);
  write_json(*options.output / "cost.json", report);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
