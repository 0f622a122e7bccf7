// drumlin cost FLOW_SCENE: meshes, eps and tolerances of a flow, judged by its scalars and its profile of
// v_x.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

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

struct FlowSettings {
  int levels = 0;  ///< the coarsest mesh is that of the scene
  double eps = 0, tolerance = 0;
  bool operator==(const FlowSettings&) const = default;
};

std::string name_of(const FlowSettings& s) {
  return fmt::format("levels-{}-eps-{:g}-tolerance-{:g}", s.levels, s.eps, s.tolerance);
}

struct Curve {
  std::string axis;
  std::vector<FlowSettings> points;  ///< the finest last
};

class FlowSweep {
 public:
  FlowSweep(const CostOptions& options, const PointStore& store) : options_(options), store_(store) {}

  int execute() {
    const auto axes = sweep_axes(options_.sweep, {"mesh", "eps", "tolerance"});
    fmt::print("{}: the scene as it is\n", options_.scene.string());
    std::fflush(stdout);
    const Json as_it_is = solved_point(store_, flow("as-it-is", {}));
    if (as_it_is.contains("failure"))
      throw NotConvergedError(options_.scene.string() + ": the flow did not converge");
    const Json& settings = as_it_is.at("settings");
    standard_ = {settings.at("levels"), settings.at("regularisation_shear_rate"), settings.at("tolerance")};
    surface_cell_ = settings.at("surface_cell");
    const std::vector<Curve> curves = curves_of(axes);
    Json points = Json::array();
    for (const Curve& curve : curves)
      for (const FlowSettings& s : curve.points) add_point(points, s, curve.axis, as_it_is);
    const Json reference = as_it_is.contains("closed_form") ? Json(nullptr) : reference_of(curves);
    std::vector<std::string> quantities = add_errors(points, curves, reference);
    mark_fronts(points, quantities);
    print(points, quantities);
    write_report(as_it_is, reference, points, quantities);
    return static_cast<int>(ExitCode::done);
  }

 private:
  FlowToSolve flow(const std::string& name, std::vector<std::string> changes) const {
    changes.insert(changes.begin(), options_.overrides.begin(), options_.overrides.end());
    return {name, options_.scene, *options_.rheology, changes};
  }

  std::vector<std::string> changes_of(const FlowSettings& s) const {
    return {fmt::format("mesh.levels={}", s.levels),
            fmt::format("mesh.surface_cell={}", surface_cell_ * std::pow(2.0, standard_.levels - s.levels)),
            fmt::format("regularisation.shear_rate={}", s.eps),
            fmt::format("solver.tolerance={}", s.tolerance)};
  }

  Json solved(const FlowSettings& s, const Json& as_it_is) const {
    return s == standard_ ? as_it_is : solved_point(store_, flow(name_of(s), changes_of(s)));
  }

  // One curve through the scene for each axis, its finest point last.
  std::vector<Curve> curves_of(const std::vector<SweepAxis>& axes) const {
    std::vector<Curve> curves;
    for (const SweepAxis& axis : axes) {
      Curve curve{axis.name, {standard_}};
      const auto add = [&](const FlowSettings& s) {
        if (std::find(curve.points.begin(), curve.points.end(), s) == curve.points.end())
          curve.points.push_back(s);
      };
      if (axis.name == "mesh") {
        std::vector<double> levels;
        for (int level = 1; level <= standard_.levels + 1; ++level) levels.push_back(level);
        for (const double level : numbers_of(axis, levels)) {
          if (level != std::floor(level) || level > 8)
            throw InputError(
                "--sweep mesh: its values are numbers of meshes (allowed: integer >= 1 and <= 8)");
          add({static_cast<int>(level), standard_.eps, standard_.tolerance});
        }
        std::sort(curve.points.begin(), curve.points.end(),
                  [](auto& a, auto& b) { return a.levels < b.levels; });
      } else if (axis.name == "eps") {
        const double eps = standard_.eps;
        for (const double value : numbers_of(axis, {1000 * eps, 100 * eps, 10 * eps, eps, eps / 10}))
          add({standard_.levels, value, standard_.tolerance});
        std::sort(curve.points.begin(), curve.points.end(), [](auto& a, auto& b) { return a.eps > b.eps; });
      } else {
        for (const double value : numbers_of(axis, {1e-2, 1e-4, 1e-6, standard_.tolerance}))
          add({standard_.levels, standard_.eps, value});
        std::sort(curve.points.begin(), curve.points.end(),
                  [](auto& a, auto& b) { return a.tolerance > b.tolerance; });
      }
      curves.push_back(std::move(curve));
    }
    return curves;
  }

  void add_point(Json& points, const FlowSettings& s, const std::string& axis, const Json& as_it_is) const {
    const std::string name = name_of(s);
    for (Json& point : points)
      if (point.at("name") == name) {
        point["axes"].push_back(axis);
        return;
      }
    Json point{{"name", name}, {"default", s == standard_}, {"axes", {axis}}, {"levels", s.levels},
               {"eps", s.eps}, {"tolerance", s.tolerance}};
    const Json found = solved(s, as_it_is);
    for (const char* key : {"unknowns", "iterations", "seconds", "cpu_seconds", "load_before", "scalars",
                            "closed_form", "profile", "failure"})
      if (found.contains(key)) point[key] = found.at(key);
    fmt::print("{:>9} s  {}{}\n",
               found.at("cpu_seconds").is_number()
                   ? fmt::format("{:.2f}", found.at("cpu_seconds").get<double>())
                   : "-",
               name, found.contains("failure") ? ": did not converge" : "");
    std::fflush(stdout);
    points.push_back(std::move(point));
  }

