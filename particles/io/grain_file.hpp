#pragma once
// measured/grains/NNNNNN.h5: the fields of every grain of a snapshot (docs/formats/grains.md).
#include <cstdint>
#include <filesystem>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "particles/measurement/grains/grain_fields.hpp"

namespace drumlin::particles {

/// One snapshot's fields and the frame that they are in. Dimensionless; x downslope from the drum's axis, z
/// from the surface along its normal.
struct GrainRecord {
  std::int64_t step = 0;
  double time = 0;
  double frame_angle_deg = 0;   ///< of x below the horizontal
  bool in_mirror = false;       ///< the drum turns anticlockwise and is seen in a mirror
  double container_radius = 0;  ///< 0 without a drum
  double axis_z = 0;            ///< of the drum's axis, of the frame's origin without a drum
  double period_x = 0;          ///< 0: open
  Scales scales;
  std::vector<double> x, z, radius;
  GrainFields fields;  ///< what is empty is left out of the file
};

/// Fields are stored in single precision. Throws IoError when the file cannot be written; an older file of
/// that name is then untouched.
void write_grains(const std::filesystem::path& file, const GrainRecord& record);

}  // namespace drumlin::particles
