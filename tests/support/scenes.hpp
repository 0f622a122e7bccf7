#pragma once
// Small scenes for tests and hard cases, put together call by call, and their runs. Numbers are in units of
// the simulation (d, sqrt(d/g), rho0 g d); of the scene d = 1 mm, g = 9.81 m/s2, 2700 kg/m3.
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin::test {
using namespace particles;

using drumlin::testing::TemporaryFolder;

/// Units of these scenes in s, mm/s, kg/m, N/m and N/m2, and the weight of a disc of diameter 1.
inline const double time_s = std::sqrt(1e-3 / 9.81), mm_s = 1 / time_s;
constexpr double mass_unit = 2700e-6, force_unit = mass_unit * 9.81, pressure_unit = force_unit * 1e3,
                 weight = std::numbers::pi / 4;

inline double rpm_of(double spin) { return spin / time_s * 60 / (2 * std::numbers::pi); }
inline Rotation turning(double spin, const Point_mm& center = {0, 0}) { return {rpm_of(spin), center}; }
inline ForceControl pushed(const Point_mm& direction, double force, double mass) {
  return {direction, force * force_unit, mass * mass_unit};
}

struct Grain {
  double x = 0, z = 0, diameter = 1, v_x = 0, v_z = 0, spin = 0;
};

inline void add_stage(Scene& scene, double duration, double time_step) {
  Stage& stage = scene.stages.emplace_back();
  stage.name = "stage" + std::to_string(scene.stages.size());
  stage.duration_s = duration * time_s;
  stage.time_step_s = time_step * time_s;
}

inline Wall segment(const std::string& name, const Point_mm& from, const Point_mm& to) {
  return {name, SegmentShape{from, to}};
}
inline Wall floor_wall(double half_length = 1000) {
  return segment("floor", {-half_length, 0}, {half_length, 0});
}
inline Wall drum_wall(double radius) { return {"drum", ContainerShape{{0, 0}, radius}}; }
/// Four walls with their corners at (+-half, +-half).
inline std::vector<Wall> box_walls(double half) {
  return {segment("floor", {-half, -half}, {half, -half}), segment("top", {-half, half}, {half, half}),
          segment("left", {-half, -half}, {-half, half}), segment("right", {half, -half}, {half, half})};
}

/// A scene under construction.
struct TestScene : Scene {
  TestScene& between(std::vector<Wall> added) {
    walls = std::move(added);
    return *this;
  }
  template <class... E>
  TestScene& with(const E&... added) {
    each_effect(
        [&]<class Kind>(std::optional<Kind>& effect) {
          const auto set = [&](const auto& one) {
            if constexpr (std::is_same_v<const Kind&, decltype(one)>) effect = one;
          };
          (set(added), ...);
        },
        effects);
    return *this;
  }
  /// One stage more.
  TestScene& lasting(double duration, double time_step) {
    add_stage(*this, duration, time_step);
    return *this;
  }
  /// A motion in the last stage.
  template <class Motion>
  TestScene& moving(const std::string& wall, const Motion& motion) {
    stages.back().motions.push_back({wall, motion});
    return *this;
  }
};

/// Of the given grains alone, solved strictly.
inline TestScene scene_of(const std::vector<Grain>& grains) {
  static const TemporaryFolder folder;
  static int scenes = 0;
  const auto file = folder / (std::to_string(++scenes) + ".csv");
  std::ofstream out(file);
  out.precision(17);
  out << "x_mm,z_mm,diameter_mm,v_x_mm_s,v_z_mm_s,spin_rad_s\n";
  for (const Grain& g : grains)
    out << g.x << ',' << g.z << ',' << g.diameter << ',' << g.v_x * mm_s << ',' << g.v_z * mm_s << ','
        << g.spin / time_s << '\n';
  out.close();
  TestScene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = ListedGrains{file};
  scene.solver.tolerance = 1e-9;
  scene.solver.penetration_tolerance = 1e-9;
  scene.solver.max_sweeps = 5000;
  return scene;
}

/// Discs one on the other on a floor at z = 0.
inline std::vector<Grain> column_of(int discs) {
  std::vector<Grain> grains;
  for (int k = 0; k < discs; ++k) grains.push_back({0, 0.5 + k});
  return grains;
}

/// Grains that fall on a floor at z = 0.
inline TestScene on_floor(const std::vector<Grain>& grains) {
  return scene_of(grains).between({floor_wall()}).with(Gravity{});
}

/// Grains that the program places, with its own solver settings.
inline TestScene scene_of(const GeneratedGrains& grains) {
  TestScene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = grains;
  return scene;
}

/// A simulation that goes on by itself.
struct TestRun : Simulation {
  using Simulation::Simulation;
  const Bodies& bodies() const { return state().bodies; }
  double time() const { return state().time(); }
  double kinetic() const { return kinetic_energy(bodies()); }
  /// To the end of the scene; `see` takes the report of each step, or nothing.
  template <class See>
  void each_step(See see) {
    while (!finished()) {
      const StepReport report = step();
      if constexpr (std::is_invocable_v<See, const StepReport&>)
        see(report);
      else
        see();
    }
  }
  void to_end() {
    each_step([] {});
  }
  void to_step(std::int64_t steps) {
    while (state().step < steps) (void)step();
  }
  void to_time(double end) {
    while (time() < end - 1e-9) (void)step();
  }
};

/// At the end of its scene.
struct EndedRun : TestRun {
  template <class... Arguments>
  explicit EndedRun(Arguments&&... arguments) : TestRun(std::forward<Arguments>(arguments)...) {
    to_end();
  }
};

inline Bodies bodies_at_end(const Scene& scene) { return EndedRun(scene).bodies(); }

inline double total_mass(const Bodies& bodies) {
  double mass = 0;
  for (const double inverse : bodies.inverse_mass) mass += 1 / inverse;
  return mass;
}
inline Point momentum(const Bodies& bodies) {
  Point sum;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    sum.x += bodies.v_x[b] / bodies.inverse_mass[b], sum.z += bodies.v_z[b] / bodies.inverse_mass[b];
  return sum;
}

}  // namespace drumlin::test
