// drumlin cost SCENE for particles: solvers, tolerances and time steps from one state, compared by the
// velocities that they lead to and, on request, by what long runs measure.
#include "coupling/accuracy/particle_sweep.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/cost/advice.hpp"
#include "apps/commands/cost/cost.hpp"
#include "apps/commands/cost/long_run.hpp"
#include "apps/commands/cost/particle_points.hpp"
#include "apps/commands/cost/sweep.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/machine_load.hpp"
#include "coupling/common/unfinished_file.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/measurement/motion_difference.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/solver/solver_names.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double standard_steps = 16;  // of the scene, in the stretch
// "solver" is of the same step with a much tighter tolerance: what the contact solve alone leaves.
const std::vector<std::string> quantities = {"field", "displacement", "velocity", "energy", "solver"};

coupling::ParticleSweep sweep_of(const CostOptions& options, const particles::Scene& scene) {
  const coupling::ParticleSettings standard{scene.solver.name, scene.solver.tolerance,
                                            scene.stages.back().time_step_s};
  return coupling::particle_sweep(standard, coupling::sweep_axes(options.sweep, coupling::particle_axes()),
                                  particles::contact_solver_names());
}

Json settings_json(const coupling::ParticleSettings& s) {
  return {{"solver", s.solver}, {"tolerance", s.tolerance}, {"step_s", s.step_s}};
}

Json marks_json(const std::vector<particles::Mark>& marks, double seconds) {
  Json list = Json::array();
  for (const particles::Mark& mark : marks) {
    const double steps = static_cast<double>(mark.steps);
    list.push_back({{"simulated_seconds", seconds * steps / static_cast<double>(marks.back().steps)},
                    {"cpu_seconds", mark.cpu_seconds},
                    {"steps", mark.steps},
                    {"sweeps", mark.sweeps},
                    {"contact_sweeps", mark.contact_sweeps},
                    {"missed_share", static_cast<double>(mark.missed) / steps},
                    {"overlap_d", mark.overlap_d}});
  }
  return list;
}

class SweepOfGrains {
 public:
  SweepOfGrains(const CostOptions& options, const particles::Scene& scene)
      : options_(options),
        scene_(scene),
        sweep_(sweep_of(options, scene)),
        stretch_s_(options.horizon_s.value_or(standard_steps * scene.stages.back().time_step_s)) {}

  int execute() {
    if (!options_.output) throw InputError("cost: a sweep needs --output COST for its points");
    std::vector<fs::path> inputs = {options_.scene};
    if (options_.from) inputs.push_back(*options_.from / "run.json");
    GrowingOutput output = cost_output(*options_.output, options_.existing, inputs);
    const Json shared{{"kind", "particles"},
                      {"scene", particles::scene_text(scene_)},
                      {"from", options_.from ? options_.from->string() : "the beginning of the last stage"},
                      {"horizon_s", stretch_s_},
                      {"reference", settings_json(sweep_.reference)}};
    const PointStore store(output, shared);
    const CaughtInterruptions caught;
    const particles::SweepStart start = sweep_start(options_, scene_);
    print_out(fmt::format("{}: {:g} s from {}, {} points\n", options_.scene.string(), stretch_s_,
                          shared.at("from").get<std::string>(), sweep_.points.size()));
    make_reference(start, store, sweep_.reference);
    const Json finest = measured_point(start, store, sweep_.finest);
    const std::size_t horizon = chosen_horizon(finest);
    Json points = Json::array();
    print_out(fmt::format("{:>10} {:>8} {:>8}", "processor", "sweeps", "missed"));
    for (const std::string& name : quantities) print_out(fmt::format(" {:>12}", name));
    print_out("  (processor seconds per simulated one; relative errors)\n");
    for (const coupling::ParticleSettings& settings : sweep_.points)
      points.push_back(flat(measured_point(start, store, settings), settings, horizon));
    if (options_.statistics_s) add_statistics(start, store, points);
    mark_fronts(points, quantities);
    print_out(advice_text(points, quantities, [this](const Json& point) {
      return fmt::format("--set solver.name={} --set solver.tolerance={:g} --set stages.{}.time_step_s={:g}",
                         point.at("solver").get<std::string>(), point.at("tolerance").get<double>(),
                         scene_.stages.size() - 1, point.at("step_s").get<double>());
    }));
    write_report(store, finest, points, horizon);
    return static_cast<int>(ExitCode::done);
  }

