// What `drumlin cost` measures, for the scripts that plan it (apps/costs), and the folders of its results.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "apps/json/json_file.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/progress.hpp"
#include "apps/python/bindings.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/described.hpp"
#include "coupling/core/documents/document.hpp"
#include "coupling/core/documents/toml_text.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/measurement/motion_difference.hpp"
#include "particles/scene/effect_variants.hpp"
#include "particles/scene/physics.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/solver/solver_names.hpp"
#include "particles/stretches/effect_price.hpp"
#include "particles/stretches/stretch.hpp"

namespace py = pybind11;

namespace drumlin::particles {
DRUMLIN_DESCRIBED(Mark, cpu_seconds, steps, sweeps, contact_sweeps, missed, overlap_d)
DRUMLIN_DESCRIBED(MotionDifference, field, displacement, velocity, energy)
}  // namespace drumlin::particles

namespace drumlin::python {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Texts = std::vector<std::string>;

py::object python_of(const Json& json) { return py::module_::import("json").attr("loads")(json.dump()); }

void raise_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

particles::SweepStart end_of_run(const fs::path& folder, const particles::Scene& scene) {
  const particles::RunFolder run = particles::read_run_folder(folder);
  if (!run.finished())
    throw InputError(fmt::format("{}: the run is unfinished (status {}); finish it with drumlin run --resume",
                                 folder.string(), name_of(run.status)));
  if (particles::scene_text(particles::physics_of(run.scene)) !=
      particles::scene_text(particles::physics_of(scene)))
    throw InputError(folder.string() +
                     ": is a run of another scene: grains, walls, effects and motions have to be the same");
  particles::SweepStart start{run.scene,
                              particles::read_checkpoint(checked_file(run.files, "checkpoint.h5")).state};
  start.scene.solver = scene.solver;
  start.scene.output = scene.output;
  start.scene.stages.push_back(scene.stages.back());
  return start;
}

particles::SimulationState last_stage_reached(const particles::Scene& scene, int threads) {
  apps::Progress progress;
  particles::SimulationState state = particles::at_last_stage(scene, threads, [&](double share) {
    if (progress.due()) progress.show(fmt::format("to the last stage {:.0f} %", 100 * share));
    raise_signals();
  });
  progress.finish();
  return state;
}

void write_state(const fs::path& file, const particles::Scene& scene,
                 const particles::SimulationState& state) {
  particles::Checkpoint checkpoint;
  checkpoint.scene = particles::scene_text(scene);
  checkpoint.state = state;
  particles::write_checkpoint(file, checkpoint);
}

fs::path file_at_mark(const std::string& prefix, std::size_t mark) {
  return fmt::format("{}-at-{}.h5", prefix, mark + 1);
}

/// A scene of particles. Throws InputError for what is none.
class ParticleWork {
 public:
  ParticleWork(const std::string& scene, const Texts& changes, int threads)
      : scene_(particles::read_scene(scene, changes)), threads_(threads) {}

  py::object facts() const {
    return python_of({{"title", scene_.title},
                      {"reduced", scene_.reduced},
                      {"scene", particles::scene_text(scene_)},
                      {"solver", scene_.solver.name},
                      {"tolerance", scene_.solver.tolerance},
                      {"step_s", scene_.stages.back().time_step_s},
                      {"last_stage", scene_.stages.size() - 1},
                      {"solvers", particles::contact_solver_names()}});
  }

  /// Reads or makes the state that all stretches begin with: the end of the run `from`, or the beginning of
  /// the last stage, up to which the scene is run; saved in `file`. Throws InputError when the run is
  /// unfinished or of other grains, walls, effects.
  void begin(const std::string& file, const std::optional<std::string>& from) {
    if (from)
      start_ = end_of_run(*from, scene_);
    else
      start_.scene = scene_;
    start_.scene.output.energy_ledger = false;
    for (particles::Stage& stage : start_.scene.stages) stage.snapshots = 0;
    if (fs::exists(file)) {
      start_.state = particles::read_checkpoint(file).state;
      return;
    }
    if (!from) start_.state = last_stage_reached(start_.scene, threads_);
    start_.state.energy.reset();
    start_.state.marks.clear();
    start_.state.snapshots = 0;
    write_state(file, start_.scene, start_.state);
  }

