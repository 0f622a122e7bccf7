#pragma once
// Workspace of the conjugate projected gradient; the solver itself is declared with the others in
// contact_solver.hpp.
#include <vector>

namespace drumlin::particles {

struct ProjectedGradientWorkspace {
  std::vector<double> zero, preconditioner;
  std::vector<double> bound;             ///< of the friction of each contact, as it stands
  std::vector<double> u;                 ///< W r + q
  std::vector<double> gradient;          ///< preconditioned, downhill, projected on the tangent cone
  std::vector<double> direction, image;  ///< p and W p
  std::vector<double> r_before, u_before;
  std::vector<double> in_cone;  ///< r with its friction held to Coulomb's cone: what is returned
};

}  // namespace drumlin::particles
