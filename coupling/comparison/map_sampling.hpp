#pragma once
// Values of maps between their nodes, and profiles through them.
#include <vector>

#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin::coupling {

/// Bilinear between the four nodes around (x, z), the node itself where it is one; NaN outside of the grid
/// and beside a node without a value. `values` are one per node.
double bilinear(const MapGrid& grid, const std::vector<double>& values, double x, double z);

/// Profile through a map at `position`: means over boxes of this width, one layer each around `z`, in the
/// layers that lie wholly inside the map. Columns v_x, v_z, shear_rate (mean of d_v_x_dz), half_vorticity,
/// d_v_x_dx, d_v_z_dz, nu, sigma_xx, sigma_zz, sigma_xz, and of the means I, mu, k as profiles define them;
/// with the mean of the map's half widths where it has them (what moves a whole field moves its mean as
/// much). The header is the map's, with
/// position, slice_width and layer_thickness. Throws InputError if the map lacks v_x, d_v_x_dz or a
/// stress.
ProfileSet profile_through(const FieldMap& map, double position, double width, const std::vector<double>& z,
                           double thickness);

}  // namespace drumlin::coupling