  /// What a stretch took after a quarter, half and all of it. Where `saved` is a prefix the grains at these
  /// marks stay in files of that prefix; else the marks have the differences to each of `against`, prefixes
  /// of such files, and the stretch is repeated for its time.
  py::object stretch(const particles::StretchSettings& settings, const std::optional<std::string>& saved,
                     const Texts& against) const {
    const auto marks = particles::marks_along(start_, settings, threads_, raise_signals);
    Json list = Json::array();
    for (std::size_t m = 0; m < marks.size(); ++m) {
      const particles::Mark& mark = marks[m];
      list.push_back(mark);
      if (saved) {
        particles::SimulationState state = start_.state;
        state.bodies = mark.bodies;
        write_state(file_at_mark(*saved, m), start_.scene, state);
      }
      for (const std::string& prefix : against) {
        const particles::Bodies there = particles::read_checkpoint(file_at_mark(prefix, m)).state.bodies;
        list.back()["against"].push_back(
            particles::motion_difference(start_.state.bodies, there, mark.bodies));
      }
    }
    Json found{{"marks", list}};
    if (!saved)
      found["cpu_seconds"] =
          particles::least_seconds(start_, settings, threads_, marks.back().cpu_seconds, raise_signals);
    return python_of(found);
  }

  /// Makes `folder` one in which `drumlin run folder/scene.toml -o folder/run --resume` starts from the
  /// state; the steps that lie behind the state.
  std::int64_t lay_down(const particles::StretchSettings& settings, int snapshots,
                        const std::string& folder) const {
    const fs::path run = fs::path(folder) / "run";
    if (!fs::exists(run / "checkpoint.h5")) {
      particles::Scene scene = particles::with_settings(start_.scene, settings);
      scene.stages.back().snapshots = snapshots;
      make_folders(run);
      write_manifest(run, {.command = "run", .accepted = {}, .files = {}});
      write_state(run / "checkpoint.h5", particles::as_recorded(scene), start_.state);
      replace_file(fs::path(folder) / "scene.toml", particles::scene_text(scene));
    }
    return start_.state.step;
  }

  /// The scene as it is, then with each of its effects removed and each absent one added.
  py::object variants() {
    (void)particles::Simulation(scene_);
    variants_ = particles::effect_variants(scene_);
    Json list = Json::array();
    for (const particles::EffectVariant& one : variants_)
      list.push_back({{"effect", one.effect},
                      {"change", name_of(one.change)},
                      {"with_it", one.with_it},
                      {"refused", one.refused}});
    return python_of(list);
  }

  /// What variant number `variant` takes in its first `seconds`.
  py::object price(std::size_t variant, double seconds) const {
    const particles::EffectPrice p =
        particles::price_of(variants_.at(variant).scene, seconds, threads_, raise_signals);
    return python_of({{"cpu_seconds", p.cpu_seconds},
                      {"detection_seconds", p.detection_seconds},
                      {"solver_seconds", p.solver_seconds},
                      {"bytes", p.bytes},
                      {"unknowns", p.unknowns()},
                      {"unknowns_per_contact", p.unknowns_per_contact},
                      {"velocities_per_body", p.velocities_per_body},
                      {"contacts", p.contacts},
                      {"sweeps", p.sweeps},
                      {"missed_share", p.missed},
                      {"kinetic_energy_J_kg", p.kinetic_energy_J_kg},
                      {"center_of_mass_mm", {p.center_x_mm, p.center_z_mm}},
                      {"slope_deg", p.slope_deg},
                      {"overlap_d", p.overlap_d}});
  }

