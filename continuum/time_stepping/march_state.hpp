#pragma once
// State of a march in time between two steps: what it goes on from.
#include "continuum/fem/flow_state.hpp"

namespace drumlin::continuum {

struct MarchState {
  FlowState state = {};    ///< without cells: rest
  int steps = 0;           ///< that are done
  double start_share = 0;  ///< speed of rotation at the start over that of the scene
};

}  // namespace drumlin::continuum
