// The particle engine as a page sees it: a scene is stepped, changed and measured in a browser.
#include <emscripten/bind.h>

#include <deque>
#include <exception>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/measurement.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/stepped_scene.hpp"

namespace drumlin::browser {
namespace {

using emscripten::val;

/// Numbers as a typed array of their own.
template <class T>
val copied(const std::vector<T>& numbers) {
  return val(emscripten::typed_memory_view(numbers.size(), numbers.data())).call<val>("slice");
}

constexpr std::size_t most_snapshots = 100;  // the last ones, which are measured

/// A scene at work: of a drum, which is its only wall, or of a cell that is periodic in x and z.
class LiveScene {
 public:
  /// From a scene's text. `overrides`: a line each, as --set has them.
  LiveScene(const std::string& text, const std::string& overrides)
      : LiveScene(particles::parse_scene(text, "scene", lines_of(overrides))) {}

  void step(int count) {
    for (int k = 0; k < count; ++k) {
      stepped_.step();
      if (!stepped_.simulation().snapshot_due()) continue;
      snapshots_.push_back(stepped_.simulation().take_snapshot());
      if (snapshots_.size() > most_snapshots) snapshots_.pop_front();
    }
  }

  // What was measured before belongs to another flow.
  void set_friction(double grain_grain, double grain_wall) {
    stepped_.set_friction(grain_grain, grain_wall);
    snapshots_.clear();
  }
  void turn(const std::string& wall, double speed_rpm) {
    stepped_.set_wall(wall, {0, 0}, speed_rpm * std::numbers::pi / 30 * scales().time_s, {0, 0});
    snapshots_.clear();
  }
  void shear(double rate_per_s) {
    stepped_.set_shear_rate(rate_per_s * scales().time_s);
    snapshots_.clear();
  }

  double step_time() const {
    const auto& scene = stepped_.scene();
    return scene.stages[stepped_.simulation().next_stage()].time_step_s;
  }
  int steps() const { return static_cast<int>(stepped_.simulation().state().step); }
  double seconds() const { return stepped_.simulation().state().time() * scales().time_s; }
  val x() const { return copied(stepped_.simulation().state().bodies.x); }
  val z() const { return copied(stepped_.simulation().state().bodies.z); }

  /// x, z, radius, v_x and v_z of each grain one after the other, and what is around them.
  val picture() {
    const particles::Bodies& bodies = stepped_.simulation().state().bodies;
    std::vector<float> grains;
    grains.reserve(5 * bodies.count());
    for (std::size_t b = 0; b < bodies.count(); ++b)
      for (const double number : {bodies.x[b], bodies.z[b], bodies.radius[b], bodies.v_x[b], bodies.v_z[b]})
        grains.push_back(static_cast<float>(number));
    val picture = val::object();
    picture.set("grains", copied(grains));
    picture.set("seconds", seconds());
    picture.set("steps", steps());
    const particles::Walls& walls = stepped_.simulation().walls();
    const auto& state = stepped_.simulation().state();
    if (!walls.names.empty()) {
      const auto& drum = std::get<particles::Container>(walls.reference[0]);
      picture.set("radius", drum.radius);
      picture.set("angle", walls.pose(0, state.time_in_stage).angle);
    } else if (state.cell) {
      const particles::Period cell = particles::period_of(*state.cell);
      const std::vector<double> frame{cell.origin, cell.origin_z, cell.length, cell.length_z, cell.offset};
      picture.set("cell", copied(frame));
    }
    return picture;
  }

  /// Scalars with the half widths of their 99 % intervals, and v_x over z, of the last snapshots.
  val measured() const {
    const particles::SnapshotSource source{snapshots_.size(), [&](std::size_t s) { return snapshots_[s]; }};
    val result = val::object();
    result.set("snapshots", snapshots_.size());
    if (snapshots_.size() < 2) return result;
    const particles::Measurement measured = particles::measurement(source, {});
    for (const Scalar& scalar : measured.scalars.scalars) {
      val number = val::object();
      number.set("value", scalar.value);
      if (scalar.ci99) number.set("ci99", *scalar.ci99);
      result.set(scalar.name, number);
    }
    const ProfileColumn& v_x = measured.profiles.column("v_x");
    result.set("z", copied(measured.profiles.z));
    result.set("v_x", copied(v_x.value));
    result.set("v_x_ci99", copied(v_x.ci99));
    return result;
  }

 private:
  explicit LiveScene(const particles::Scene& scene)
      : stepped_(scene, std::make_unique<particles::Simulation>(scene)) {}

  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
  const Scales& scales() const { return stepped_.simulation().scales(); }

  particles::SteppedScene stepped_;
  std::deque<particles::Snapshot> snapshots_;
};

/// What an action returns; JavaScript catches an Error where it throws.
template <class Action>
auto told(const Action& action) {
  try {
    return action();
  } catch (const std::exception& error) {
    val::global("Error").new_(std::string(error.what())).throw_();
  }
}

/// A member function as JavaScript calls it.
template <auto member, class... Arguments>
auto call(LiveScene& scene, Arguments... arguments) {
  return told([&] { return (scene.*member)(std::move(arguments)...); });
}

std::unique_ptr<LiveScene> made(const std::string& text, const std::string& overrides) {
  return told([&] { return std::make_unique<LiveScene>(text, overrides); });
}

EMSCRIPTEN_BINDINGS(engine) {
  emscripten::class_<LiveScene>("LiveScene")
      .constructor(&made)
      .function("step", &call<&LiveScene::step, int>)
      .function("set_friction", &call<&LiveScene::set_friction, double, double>)
      .function("turn", &call<&LiveScene::turn, std::string, double>)
      .function("shear", &call<&LiveScene::shear, double>)
      .function("step_time", &LiveScene::step_time)
      .function("x", &LiveScene::x)
      .function("z", &LiveScene::z)
      .function("picture", &LiveScene::picture)
      .function("measured", &call<&LiveScene::measured>);
}

}  // namespace
}  // namespace drumlin::browser
