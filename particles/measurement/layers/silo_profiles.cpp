#include "particles/measurement/layers/silo_profiles.hpp"

#include <limits>
#include <string>
#include <utility>

namespace drumlin::particles {
namespace {

/// A column of the layers, under the name and with the sign that it has in the axes of the scene.
struct Renamed {
  const char* from;
  const char* name;
  double sign;
};

ProfileSet in_scene(const Slice& slice, std::initializer_list<Renamed> wanted) {
  // No surface crosses infinity: z counts from the origin of the frame.
  SliceProfiles measured = slice_profiles(slice, std::numeric_limits<double>::infinity());
  add_intervals(measured);
  ProfileSet result;
  result.z = std::move(measured.profiles.z);
  for (const Renamed& one : wanted) {
    const ProfileColumn* column = measured.profiles.find(one.from);
    if (column == nullptr) continue;
    result.columns.push_back({one.name, column->value, column->ci99});
    for (double& value : result.columns.back().value) value *= one.sign;
  }
  return result;
}

}  // namespace

LayerGrid height_grid(double x_from, double x_to, const SceneBox& reach, double thickness) {
  return layer_grid(FlowFrame{}, (x_from + x_to) / 2, x_to - x_from, thickness, reach.z_min, reach.z_max, 0,
                    0);
}

LayerGrid width_grid(double z_from, double z_to, const SceneBox& reach, double thickness) {
  // Turned by a quarter: its z is the scene's x, its x points down.
  return layer_grid(FlowFrame{0, 0, 0, -1}, -(z_from + z_to) / 2, z_to - z_from, thickness, reach.x_min,
                    reach.x_max, 0, 0);
}

ProfileSet height_profiles(const Slice& slice) {
  return in_scene(slice, {{"v_x", "v_x", 1},
                          {"v_z", "v_z", 1},
                          {"omega", "omega", 1},
                          {"nu", "nu", 1},
                          {"density", "density", 1},
                          {"sigma_zz_kinetic", "sigma_zz_kinetic", 1},
                          {"sigma_xx_kinetic", "sigma_xx_kinetic", 1},
                          {"sigma_xz_kinetic", "sigma_xz_kinetic", 1},
                          {"sigma_zz", "sigma_zz", 1},
                          {"sigma_xx", "sigma_xx", 1},
                          {"sigma_xz", "sigma_xz", 1},
                          {"k", "k", 1},
                          {"coordination", "coordination", 1},
                          {"count", "count", 1}});
}

ProfileSet width_profiles(const Slice& slice) {
  return in_scene(slice, {{"v_z", "v_x", 1},
                          {"v_x", "v_z", -1},
                          {"shear_rate", "d_v_z_dx", -1},
                          {"omega", "omega", 1},
                          {"nu", "nu", 1},
                          {"density", "density", 1},
                          {"sigma_xx_kinetic", "sigma_zz_kinetic", 1},
                          {"sigma_zz_kinetic", "sigma_xx_kinetic", 1},
                          {"sigma_xz_kinetic", "sigma_xz_kinetic", -1},
                          {"sigma_xx", "sigma_zz", 1},
                          {"sigma_zz", "sigma_xx", 1},
                          {"sigma_xz", "sigma_xz", -1},
                          {"coordination", "coordination", 1},
                          {"count", "count", 1}});
}

}  // namespace drumlin::particles