 private:
  fs::path reference_file(const PointStore& store, const coupling::ParticleSettings& reference,
                          int mark) const {
    return store.beside(fmt::format("{}-at-{}.h5", name_of(reference), mark + 1));
  }

  /// Runs through the stretch and keeps where the grains are at each mark.
  void make_reference(const particles::SweepStart& start, const PointStore& store,
                      const coupling::ParticleSettings& settings) const {
    const std::string name = "reference-" + name_of(settings);
    if (store.finished(name)) return;
    print_out(fmt::format("{}\n", name));
    flush_out();
    const double load = load_average();
    const auto marks =
        particles::marks_along(start, stretch_of(settings), options_.threads, stop_if_interrupted);
    for (int m = 0; m < particles::marks_of_stretch; ++m) {
      particles::Checkpoint kept;
      kept.scene = particles::scene_text(start.scene);
      kept.state = start.state;
      kept.state.bodies = marks[static_cast<std::size_t>(m)].bodies;
      particles::write_checkpoint(reference_file(store, settings, m), kept);
    }
    Json point = settings_json(settings);
    point["load_before"] = load;
    point["marks"] = marks_json(marks, stretch_s_);
    store.keep(name, point);
  }

  particles::StretchSettings stretch_of(const coupling::ParticleSettings& s) const {
    return {s.solver, s.tolerance, s.step_s, stretch_s_};
  }

  particles::MotionDifference apart(const particles::SweepStart& start, const PointStore& store,
                                    const coupling::ParticleSettings& reference, int mark,
                                    const particles::Bodies& bodies) const {
    const particles::Bodies there =
        particles::read_checkpoint(reference_file(store, reference, mark)).state.bodies;
    return particles::motion_difference(start.state.bodies, there, bodies);
  }

  Json measured_point(const particles::SweepStart& start, const PointStore& store,
                      const coupling::ParticleSettings& settings) const {
    const std::string name = name_of(settings);
    if (const auto done = store.finished(name)) return *done;
    make_reference(start, store, sweep_.tight(settings.step_s));
    Json point = settings_json(settings);
    point["load_before"] = load_average();
    const auto marks =
        particles::marks_along(start, stretch_of(settings), options_.threads, stop_if_interrupted);
    point["marks"] = marks_json(marks, stretch_s_);
    const double seconds = particles::least_seconds(start, stretch_of(settings), options_.threads,
                                                    marks.back().cpu_seconds, stop_if_interrupted);
    point["cpu_seconds"] = seconds / stretch_s_;
    for (int m = 0; m < particles::marks_of_stretch; ++m) {
      const auto index = static_cast<std::size_t>(m);
      const particles::MotionDifference d = apart(start, store, sweep_.reference, m, marks[index].bodies);
      const particles::MotionDifference solver =
          apart(start, store, sweep_.tight(settings.step_s), m, marks[index].bodies);
      point["marks"][index]["errors"] = {{"field", d.field},       {"displacement", d.displacement},
                                         {"velocity", d.velocity}, {"energy", d.energy},
                                         {"solver", solver.field}, {"solver_velocity", solver.velocity}};
    }
    store.keep(name, point);
    return store.finished(name).value();
  }

  /// Over the longest stretch over which the finest point still follows the reference.
  std::size_t chosen_horizon(const Json& finest) const {
    std::vector<double> floors;
    for (const Json& mark : finest.at("marks")) {
      const auto floor = [&](const char* name) { return number_or_nan(mark.at("errors").at(name)).value(); };
      print_out(fmt::format(
          "floor after {:g} s: field {:.2g}, displacement {:.2g}, velocity {:.2g}, energy {:.2g}\n",
          mark.at("simulated_seconds").get<double>(), floor("field"), floor("displacement"),
          floor("velocity"), floor("energy")));
      floors.push_back(floor("field"));
    }
    return coupling::last_followed(floors);
  }

