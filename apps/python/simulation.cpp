// Simulations for Python: steps without the interpreter's lock, arrays as views.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <type_traits>

#include "apps/json/drawn_walls.hpp"
#include "apps/python/bindings.hpp"
#include "apps/python/others_run.hpp"
#include "coupling/core/basics/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/grains_of_run.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"
#include "particles/stepping/stepped_scene.hpp"

namespace py = pybind11;

namespace drumlin::python {
namespace {

using particles::Scene;
using particles::Simulation;

/// Reads a scene file, or a text that stands for the file `name`.
Scene scene_of(const std::optional<std::string>& text, const std::string& name,
               const std::vector<std::string>& overrides) {
  return text ? particles::parse_scene(*text, name, overrides) : particles::read_scene(name, overrides);
}

/// Numbers that nobody writes to, kept alive by `owner`.
template <class T>
py::array read_only(py::array_t<T> numbers) {
  numbers.attr("flags").attr("writeable") = false;
  return numbers;
}
template <class T>
py::array owned(std::vector<T>&& values) {
  auto storage = std::make_unique<std::vector<T>>(std::move(values));
  const auto* numbers = storage.get();
  const py::capsule owner(storage.release(), [](void* data) { delete static_cast<std::vector<T>*>(data); });
  return read_only(py::array_t<T>(static_cast<py::ssize_t>(numbers->size()), numbers->data(), owner));
}

std::string drawn_text(const nlohmann::ordered_json& walls, const nlohmann::ordered_json& period) {
  return nlohmann::ordered_json{{"walls", walls}, {"period", period}}.dump();
}

/// Of a snapshot in the folder of its run; elsewhere it knows of a circle alone.
std::string drawn_of_snapshot(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path().parent_path();
  if (std::filesystem::exists(folder / "scene.toml")) {
    const particles::RunFolder run = particles::read_run_folder(folder);
    return drawn_text(apps::drawn_walls(particles::shapes_at(run, particles::read_snapshot(file))),
                      apps::drawn_period(run.scene, run.scales));
  }
  const particles::Snapshot s = particles::read_snapshot(file);
  std::vector<particles::PlacedShape> placed;
  if (s.container_radius > 0)
    placed.push_back(
        {particles::Container{{s.container_x, s.container_z}, s.container_radius}, s.wall_angle});
  return drawn_text(apps::drawn_walls(placed), nullptr);
}

constexpr int most_threads = 256;  // as the commands take them

/// A simulation that one thread of Python at a time steps or looks at; the others wait for it. The lock of
/// the interpreter is given away before that is asked for, so that nobody who has one of them waits for the
/// other.
class SharedScene {
 public:
  SharedScene(const std::optional<std::string>& text, const std::string& name,
              const std::vector<std::string>& overrides, int threads) {
    Scene scene = scene_of(text, name, overrides);
    auto simulation = std::make_unique<Simulation>(with_grains(scene), checked(threads));
    stepped_.emplace(std::move(scene), std::move(simulation));
  }
  /// Goes on from a file that save() wrote.
  SharedScene(const std::string& file, int threads) {
    particles::Checkpoint checkpoint = particles::read_checkpoint(file);
    Scene scene = particles::parse_scene(checkpoint.scene, "scene");
    auto simulation =
        std::make_unique<Simulation>(with_grains(scene), std::move(checkpoint.state), checked(threads));
    stepped_.emplace(std::move(scene), std::move(simulation));
  }

  /// What `of` copies out of the simulation, or does with it, while no step is at work on it.
  template <class Of>
  auto look(const Of& of) const {
    const OthersRun others_run;
    const std::lock_guard turn(turn_);
    if constexpr (std::is_invocable_v<Of, particles::SteppedScene&>)
      return of(*stepped_);
    else
      return of(stepped_->simulation());
  }

  py::dict step() {
    const auto report = look([](particles::SteppedScene& s) { return s.step(); });
    const auto& solve = report.solve;
    return py::dict(py::arg("contacts") = report.contacts, py::arg("impacts") = report.impacts,
                    py::arg("converged") = particles::is_converged(report), py::arg("sweeps") = solve.sweeps,
                    py::arg("residual") = solve.residual.rms, py::arg("residual_max") = solve.residual.max,
                    py::arg("penetration") = solve.residual.penetration,
                    py::arg("overlap_mean") = report.overlap.mean,
                    py::arg("overlap_max") = report.overlap.max);
  }

  /// A view of an array of the grains; a copy where grains come and go, for these arrays move.
  py::array view(std::vector<double> particles::Bodies::*member) const {
    if (particles::changes_grains(stepped_->simulation().scene()))
      return owned(look([&](const Simulation& s) { return s.state().bodies.*member; }));
    const std::vector<double>& values = stepped_->simulation().state().bodies.*member;
    return read_only(py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data(),
                                         py::cast(this, py::return_value_policy::reference)));
  }

  // HDF5 serves one thread: files are written behind the interpreter's lock.
  void save_snapshot(const std::string& file) {
    particles::write_snapshot(file, look([](Simulation& s) { return s.take_snapshot(); }));
  }
  /// What the figures draw beside the grains.
  std::string drawn() const {
    return look([](const Simulation& s) {
      const auto& state = s.state();
      const auto shapes = s.walls().shapes_at(state.time_in_stage, state.driven);
      std::vector<particles::PlacedShape> placed;
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        const int wall = static_cast<int>(s.walls().wall_of_shape[k]);
        placed.push_back({shapes[k], s.walls().pose(wall, state.time_in_stage, state.driven).angle});
      }
      return drawn_text(apps::drawn_walls(placed), apps::drawn_period(s.scene(), s.scales()));
    });
  }
  void save(const std::string& file) {
    particles::Checkpoint checkpoint;
    checkpoint.state = look([&](particles::SteppedScene& s) {
      checkpoint.scene = particles::scene_text(s.scene());
      return s.simulation().state();
    });
    particles::write_checkpoint(file, checkpoint);
  }

