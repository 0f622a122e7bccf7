#include "particles/measurement/grains/grain_fields.hpp"

#include "coupling/core/basics/no_value.hpp"
#include "particles/measurement/frame/grain_bins.hpp"

namespace drumlin::particles {
namespace {

void add_stress(const Tensor<2>& pressure, GrainStress& stress) {
  stress.xx.push_back(pressure[0][0]);
  stress.zz.push_back(pressure[1][1]);
  stress.xz.push_back(-pressure[0][1]);
}

}  // namespace

GrainFields grain_fields(const Snapshot& snapshot, const FlowSnapshot& in_frame,
                         const VelocityMap* mean_velocity) {
  GrainFields fields;
  fields.v_x = in_frame.v_x;
  fields.v_z = in_frame.v_z;
  fields.spin = in_frame.spin;
  for (const VoronoiCell& cell : voronoi_cells(snapshot)) {
    // NaN also where there is no room: nothing can be divided by it.
    fields.cell_area.push_back(cell.area > 0 ? cell.area : no_value);
    fields.open_cell.push_back(cell.open ? 1 : 0);
  }
  const std::vector<GrainSum> sums = sums_of_grains(in_frame);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const GrainSample<2> grain = in_frame.grain(i);
    const double area = fields.cell_area[i];
    const Fields<2> of_cell = derive(sums[i], Background<2>{area});
    fields.nu.push_back(of_cell.nu);
    if (!in_frame.spin.empty()) fields.rotational.push_back(grain.spin_energy() / area);
    if (in_frame.contacts_known)  // else there is no stress, not one of 0
      add_stress(of_cell.contact, fields.contact);
    if (!mean_velocity) continue;
    const auto mean = mean_velocity->at(grain.at[0], grain.at[1]);
    Spread<2> about_mean;
    about_mean.add(grain.mass() / area, {grain.velocity[0] - mean[0], grain.velocity[1] - mean[1]});
    const double xz = about_mean.product(0, 1);
    add_stress({{{about_mean.product(0, 0), xz}, {xz, about_mean.product(1, 1)}}}, fields.kinetic);
  }
  if (in_frame.contacts_known)
    fields.coordination.assign(in_frame.coordination.begin(), in_frame.coordination.end());
  return fields;
}

}  // namespace drumlin::particles
