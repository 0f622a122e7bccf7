// drumlin cost --effects FLOW_SCENE: the flow without any effect, with each alone or some together, and as it
// is; on request against measured runs.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/flow_points.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/accuracy/flow_variants.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/common/unfinished_file.hpp"
#include "coupling/documents/document.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "coupling/documents/toml_text.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void erase(Node& table, const std::string& key) {
  auto& entries = std::get<Node::Table>(table.value);
  std::erase_if(entries, [&](const auto& entry) { return entry.key == key; });
}

// The plain scene and law, as files beside the points.
struct Plain {
  fs::path scene, law;
  std::vector<std::pair<std::string, std::string>> named;  ///< effects of the scene, as changes for --set
  bool law_has_k = false;
};

Plain plain_files(const CostOptions& options, const PointStore& store) {
  Plain plain{store.beside("plain-scene.toml"), store.beside("plain-law.toml"), {}, false};
  Document scene = read_toml(options.scene, options.overrides);
  if (const Node* table = scene.root.find("effects"))
    if (const auto* entries = std::get_if<Node::Table>(&table->value))
      for (const auto& [name, keys] : *entries)
        plain.named.emplace_back(name, fmt::format("effects.{}={}", name, toml_value(keys)));
  erase(scene.root, "effects");
  replace_file(plain.scene, toml_text(scene.root));
  Document law = read_toml(*options.rheology);
  plain.law_has_k = law.root.find("k") != nullptr;
  erase(law.root, "k");
  replace_file(plain.law, toml_text(law.root));
  return plain;
}

Json row_of(const std::string& name, const Json& point, const Json& base) {
  Json row{{"effect", name}};
  for (const char* key : {"changes", "load_before", "unknowns", "iterations", "seconds", "cpu_seconds",
                          "scalars", "failure", "against"})
    if (point.contains(key)) row[key] = point.at(key);
  if (point.contains("failure")) return row;
  const coupling::EffectChanges changes =
      coupling::effect_changes(numbers_of_point(point), numbers_of_point(base));
  row["change"] = json_of(changes.scalars);
  row["v_x_change"] = number_or_null(changes.v_x);
  return row;
}

/// The errors against the measured runs, a star where a target is missed.
void print_errors(const Json& against) {
  print_out("\n    ");
  for (const Json& target : against.at("targets")) {
    if (!target.at("value").is_number()) continue;
    print_out(fmt::format("  {}{} {:.3f}{}", target.at("quantity").get<std::string>(),
                          target.contains("zone") ? " " + target.at("zone").get<std::string>() : "",
                          target.at("value").get<double>(), target.at("outcome") == "missed" ? "*" : ""));
  }
  const Json& verdict = against.at("verdict");
  print_out(
      fmt::format("  ({} met, {} missed)", verdict.at("met").get<int>(), verdict.at("missed").get<int>()));
}

void print(const Json& row) {
  if (row.contains("refused") || row.contains("failure")) {
    print_out(fmt::format("{:<16} {}\n", row.at("effect").get<std::string>(),
                          row.contains("refused") ? row.at("refused").get<std::string>()
                                                  : row.at("failure").get<std::string>()));
    return;
  }
  print_out(fmt::format("{:<16} {:8.1f} s {:6}", row.at("effect").get<std::string>(),
                        row.at("cpu_seconds").get<double>(), row.at("iterations").get<int>()));
  for (const auto& [name, change] : row.at("change").items())
    print_out(fmt::format("  {} {:.4g} ({:+.2g})", name, row.at("scalars").at(name).get<double>(),
                          change.get<double>()));
  if (row.at("v_x_change").is_number())
    print_out(fmt::format("  v_x {:.2g} %", 100 * row.at("v_x_change").get<double>()));
  if (row.contains("against")) print_errors(row.at("against"));
  print_out("\n");
  flush_out();
}

