// drumlin cost FLOW_SCENE: meshes, eps and tolerances of a flow, compared by its scalars and its profile of
// v_x.
#include "coupling/accuracy/flow_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/commands/cost/advice.hpp"
#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/flow_points.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/unfinished_file.hpp"
#include "coupling/documents/document.hpp"
#include "coupling/documents/toml_text.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class FlowSweep {
 public:
  FlowSweep(const CostOptions& options, const PointStore& store) : options_(options), store_(store) {}

  int execute() {
    const auto axes = coupling::sweep_axes(options_.sweep, coupling::flow_axes());
    print_out(fmt::format("{}: the scene as it is\n", options_.scene.string()));
    flush_out();
    const Json as_it_is = solved_point(store_, flow("as-it-is", {}));
    if (as_it_is.contains("failure"))
      throw NotConvergedError(options_.scene.string() + ": " + as_it_is.at("failure").get<std::string>());
    const Json& settings = as_it_is.at("settings");
    standard_ = {settings.at("levels"), settings.at("regularisation_shear_rate"), settings.at("tolerance")};
    surface_cell_ = settings.at("surface_cell");
    const std::vector<coupling::SweepCurve> curves = coupling::sweep_curves(standard_, axes);
    Json points = Json::array();
    for (const coupling::SweepCurve& curve : curves)
      for (const coupling::FlowSettings& s : curve.points) add_point(points, s, curve.axis, as_it_is);
    const Json reference = as_it_is.contains("closed_form") ? Json(nullptr) : reference_of(curves);
    const std::vector<std::string> quantities = add_errors(points, curves, reference);
    mark_fronts(points, quantities);
    print(points, quantities);
    print_out(advice_text(points, quantities, [this](const Json& point) {
      const coupling::FlowSettings s{point.at("levels"), point.at("eps"), point.at("tolerance")};
      return "--set " +
             fmt::format("{}", fmt::join(coupling::changes_of(s, standard_, surface_cell_), " --set "));
    }));
    write_report(as_it_is, reference, points, quantities);
    return static_cast<int>(ExitCode::done);
  }

 private:
  FlowToSolve flow(const std::string& name, std::vector<std::string> changes) const {
    changes.insert(changes.begin(), options_.overrides.begin(), options_.overrides.end());
    FlowToSolve one{name, options_.scene, *options_.rheology, changes};
    one.time_limit_s = options_.time_limit_s;
    return one;
  }

  FlowToSolve flow_with(const coupling::FlowSettings& s) const {
    if (s == standard_) return flow("as-it-is", {});
    return flow(name_of(s), coupling::changes_of(s, standard_, surface_cell_));
  }

  void add_point(Json& points, const coupling::FlowSettings& s, const std::string& axis,
                 const Json& as_it_is) {
    const std::string name = name_of(s);
    for (std::size_t i = 0; i < swept_.size(); ++i)
      if (swept_[i].settings == s) {
        points[i]["axes"].push_back(axis);
        swept_[i].axes.push_back(axis);
        return;
      }
    Json point{{"name", name}, {"default", s == standard_}, {"axes", {axis}}, {"levels", s.levels},
               {"eps", s.eps}, {"tolerance", s.tolerance}};
    const Json found = s == standard_ ? as_it_is : solved_point(store_, flow_with(s));
    for (const char* key : {"unknowns", "iterations", "seconds", "cpu_seconds", "load_before", "scalars",
                            "closed_form", "failure"})
      if (found.contains(key)) point[key] = found.at(key);
    print_out(fmt::format(
        "{:>9} s  {}{}\n",
        found.at("cpu_seconds").is_number() ? fmt::format("{:.2f}", found.at("cpu_seconds").get<double>())
                                            : "-",
        name, found.contains("failure") ? ": " + found.at("failure").get<std::string>() : ""));
    flush_out();
    if (asks_for_work(options_)) point["work"] = work_of(store_, flow_with(s), found, options_);
    points.push_back(std::move(point));
    swept_.push_back({s, {axis}, {}});
    if (!found.contains("failure")) swept_.back().numbers = numbers_of_point(found);
  }

  Json reference_of(const std::vector<coupling::SweepCurve>& curves) const {
    const coupling::FlowSettings finest = coupling::reference_settings(standard_, curves);
    print_out(fmt::format("{:>11}  reference {}\n", "", name_of(finest)));
    flush_out();
    Json reference =
        solved_point(store_, flow(name_of(finest), coupling::changes_of(finest, standard_, surface_cell_)));
    if (reference.contains("failure"))
      throw NotConvergedError(
          fmt::format("the reference ({}) was not found: sweep over coarser values", name_of(finest)));
    reference["levels"] = finest.levels, reference["eps"] = finest.eps,
    reference["tolerance"] = finest.tolerance;
    return reference;
  }

  /// Returns the names of what there are errors of.
  std::vector<std::string> add_errors(Json& points, const std::vector<coupling::SweepCurve>& curves,
                                      const Json& reference) const {
    std::optional<coupling::FlowNumbers> there;
    if (!reference.is_null()) there = numbers_of_point(reference);
    const std::vector<coupling::FlowErrors> errors = coupling::flow_errors(swept_, curves, there);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      points[i]["errors"] = json_of(errors[i].errors);
      points[i]["errors_alone"] = Json::object();
      for (const auto& [axis, alone] : errors[i].alone) points[i]["errors_alone"][axis] = json_of(alone);
    }
    return coupling::quantities_of(errors);
  }

  void print(const Json& points, const std::vector<std::string>& quantities) const {
    print_out(fmt::format("{:>10}", "processor"));
    for (const std::string& name : quantities) print_out(fmt::format(" {:>12}", name));
    print_out("  (relative errors; * on the front)\n");
    for (const Json& point : points) {
      if (point.contains("failure")) continue;
      print_out(fmt::format("{:8.2f} s", point.at("cpu_seconds").get<double>()));
      for (const std::string& name : quantities) {
        const auto error = point.at("errors").find(name);
        const bool known = error != point.at("errors").end() && error->is_number();
        const bool front = std::find(point.at("pareto").begin(), point.at("pareto").end(), Json(name)) !=
                           point.at("pareto").end();
        print_out(fmt::format(
            " {:>12}", known ? fmt::format("{:.2g}{}", error->get<double>(), front ? "*" : " ") : "-"));
      }
      print_out(fmt::format("  {}{}\n", point.at("name").get<std::string>(),
                            point.at("default").get<bool>() ? " (the scene)" : ""));
    }
  }

  void write_report(const Json& as_it_is, const Json& reference, const Json& points,
                    const std::vector<std::string>& quantities) const {
    const Json& settings = as_it_is.at("settings");
    const Document document = read_toml(options_.scene, options_.overrides);
    const Node* reduced = document.root.find("reduced");
    Json report{{"format", "drumlin-cost-1"}, {"kind", "continuum"}, {"title", settings.at("title")}};
    report["reduced"] =
        reduced != nullptr && std::get_if<bool>(&reduced->value) != nullptr && std::get<bool>(reduced->value);
    report["scene_file"] = options_.scene.filename().string();
    report["law"] = settings.at("law");
    if (reference.is_null())
      report["reference"] = "closed form";
    else
      report["reference"] = {
          {"levels", reference.at("levels")},           {"eps", reference.at("eps")},
          {"tolerance", reference.at("tolerance")},     {"unknowns", reference.at("unknowns")},
          {"cpu_seconds", reference.at("cpu_seconds")}, {"scalars", reference.at("scalars")}};
    report["quantities"] = quantities;
    report["points"] = points;
    report["scene"] = toml_text(document.root);
    report["provenance"] = to_json(provenance());
    const UnfinishedFile unfinished(*options_.output / "cost.json.part");
    const fs::path file = *options_.output / "cost.json";
    write_json(unfinished.path(), report);
    draw_figures("work_precision.py", {unfinished.path().string(), options_.output->string()});
    write_json(file, report);
    store_.finish();
    print_out(fmt::format("{}\n", file.string()));
  }

  const CostOptions& options_;
  const PointStore& store_;
  std::vector<coupling::SweptFlow> swept_;  // beside the points of the report
  coupling::FlowSettings standard_;
  double surface_cell_ = 0;
};

}  // namespace

int sweep_flow(const CostOptions& options) {
  if (!options.output) throw InputError("cost: a sweep needs --output COST for its points");
  if (!options.against.empty() || !options.variants.empty())
    throw InputError("cost: --against and --variants go with --effects");
  (void)coupling::sweep_axes(options.sweep, coupling::flow_axes());
  GrowingOutput output = cost_output(*options.output, options.existing, {options.scene, *options.rheology});
  const PointStore store(output, shared_by_flows("continuum", options));
  const CaughtInterruptions caught;
  return FlowSweep(options, store).execute();
}

}  // namespace drumlin::apps
