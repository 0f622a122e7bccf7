#pragma once
// Small scenes for tests: grains listed one by one, walls, one stage.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::test {

/// A grain in the units of the simulation (d = 1 for diameter 1): tests reason in d, sqrt(d/g).
struct Grain {
  double x = 0, z = 0, diameter = 1, v_x = 0, v_z = 0, spin = 0;
};

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "drumlin-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A scene whose mean diameter is `unit_mm`, made of the given grains: d = unit_mm, g = 9.81 m/s2.
inline particles::Scene scene_of(const std::vector<Grain>& grains, const TemporaryFolder& folder,
                                 double unit_mm = 1) {
  const double time_s = std::sqrt(unit_mm * 1e-3 / 9.81), speed = unit_mm / time_s;
  const auto file = folder.path() / "grains.csv";
  std::ofstream out(file);
  out.precision(17);
  out << "x_mm,z_mm,diameter_mm,v_x_mm_s,v_z_mm_s,spin_rad_s\n";
  for (const Grain& g : grains)
    out << g.x * unit_mm << ',' << g.z * unit_mm << ',' << g.diameter * unit_mm << ',' << g.v_x * speed << ','
        << g.v_z * speed << ',' << g.spin / time_s << '\n';
  out.close();
  particles::Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = particles::ListedGrains{file};
  scene.solver.tolerance = 1e-9;
  scene.solver.penetration_tolerance = 1e-9;
  scene.solver.max_sweeps = 5000;
  return scene;
}

/// Adds a stage in simulation units.
inline void add_stage(particles::Scene& scene, double duration, double time_step, double unit_mm = 1) {
  const double time_s = std::sqrt(unit_mm * 1e-3 / 9.81);
  particles::Stage stage;
  stage.name = "stage";
  stage.duration_s = duration * time_s;
  stage.time_step_s = time_step * time_s;
  scene.stages.push_back(stage);
}

inline particles::Wall floor_wall(double half_length = 1000, double unit_mm = 1) {
  return {"floor", particles::SegmentShape{{-half_length * unit_mm, 0}, {half_length * unit_mm, 0}}};
}

}  // namespace drumlin::test
