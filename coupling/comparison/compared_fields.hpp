#pragma once
// The fields that a comparison covers, each taken from the profiles or maps of a side.
#include <string>
#include <vector>

#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin::coupling {

/// Those that the table of quantities marks, in its order.
const std::vector<std::string>& compared_fields();

/// Of a compared field, without its logarithm: the shear rate of maps is strain_rate.
std::string name_in_maps(const std::string& field);

/// A field at the layers of a profile or the nodes of a map.
struct FieldValues {
  std::vector<double> value;
  std::vector<double> ci99;  ///< half width of the 99 % band, NaN where unknown
  std::vector<char> noise;   ///< 1 where there is a number, but its 99 % interval leaves its sign open
  bool present = false;      ///< false: this side does not have the field at all
};

/// By name; a name that is none of compared_fields() is a column of the profiles. With the columns of a
/// profile p = (sigma_xx + sigma_zz)/2, and axis_angle_deg from the stresses, the shear rate, the slope
/// dv_z/dx (from half_vorticity, or d_v_z_dx), dv_z/dz (d_v_z_dz, or differences of v_z from layer to layer)
/// and dv_x/dx (d_v_x_dx, or -dv_z/dz). Of the logarithms and of the axis angle the particles have a value
/// where the shear rate exceeds its own interval: deeper down they would be noise. The intervals of derived
/// fields take their parts for independent. Throws InputError if v_x, a stress or the shear rate is missing.
FieldValues profile_field(const std::string& name, const ProfileSet& profiles);

/// The same of a map, with its invariants: the shear rate is strain_rate, I, mu and p are those of
/// coupling/core/results/plane_invariants.hpp.
FieldValues map_field(const std::string& name, const FieldMap& map);

}  // namespace drumlin::coupling