  void set_velocities(const std::vector<double>& v_x, const std::vector<double>& v_z,
                      const std::vector<double>& spin) {
    look([&](Simulation& s) { s.set_velocities(v_x, v_z, spin); });
  }
  void set_friction(double grain_grain, double grain_wall) {
    look([&](particles::SteppedScene& s) { s.set_friction(grain_grain, grain_wall); });
  }
  void set_gravity(double x, double z) {
    look([&](particles::SteppedScene& s) { s.set_gravity(x, z); });
  }
  void set_wall(const std::string& wall, std::array<double, 2> velocity, double spin,
                std::array<double, 2> center) {
    look([&](particles::SteppedScene& s) { s.set_wall(wall, velocity, spin, center); });
  }

 private:
  static int checked(int threads) {
    if (threads < 1 || threads > most_threads)
      throw InputError("threads: " + std::to_string(threads) + " (allowed: 1 to " +
                       std::to_string(most_threads) + ")");
    return threads;
  }

  /// The scene as told, with the grains of another run in place of its name.
  static Scene with_grains(Scene scene) {
    if (const auto* requested = std::get_if<particles::GrainsOfRun>(&scene.grains.source))
      scene.grains.source = particles::grains_of_run(*requested).grains;
    return scene;
  }

  mutable std::mutex turn_;
  mutable std::optional<particles::SteppedScene> stepped_;  // made by each constructor
};

py::dict scales_of(const SharedScene& scene) {
  const Scales scales = scene.look([](const Simulation& s) { return s.scales(); });
  return py::dict(py::arg("length_m") = scales.length_m, py::arg("time_s") = scales.time_s,
                  py::arg("density_kg_m3") = scales.density_kg_m3,
                  py::arg("velocity_m_s") = scales.velocity_m_s(), py::arg("stress_Pa") = scales.stress_Pa());
}

std::vector<double> masses(const Simulation& simulation) {
  std::vector<double> mass;
  for (const double inverse : simulation.state().bodies.inverse_mass) mass.push_back(1 / inverse);
  return mass;
}

}  // namespace

void add_simulation(py::module_& module) {
  using particles::SnapshotContact;
  PYBIND11_NUMPY_DTYPE(SnapshotContact, i, j, normal_x, normal_z, impulse_n, impulse_t);
  using Text = std::optional<std::string>;
  module.def(
      "resolved_scene",
      [](const Text& text, const std::string& name, const std::vector<std::string>& overrides) {
        return particles::scene_text(scene_of(text, name, overrides));
      },
      py::arg("text"), py::arg("name"), py::arg("overrides"));

  py::class_<SharedScene> scene(module, "SteppedScene");
  refuse_new(scene);
  module.def("stepped_scene",
             [](const Text& text, const std::string& name, const std::vector<std::string>& overrides,
                int threads) { return std::make_unique<SharedScene>(text, name, overrides, threads); });
  scene.def("step", &SharedScene::step);
  module.def("continued_scene", [](const std::string& file, int threads) {
    return std::make_unique<SharedScene>(file, threads);
  });
  module.def("drawn_of_snapshot", &drawn_of_snapshot);
  scene.def("drawn", &SharedScene::drawn);
  scene.def("save_snapshot", &SharedScene::save_snapshot);
  scene.def("save", &SharedScene::save);
  scene.def("set_velocities", &SharedScene::set_velocities);
  scene.def("set_friction", &SharedScene::set_friction);
  scene.def("set_gravity", &SharedScene::set_gravity);
  scene.def("set_wall", &SharedScene::set_wall);
  scene.def_property_readonly("scales", &scales_of);
  const auto number = [&](const char* name, auto of) {
    scene.def_property_readonly(name, [of](const SharedScene& s) { return s.look(of); });
  };
  number("finished", [](const Simulation& s) { return s.finished(); });
  number("steps", [](const Simulation& s) { return s.state().step; });
  number("steps_planned", [](const Simulation& s) { return s.plan().steps; });
  number("time", [](const Simulation& s) { return s.state().time(); });
  number("time_step", [](const Simulation& s) { return s.last_time_step(); });
  number("stage", [](const Simulation& s) { return s.scene().stages[s.state().stage].name; });
  number("kinetic_energy", [](const Simulation& s) { return particles::kinetic_energy(s.state().bodies); });
  number("walls", [](const Simulation& s) { return s.walls().names; });
  number("wall_of_shape", [](const Simulation& s) { return s.walls().wall_of_shape; });
  const auto array = [&](const char* name, std::vector<double> particles::Bodies::*member) {
    scene.def_property_readonly(name, [member](const SharedScene& s) { return s.view(member); });
  };
  using particles::Bodies;
  array("x", &Bodies::x), array("z", &Bodies::z), array("v_x", &Bodies::v_x), array("v_z", &Bodies::v_z);
  array("spin", &Bodies::spin), array("radius", &Bodies::radius);
  const auto copied = [&](const char* name, auto of) {
    scene.def_property_readonly(name, [of](const SharedScene& s) { return owned(s.look(of)); });
  };
  copied("id", [](const Simulation& s) { return s.state().bodies.id; });
  copied("mass", &masses);
  copied("contacts", [](const Simulation& s) { return s.last_contacts(); });
}

}  // namespace drumlin::python
