#pragma once
// A map: fields over the nodes of a rectangle in the plane of the flow, with its header.
#include <cstddef>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/results/run_header.hpp"

namespace drumlin {

/// Nodes at x_first + column spacing_x, z_first + row spacing_z. Flow frame as in ProfileSet: x downslope
/// along the surface, z along its outward normal, z = 0 at the surface of the profile; x = 0 below the drum's
/// axis.
struct MapGrid {
  double x_first = 0, z_first = 0;      ///< d
  double spacing_x = 1, spacing_z = 1;  ///< d
  std::size_t columns = 0, rows = 0;
  std::size_t nodes() const { return columns * rows; }
  double x_of(std::size_t column) const { return x_first + static_cast<double>(column) * spacing_x; }
  double z_of(std::size_t row) const { return z_first + static_cast<double>(row) * spacing_z; }
};

/// One quantity over the nodes, row after row from the lowest up; NaN marks a node where it was not computed.
struct MapField {
  std::string name;
  std::vector<double> value;
  std::vector<double> ci99;  ///< half width of the 99 % interval; empty when the quantity has none
};

/// Maps of one run, dimensionless (docs/conventions.md), velocities in the frame of the drum. Names of the
/// fields, the same on both sides: docs/formats/quantities.md.
struct FieldMap {
  MapGrid grid;
  std::vector<MapField> fields;
  RunHeader header;  ///< settings and provenance, keys as in a ProfileSet
  Scales scales;

  const MapField* find(const std::string& name) const;
  const MapField& field(const std::string& name) const;  ///< throws InputError if it is missing
};

/// z of the highest node of each column with nu >= surface_nu, and on towards the node above, linearly to
/// surface_nu, where that has a value; NaN where no node is that dense. `nu`: one per node.
std::vector<double> surface_heights(const MapGrid& grid, const std::vector<double>& nu, double surface_nu);

/// What keeps a map from being written or read, in words; empty when nothing does: a grid without nodes or
/// with a spacing that is not positive, a field without a name or named twice, with another length than the
/// grid, with a number beyond largest_value.
std::string fault_of(const FieldMap& map);

}  // namespace drumlin
