#pragma once
// Iteration for the shape of a moving surface, whose normal stress has to vanish. Private to fem/.
#include <functional>
#include <memory>

#include "continuum/fem/detail/moving_surface.hpp"

namespace drumlin::continuum::fem {

/// How far a flow is solved, and the memory of the axes with it: as the options ask, as far as a step of the
/// surface needs while much still presses on it, or (memory) further than the options ask, where what is left
/// of its change hides what a step of the surface does.
enum class Settling { whole, loose, fine };

/// What the iteration needs of the solver: Newton's method on the mesh as it stands, and a solution from the
/// level's state, near the last one.
struct SurfaceSolver {
  std::function<std::unique_ptr<Newton>()> newton;
  std::function<bool(Newton&, Settling)> solve;
  Settling first = Settling::loose;                       ///< of the state that the iteration begins with
  std::function<void(const SurfaceStepReport&)> stepped;  ///< empty: not observed
  double tolerance = 0;                                   ///< d; where it is larger than the problem's
};

/// Newton's method on flow and shape: the free coefficients of the shape against those of what presses on it,
/// with the response of the flow from differences, which moves the flow with the shape. From step to step the
/// response is corrected by what was seen (Broyden); where a step with it does not lessen the misfit, or
/// makes all that presses grow by more than half, it is formed anew, and where that does not help steps are
/// halved. The level has to be solved loosely with the surface as it is.
bool solve_surface(const SurfaceSolver&, SolvedLevel&, int mesh, FlowReport&);

}  // namespace drumlin::continuum::fem
