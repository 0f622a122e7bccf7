#pragma once
// A discretisation with a state on it: what FlowField looks into. Private to fem/.
#include "continuum/fem/detail/assembly.hpp"

namespace drumlin::continuum::fem {

struct SolvedLevel {
  FlowProblem problem;
  std::shared_ptr<Discretisation> discretisation;
  Setting setting;
  State state;
};

}  // namespace drumlin::continuum::fem