  // Finer than every point in all that is varied.
  Json reference_of(const std::vector<Curve>& curves) const {
    FlowSettings finest = standard_;
    for (const Curve& curve : curves) {
      const FlowSettings& last = curve.points.back();
      if (curve.axis == "mesh") finest.levels = last.levels + 1;
      if (curve.axis == "eps") finest.eps = last.eps / 10;
      // No tighter: rounding is near, and the last step of Newton's method leaves far less than it was asked
      // for.
      if (curve.axis == "tolerance") finest.tolerance = std::min(finest.tolerance, last.tolerance);
    }
    fmt::print("{:>11}  reference {}\n", "", name_of(finest));
    std::fflush(stdout);
    Json reference = solved_point(store_, flow(name_of(finest), changes_of(finest)));
    if (reference.contains("failure"))
      throw NotConvergedError(
          fmt::format("the reference ({}) did not converge: sweep over coarser values", name_of(finest)));
    reference["levels"] = finest.levels, reference["eps"] = finest.eps,
    reference["tolerance"] = finest.tolerance;
    return reference;
  }

  // Against the reference or the closed form; and, for what each setting does alone, against the finest point
  // of its curve. Returns the names of what there are errors of.
  std::vector<std::string> add_errors(Json& points, const std::vector<Curve>& curves,
                                      const Json& reference) const {
    std::vector<std::string> names;
    for (Json& point : points) {
      point["errors"] = Json::object();
      point["errors_alone"] = Json::object();
      if (point.contains("failure")) continue;
      if (reference.is_null()) {
        const Json& closed = point.at("closed_form");
        for (const auto& [name, value] : scalars_of(closed))
          if (value != 0 && point.at("scalars").contains(name) && point.at("scalars").at(name).is_number())
            point["errors"][name] = std::abs(point.at("scalars").at(name).get<double>() / value - 1);
        point["errors"]["v_x"] = closed.at("v_x");
        point["errors"]["v_x_mesh"] = closed.at("v_x_mesh");
      } else {
        point["errors"] = relative_differences(point, reference);
      }
      for (const auto& [name, value] : point["errors"].items())
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    for (const Curve& curve : curves) {
      const auto finest = std::find_if(points.begin(), points.end(), [&](const Json& point) {
        return point.at("name") == name_of(curve.points.back());
      });
      if (finest->contains("failure")) continue;
      for (Json& point : points) {
        const bool on_it = std::find(point.at("axes").begin(), point.at("axes").end(), Json(curve.axis)) !=
                           point.at("axes").end();
        if (on_it && !point.contains("failure") && point.at("name") != finest->at("name"))
          point["errors_alone"][curve.axis] = relative_differences(point, *finest);
      }
    }
    return names;
  }

  void print(const Json& points, const std::vector<std::string>& quantities) const {
    fmt::print("{:>10}", "processor");
    for (const std::string& name : quantities) fmt::print(" {:>12}", name);
    fmt::print("  (relative errors; * on the front)\n");
    for (const Json& point : points) {
      if (point.contains("failure")) continue;
      fmt::print("{:8.2f} s", point.at("cpu_seconds").get<double>());
      for (const std::string& name : quantities) {
        const auto error = point.at("errors").find(name);
        const bool known = error != point.at("errors").end() && error->is_number();
        const bool front = std::find(point.at("pareto").begin(), point.at("pareto").end(), Json(name)) !=
                           point.at("pareto").end();
        fmt::print(" {:>12}", known ? fmt::format("{:.2g}{}", error->get<double>(), front ? "*" : " ") : "-");
      }
      fmt::print("  {}{}\n", point.at("name").get<std::string>(),
                 point.at("default").get<bool>() ? " (the scene)" : "");
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
    for (Json& point : report["points"]) point.erase("profile");
    report["scene"] = toml_text(document.root);
    report["provenance"] = to_json(provenance());
    const fs::path unfinished = *options_.output / "cost.json.part", file = *options_.output / "cost.json";
    write_json(unfinished, report);
    draw_figures("work_precision.py", {unfinished.string(), options_.output->string()});
    fs::remove(unfinished);
    write_json(file, report);
    fmt::print("{}\n", file.string());
  }

  const CostOptions& options_;
  const PointStore& store_;
  FlowSettings standard_;
  double surface_cell_ = 0;
};

}  // namespace

int sweep_flow(const CostOptions& options) {
  if (!options.output) throw InputError("cost: a sweep needs --output COST for its points");
  if (options.from || options.statistics_s)
    throw InputError("cost: --from and --statistics are for scenes of particles");
  (void)sweep_axes(options.sweep, {"mesh", "eps", "tolerance"});
  prepare_output(*options.output, options.existing, {"sweep.json", "cost.json"},
                 {options.scene, *options.rheology});
  const Json shared{{"kind", "continuum"},
                    {"scene", toml_text(read_toml(options.scene, options.overrides).root)},
                    {"rheology", file_text(*options.rheology)}};
  const PointStore store(*options.output, shared);
  catch_interruptions();
  return FlowSweep(options, store).execute();
}

}  // namespace drumlin::apps
