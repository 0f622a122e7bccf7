#pragma once
// A drum of 30 grains' width, as hard cases bend it.
#include "continuum/model/drum.hpp"

namespace drumlin {

inline DrumGeometry small_drum() { return {.radius = 15, .axis_offset = 1, .rotation = 0.03, .nu = 0.82}; }
/// On cells of 2 d.
inline FlowProblem small_drum_problem(const StressLaw& law, double eps = 1e-3,
                                      const DrumGeometry& drum = small_drum()) {
  return drum_problem(drum, law, {.surface_cell = 2, .surface_zone = 6, .levels = 1}, {.corner_taper = 3},
                      {.shear_rate = eps});
}

}  // namespace drumlin