/// The flows of the list, one after the other, and what each changes.
class FlowPrices {
 public:
  FlowPrices(const CostOptions& options, const PointStore& store)
      : options_(options), store_(store), plain_(plain_files(options, store)) {}

  int execute() {
    print_out(fmt::format("{}: processor seconds, iterations, scalars (what the effect changes)\n",
                          options_.scene.string()));
    const FlowToSolve without = flow("none", plain_.scene, plain_.law, {});
    base_ = solved_point(store_, without);
    if (base_.contains("failure"))
      throw NotConvergedError("without any effect: " + base_.at("failure").get<std::string>());
    add("none", without);
    for (const coupling::FlowVariant& variant : coupling::flow_variants(options_.variants)) add(variant);
    if (!plain_.named.empty() || plain_.law_has_k)
      add("as it is", flow("as-it-is", options_.scene, *options_.rheology, options_.overrides));
    // What differs between the two is noise of the machine.
    add("none, again", flow("none-again", plain_.scene, plain_.law, {}));
    write_report();
    return static_cast<int>(ExitCode::done);
  }

 private:
  FlowToSolve flow(const std::string& name, const fs::path& scene, const fs::path& law,
                   const std::vector<std::string>& changes) const {
    FlowToSolve one{name, scene, law, changes};
    one.time_limit_s = options_.time_limit_s;
    one.against = options_.against;
    return one;
  }

  void add(const coupling::FlowVariant& variant) {
    if (variant.effects.empty()) return;  // the one without any stands first
    if (variant.needs_k() && !plain_.law_has_k) {
      rows_.push_back({{"effect", variant.name}, {"refused", "the law has no table [k]"}});
      print(rows_.back());
      return;
    }
    add(variant.name, flow(variant.name, plain_.scene, variant.needs_k() ? *options_.rheology : plain_.law,
                           variant.changes(plain_.named)));
  }

  void add(const std::string& name, const FlowToSolve& one) {
    const Json point = solved_point(store_, one);
    Json row = row_of(name, point, base_);
    print(row);
    if (asks_for_work(options_)) row["work"] = work_of(store_, one, point, options_);
    rows_.push_back(std::move(row));
  }

  void write_report() const {
    Json report{{"format", "drumlin-flow-effect-prices-1"}, {"title", base_.at("settings").at("title")}};
    const Document document = read_toml(options_.scene, options_.overrides);
    const Node* reduced = document.root.find("reduced");
    report["reduced"] =
        reduced != nullptr && std::get_if<bool>(&reduced->value) != nullptr && std::get<bool>(reduced->value);
    report["scene_file"] = options_.scene.filename().string();
    report["law"] = base_.at("settings").at("law");
    for (const fs::path& run : options_.against) report["against"].push_back(run.filename().string());
    report["effects"] = rows_;
    report["provenance"] = to_json(provenance());
    const UnfinishedFile unfinished(*options_.output / "cost.json.part");
    write_json(unfinished.path(), report);
    draw_figures("flow_price_figures.py",
                 {unfinished.path().string(), (*options_.output / "prices.png").string()});
    if (!options_.against.empty())
      draw_figures("flow_effect_figures.py",
                   {unfinished.path().string(), (*options_.output / "effects.png").string()});
    write_json(*options_.output / "cost.json", report);
    store_.finish();
  }

  const CostOptions& options_;
  const PointStore& store_;
  Plain plain_;
  Json base_, rows_ = Json::array();
};

}  // namespace

int price_flow_effects(const CostOptions& options) {
  if (!options.output) throw InputError("cost: the effects of a flow need --output COST for its points");
  (void)coupling::flow_variants(options.variants);
  GrowingOutput output = cost_output(*options.output, options.existing, {options.scene, *options.rheology});
  const PointStore store(output, shared_by_flows("continuum effects", options));
  const CaughtInterruptions caught;
  return FlowPrices(options, store).execute();
}

}  // namespace drumlin::apps