 private:
  particles::Scene scene_;
  int threads_;
  std::vector<particles::EffectVariant> variants_;
  particles::SweepStart start_;
};

bool is_flow_scene(const std::string& file) {
  const Document document = read_toml(file);
  const Node* format = document.root.find("format");
  const auto* text = format != nullptr ? std::get_if<std::string>(&format->value) : nullptr;
  return text != nullptr && text->starts_with("drumlin-flow-scene-");
}

std::string text_without(Node table, const std::string& key) {
  std::erase_if(std::get<Node::Table>(table.value), [&](const auto& entry) { return entry.key == key; });
  return toml_text(table);
}

/// The scene of a flow and the law, as they are and without any effect, as texts; the scene's effects as
/// changes for --set, by name.
py::object flow_facts(const std::string& scene_file, const Texts& changes, const std::string& law_file) {
  const Node scene = read_toml(scene_file, changes).root;
  const Node law = read_toml(law_file).root;
  const Node* reduced = scene.find("reduced");
  const bool* is_reduced = reduced != nullptr ? std::get_if<bool>(&reduced->value) : nullptr;
  Json named = Json::object();
  if (const Node* effects = scene.find("effects"))
    if (const auto* entries = std::get_if<Node::Table>(&effects->value))
      for (const auto& [name, keys] : *entries)
        named[name] = fmt::format("effects.{}={}", name, toml_value(keys));
  return python_of({{"reduced", is_reduced != nullptr && *is_reduced},
                    {"scene", toml_text(scene)},
                    {"law", file_text(law_file)},
                    {"plain_scene", text_without(scene, "effects")},
                    {"plain_law", text_without(law, "k")},
                    {"law_has_k", law.find("k") != nullptr},
                    {"named", named}});
}

apps::OutputRequest request_of(const std::string& folder, const std::string& command, bool resume,
                               bool overwrite, const Texts& inputs, const std::string& sum = {}) {
  return {folder,
          resume      ? apps::ExistingOutput::resume
          : overwrite ? apps::ExistingOutput::overwrite
                      : apps::ExistingOutput::refuse,
          command,
          {inputs.begin(), inputs.end()},
          {},
          sum};
}

void add_outputs(py::module_& module) {
  using apps::GrowingOutput, apps::StagedOutput;
  py::class_<GrowingOutput>(module, "GrowingOutput")
      .def(py::init([](const std::string& folder, const std::string& command, bool resume, bool overwrite,
                       const Texts& inputs, const Texts& known, const std::string& sum) {
             return std::make_unique<GrowingOutput>(
                 request_of(folder, command, resume, overwrite, inputs, sum), known);
           }),
           py::arg("folder"), py::arg("command"), py::arg("resume"), py::arg("overwrite"), py::arg("inputs"),
           py::arg("known"), py::arg("sum") = "")
      .def("__contains__", [](const GrowingOutput& self,
                              const std::string& name) { return self.manifest().files.contains(name); })
      .def("list", &GrowingOutput::list)
      .def("forget", &GrowingOutput::forget)
      .def("save", &GrowingOutput::save)
      .def("finish", &GrowingOutput::finish);
  py::class_<StagedOutput>(module, "StagedOutput")
      .def(py::init([](const std::string& folder, const std::string& command, bool resume, bool overwrite,
                       const Texts& inputs) {
        return std::make_unique<StagedOutput>(request_of(folder, command, resume, overwrite, inputs));
      }))
      .def_property_readonly("folder", [](const StagedOutput& self) { return self.folder().string(); })
      .def("publish", &StagedOutput::publish);
  module.def("holds_results", [](const std::string& folder, const std::string& finished) {
    return apps::holds_results(folder, finished);
  });
}

}  // namespace

void add_costs(py::module_& module) {
  using particles::StretchSettings;
  py::class_<StretchSettings>(module, "StretchSettings")
      .def(py::init<std::string, double, double, double>(), py::arg("solver"), py::arg("tolerance"),
           py::arg("step_s"), py::arg("length_s"));
  py::class_<ParticleWork>(module, "ParticleWork")
      .def(py::init<std::string, Texts, int>())
      .def_property_readonly("facts", &ParticleWork::facts)
      .def("begin", &ParticleWork::begin)
      .def("stretch", &ParticleWork::stretch, py::arg("settings"), py::arg("saved") = py::none(),
           py::arg("against") = Texts())
      .def("lay_down", &ParticleWork::lay_down)
      .def("variants", &ParticleWork::variants)
      .def("price", &ParticleWork::price);
  module.def("is_flow_scene", &is_flow_scene);
  module.def("flow_facts", &flow_facts);
  module.def("provenance", [] { return python_of(Json(provenance())); });
  add_outputs(module);
}

}  // namespace drumlin::python
