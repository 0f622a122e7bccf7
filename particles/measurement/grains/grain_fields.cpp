#include "particles/measurement/grains/grain_fields.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace drumlin::particles {
namespace {

using std::numbers::pi;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

void add_contact_stress(const FlowSnapshot& in_frame, const std::vector<double>& cell_area,
                        GrainStress& stress) {
  const std::size_t count = cell_area.size();
  for (auto* component : {&stress.xx, &stress.zz, &stress.xz}) component->assign(count, 0.0);
  for (const HalfBranch& half : in_frame.half_branches()) {  // `toward` is against b
    stress.xx[half.grain] -= half.force_x * half.toward_x;
    stress.zz[half.grain] -= half.force_z * half.toward_z;
    stress.xz[half.grain] += half.force_x * half.toward_z;
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
    const double density = in_frame.density.empty() ? fraction : in_frame.density[i] * fraction;
    stress.xx.push_back(density * c_x * c_x);
    stress.zz.push_back(density * c_z * c_z);
    stress.xz.push_back(-density * c_x * c_z);
  }
}

}  // namespace

GrainFields grain_fields(const Snapshot& snapshot, const FlowSnapshot& in_frame, const GrainFieldSet& wanted,
                         const VelocityMap* mean_velocity, const VoronoiOptions& options) {
  const std::size_t count = in_frame.x.size();
  // Contacts that nobody knows of give no stress, not a stress of 0.
  const bool pressed = wanted.has(GrainField::contact_stress) && in_frame.contacts_known;
  const bool rotates = wanted.has(GrainField::rotational_stress) && !in_frame.spin.empty();
  GrainFields fields;
  std::vector<double> area;  // NaN also where there is no room: nothing can be divided by it
  if (wanted.has(GrainField::cell) || pressed || wanted.has(GrainField::kinetic_stress) || rotates) {
    const auto cells = voronoi_cells(snapshot, options);
    for (const VoronoiCell& cell : cells) area.push_back(cell.area > 0 ? cell.area : none);
    if (wanted.has(GrainField::cell)) {
      for (std::size_t i = 0; i < count; ++i) {
        fields.open_cell.push_back(cells[i].open ? 1 : 0);
        fields.nu.push_back(pi * in_frame.radius[i] * in_frame.radius[i] / area[i]);
      }
    }
  }
  if (wanted.has(GrainField::velocity)) {
    fields.v_x = in_frame.v_x;
    fields.v_z = in_frame.v_z;
  }
  if (wanted.has(GrainField::spin)) fields.spin = in_frame.spin;
  if (pressed) add_contact_stress(in_frame, area, fields.contact);
  if (wanted.has(GrainField::kinetic_stress)) {
    assert(mean_velocity != nullptr);
    add_kinetic_stress(in_frame, area, *mean_velocity, fields.kinetic);
  }
  for (std::size_t i = 0; i < count && rotates; ++i) {
    fields.rotational.push_back(pi / 4 * std::pow(in_frame.radius[i], 4) * in_frame.spin[i] *
                                in_frame.spin[i] / area[i]);
    if (!in_frame.density.empty()) fields.rotational.back() *= in_frame.density[i];
  }
  if (wanted.has(GrainField::coordination) && in_frame.contacts_known)
    fields.coordination.assign(in_frame.coordination.begin(), in_frame.coordination.end());
  if (wanted.has(GrainField::cell)) fields.cell_area = std::move(area);
  return fields;
}

}  // namespace drumlin::particles
