#include "coupling/comparison/map_sampling.hpp"

#include <array>
#include <cmath>
#include <string>

#include "coupling/core/basics/bilinear.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/layer_ratios.hpp"

namespace drumlin::coupling {

namespace {

constexpr double rounding = 1e-9;  // of a spacing: a place this near to a node is the node

/// A place on an axis, counted in nodes; NaN outside of it.
double on_axis(double at, std::size_t nodes) {
  const double nearest = std::round(at);
  if (std::abs(at - nearest) <= rounding) at = nearest;
  return at >= 0 && at <= static_cast<double>(nodes - 1) ? at : no_value;
}

/// Places whose mean stands for a box: the middles of equal pieces.
struct Box {
  static constexpr int across = 8, along = 4;
  double x = 0, z = 0, width = 0, height = 0;
};

double mean_over(const MapGrid& grid, const std::vector<double>& values, const Box& box) {
  double sum = 0;
  for (int i = 0; i < Box::across; ++i)
    for (int k = 0; k < Box::along; ++k)
      sum += bilinear(grid, values, box.x + box.width * ((i + 0.5) / Box::across - 0.5),
                      box.z + box.height * ((k + 0.5) / Box::along - 0.5));
  return sum / (Box::across * Box::along);
}

/// Name of the field in a map, name of the column in a profile.
struct Sampled {
  const char* field;
  const char* column;
  bool needed;
};
constexpr std::array sampled{Sampled{"v_x", "v_x", true},
                             Sampled{"v_z", "v_z", false},
                             Sampled{"d_v_x_dz", "shear_rate", true},
                             Sampled{"half_vorticity", "half_vorticity", false},
                             Sampled{"d_v_x_dx", "d_v_x_dx", false},
                             Sampled{"d_v_z_dz", "d_v_z_dz", false},
                             Sampled{"nu", "nu", false},
                             Sampled{"sigma_xx", "sigma_xx", true},
                             Sampled{"sigma_zz", "sigma_zz", true},
                             Sampled{"sigma_xz", "sigma_xz", true}};

}  // namespace

double bilinear(const MapGrid& grid, const std::vector<double>& values, double x, double z) {
  const double column = on_axis((x - grid.x_first) / grid.spacing_x, grid.columns);
  const double row = on_axis((z - grid.z_first) / grid.spacing_z, grid.rows);
  if (std::isnan(column + row)) return no_value;
  double sum = 0;
  each_corner(column, row, [&](double c, double r, double weight) {
    // A node that does not count may lie outside of the grid or have no value.
    if (weight > 0)
      sum += weight * values[static_cast<std::size_t>(r) * grid.columns + static_cast<std::size_t>(c)];
  });
  return sum;
}

ProfileSet profile_through(const FieldMap& map, double position, double width, const std::vector<double>& z,
                           double thickness) {
  ProfileSet set;
  set.z = z;
  set.header = map.header;
  set.header.position = position;
  set.header.slice_width = width;
  set.header.layer_thickness = thickness;
  for (const Sampled& wanted : sampled) {
    const MapField* field = wanted.needed ? &map.field(wanted.field) : map.find(wanted.field);
    if (field == nullptr) continue;
    ProfileColumn column{wanted.column, {}, {}};
    for (const double at : z) {
      const Box box{position, at, width, thickness};
      column.value.push_back(mean_over(map.grid, field->value, box));
      if (!field->ci99.empty()) column.ci99.push_back(mean_over(map.grid, field->ci99, box));
    }
    set.columns.push_back(std::move(column));
  }
  add_layer_ratios(set);
  return set;
}

}  // namespace drumlin::coupling
