#include "particles/measurement/grains/grain_fields.hpp"

#include <cmath>
#include <numbers>

#include "coupling/common/no_value.hpp"

namespace drumlin::particles {
namespace {

using std::numbers::pi;

void add_contact_stress(const FlowSnapshot& in_frame, const std::vector<double>& cell_area,
                        GrainStress& stress) {
  const std::size_t count = cell_area.size();
  for (auto* component : {&stress.xx, &stress.zz, &stress.xz}) component->assign(count, 0.0);
  for (const HalfBranch<2>& half : in_frame.half_branches()) {  // `toward` is against b
    stress.xx[half.grain] -= half.force[0] * half.toward[0];
    stress.zz[half.grain] -= half.force[1] * half.toward[1];
    stress.xz[half.grain] += half.force[0] * half.toward[1];
  }
  for (auto* component : {&stress.xx, &stress.zz, &stress.xz})
    for (std::size_t i = 0; i < count; ++i) (*component)[i] /= cell_area[i];
}

void add_kinetic_stress(const FlowSnapshot& in_frame, const std::vector<double>& cell_area,
                        const VelocityMap& mean_velocity, GrainStress& stress) {
  for (std::size_t i = 0; i < cell_area.size(); ++i) {
    const auto mean = mean_velocity.at(in_frame.x[i], in_frame.z[i]);
    const double c_x = in_frame.v_x[i] - mean[0], c_z = in_frame.v_z[i] - mean[1];
    const double fraction = pi * in_frame.radius[i] * in_frame.radius[i] / cell_area[i];
    const double density = in_frame.density_of(i) * fraction;
    stress.xx.push_back(density * c_x * c_x);
    stress.zz.push_back(density * c_z * c_z);
    stress.xz.push_back(-density * c_x * c_z);
  }
}

}  // namespace

GrainFields grain_fields(const Snapshot& snapshot, const FlowSnapshot& in_frame,
                         const VelocityMap* mean_velocity, const VoronoiOptions& options) {
  GrainFields fields;
  fields.v_x = in_frame.v_x;
  fields.v_z = in_frame.v_z;
  fields.spin = in_frame.spin;
  std::vector<double>& area = fields.cell_area;
  for (const VoronoiCell& cell : voronoi_cells(snapshot, options)) {
    // NaN also where there is no room: nothing can be divided by it.
    area.push_back(cell.area > 0 ? cell.area : no_value);
    fields.open_cell.push_back(cell.open ? 1 : 0);
  }
  for (std::size_t i = 0; i < area.size(); ++i) {
    const double radius = in_frame.radius[i];
    fields.nu.push_back(pi * radius * radius / area[i]);
    if (!in_frame.spin.empty())
      fields.rotational.push_back(pi / 4 * std::pow(radius, 4) * in_frame.spin[i] * in_frame.spin[i] /
                                  area[i] * in_frame.density_of(i));
  }
  if (in_frame.contacts_known) {  // else there is no stress, not one of 0
    add_contact_stress(in_frame, area, fields.contact);
    fields.coordination.assign(in_frame.coordination.begin(), in_frame.coordination.end());
  }
  if (mean_velocity) add_kinetic_stress(in_frame, area, *mean_velocity, fields.kinetic);
  return fields;
}

}  // namespace drumlin::particles
