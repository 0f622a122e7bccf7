#pragma once
// A drum of 30 grains' width, small enough for tests, as hard cases bend it.
#include <cmath>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/model/drum.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"

namespace drumlin {

/// The law at the centre of the paper's drum: mu = 0.35 + 0.013 ln I.
inline const LogLaw paper_law{0.35, 0.013};

inline continuum::DrumGeometry small_drum() {
  return {.radius = 15, .axis_offset = 1, .rotation = 0.03, .nu = 0.82};
}
/// On cells of 2 d.
inline continuum::FlowProblem small_drum_problem(const continuum::StressLaw& law, double eps = 1e-3,
                                                 const continuum::DrumGeometry& drum = small_drum()) {
  return continuum::drum_problem(drum, law, {.surface_cell = 2, .surface_zone = 6, .levels = 1},
                                 {.entrainment_length = 1}, {.shear_rate = eps});
}
/// The same with the paper's law.
inline continuum::FlowProblem small_drum_problem(const continuum::DrumGeometry& drum = small_drum()) {
  return small_drum_problem(paper_law, 1e-3, drum);
}

/// |Q/Q_expected - 1|: how far the flow is from the mass balance of a full drum that turns.
inline double flux_error(const continuum::FlowField& field, const continuum::DrumGeometry& drum) {
  return std::abs(continuum::discharge(field, drum) / drum.expected_Q() - 1);
}

/// Solves on the coarsest mesh alone.
inline continuum::FlowSolverOptions one_mesh() {
  continuum::FlowSolverOptions options;
  options.levels = 1;
  return options;
}

}  // namespace drumlin
