#pragma once
// Small scenes for tests: grains listed one by one, walls, one stage.
#include <gtest/gtest.h>

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

/// A grain in the units of the simulation (d = 1 for diameter 1): tests reason in d, sqrt(d/g).
struct Grain {
  double x = 0, z = 0, diameter = 1, v_x = 0, v_z = 0, spin = 0;
};

using drumlin::testing::TemporaryFolder;

/// sqrt(d/g) in s where d = 1 mm, as in the scenes below.
inline const double time_s = std::sqrt(1e-3 / 9.81);

/// Of a spin in units of the simulation.
inline double rpm_of(double spin) { return spin / time_s * 60 / (2 * std::numbers::pi); }

/// A scene made of the given grains: d = 1 mm, g = 9.81 m/s2.
inline Scene scene_of(const std::vector<Grain>& grains) {
  static const TemporaryFolder folder;
  static int scenes = 0;
  const double speed = 1 / time_s;
  const auto file = folder / (std::to_string(++scenes) + ".csv");
  std::ofstream out(file);
  out.precision(17);
  out << "x_mm,z_mm,diameter_mm,v_x_mm_s,v_z_mm_s,spin_rad_s\n";
  for (const Grain& g : grains)
    out << g.x << ',' << g.z << ',' << g.diameter << ',' << g.v_x * speed << ',' << g.v_z * speed << ','
        << g.spin / time_s << '\n';
  out.close();
  Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = ListedGrains{file};
  scene.solver.tolerance = 1e-9;
  scene.solver.penetration_tolerance = 1e-9;
  scene.solver.max_sweeps = 5000;
  return scene;
}

/// Adds a stage in simulation units.
inline void add_stage(Scene& scene, double duration, double time_step) {
  Stage stage;
  stage.name = "stage";
  stage.duration_s = duration * time_s;
  stage.time_step_s = time_step * time_s;
  scene.stages.push_back(stage);
}

inline Wall floor_wall(double half_length = 1000) {
  return {"floor", SegmentShape{{-half_length, 0}, {half_length, 0}}};
}

/// The same that fall on a floor at z = 0.
inline Scene on_floor(const std::vector<Grain>& grains) {
  Scene scene = scene_of(grains);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  return scene;
}

/// A simulation at the end of its scene.
struct EndedSimulation : Simulation {
  template <class... Arguments>
  explicit EndedSimulation(Arguments&&... arguments) : Simulation(std::forward<Arguments>(arguments)...) {
    while (!finished()) (void)step();
  }
};

inline Bodies bodies_at_end(const Scene& scene) { return EndedSimulation(scene).state().bodies; }

/// To the last bit.
inline void expect_same(const Bodies& a, const Bodies& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.v_x, b.v_x);
  EXPECT_EQ(a.v_z, b.v_z);
  EXPECT_EQ(a.spin, b.spin);
}

}  // namespace drumlin::test