  /// The point as it stands in cost.json: the numbers of the horizon that all are read at.
  Json flat(const Json& point, const coupling::ParticleSettings& settings, std::size_t horizon) const {
    Json row{{"name", point.at("name")}, {"default", settings == sweep_.standard}};
    row.update(settings_json(settings));
    for (const char* key : {"load_before", "cpu_seconds"}) row[key] = point.at(key);
    const Json& mark = point.at("marks")[horizon];
    for (const auto& [key, value] : mark.items())
      if (key != "simulated_seconds" && key != "cpu_seconds") row[key] = value;
    const double steps = mark.at("steps").get<double>();
    print_out(fmt::format("{:8.2f} s {:8.1f} {:6.1f} %", point.at("cpu_seconds").get<double>(),
                          mark.at("sweeps").get<double>() / steps,
                          100 * mark.at("missed_share").get<double>()));
    for (const std::string& name : quantities) {
      const Json& error = mark.at("errors").at(name);
      print_out(fmt::format(" {:>12}", error.is_number() ? fmt::format("{:.2g}", error.get<double>()) : "-"));
    }
    print_out(fmt::format("  {}{}\n", point.at("name").get<std::string>(),
                          settings == sweep_.standard ? " (the scene)" : ""));
    flush_out();
    return row;
  }

  /// Only with the scene's own solver: the others differ by nothing but their work.
  void add_statistics(const particles::SweepStart& start, const PointStore& store, Json& points) const {
    for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
      const coupling::ParticleSettings& settings = sweep_.points[i];
      if (settings.solver != sweep_.standard.solver) continue;
      const std::string name = fmt::format("{}-over-{:g}-s", name_of(settings), *options_.statistics_s);
      auto kept = store.finished(name);
      if (!kept) {
        particles::Scene scene = particles::with_settings(
            start.scene, {settings.solver, settings.tolerance, settings.step_s, *options_.statistics_s});
        store.keep(name, long_run(start, scene, store.beside(name), options_.threads));
        kept = store.finished(name);
      }
      points[i]["statistics"] = kept->at("statistics");
    }
  }

  void write_report(const PointStore& store, const Json& finest, const Json& points,
                    std::size_t horizon) const {
    const Json reference = store.finished("reference-" + name_of(sweep_.reference)).value();
    Json report{{"format", "drumlin-cost-1"},
                {"kind", "particles"},
                {"title", scene_.title},
                {"reduced", scene_.reduced}};
    report["scene_file"] = options_.scene.filename().string();
    report["threads"] = options_.threads;
    report["horizon_s"] = finest.at("marks")[horizon].at("simulated_seconds");
    report["floor"] = finest.at("marks")[horizon].at("errors");
    report["floors"] = Json::array();
    for (const Json& mark : finest.at("marks"))
      report["floors"].push_back(
          {{"simulated_seconds", mark.at("simulated_seconds")}, {"errors", mark.at("errors")}});
    report["reference"] = settings_json(sweep_.reference);
    report["reference"]["cpu_seconds"] = reference.at("marks")[horizon].at("cpu_seconds");
    report["quantities"] = quantities;
    if (options_.statistics_s) report["statistics_s"] = *options_.statistics_s;
    report["points"] = points;
    report["scene"] = particles::scene_text(scene_);
    report["provenance"] = to_json(provenance());
    const fs::path file = *options_.output / "cost.json";
    draw(report);
    write_json(file, report);
    store.finish();
    print_out(fmt::format("{}\n", file.string()));
  }

  void draw(const Json& report) const {
    const UnfinishedFile unfinished(*options_.output / "cost.json.part");
    write_json(unfinished.path(), report);
    draw_figures("work_precision.py", {unfinished.path().string(), options_.output->string()});
  }

  const CostOptions& options_;
  const particles::Scene& scene_;
  coupling::ParticleSweep sweep_;
  double stretch_s_;
};

}  // namespace

int sweep_particles(const CostOptions& options) {
  const particles::Scene scene = particles::read_scene(options.scene, options.overrides);
  return SweepOfGrains(options, scene).execute();
}

}  // namespace drumlin::apps
