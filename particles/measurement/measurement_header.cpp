#include "particles/measurement/measurement_header.hpp"

#include <cmath>

#include "coupling/core/basics/provenance.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {

RunHeader measurement_header(const Measurement& m, const MeasurementOptions& options, bool reduced) {
  RunHeader header;
  header.side = RunSide::particles;
  header.reduced = reduced;
  header.geometry = m.geometry;
  header.theta_deg = m.frame_angle_deg;
  header.axis_depth = m.axis_depth;
  header.wall_z = m.wall_z;
  header.rotation = m.place.rotation;
  header.drum_radius = m.place.container_radius;
  header.diameter_m = m.scales.length_m;
  header.position = options.position;
  header.slice_width = m.place.slice_width;
  header.layer_thickness = m.layer_thickness;
  header.snapshots = m.place.snapshots;
  header.batches = m.place.batches;
  header.interval_factor = m.place.batches > 1 ? interval_factor(m.place.batches) : std::nan("");
  header.revision = provenance().revision;
  return header;
}

RunHeader slice_header(RunHeader centre, const MeasuredSlice& slice) {
  centre.position = slice.position;
  centre.slice_width = slice.width;
  centre.axis_depth = slice.axis_depth;
  centre.wall_z = slice.wall_z;
  return centre;
}

}  // namespace drumlin::particles
