#pragma once
// Coulomb's law of a contact whose own block couples the normal with the tangent (W_nt != 0), as blocks from
// files may.
#include <Eigen/Dense>

namespace drumlin::particles {

/// Exact solution of one planar frictional contact u = W r + q with a full 2x2 block: no contact, sticking,
/// or sliding forwards or backwards, whichever satisfies its own inequalities. W must be positive definite on
/// its diagonal.
Eigen::Vector2d solve_planar_contact(const Eigen::Matrix2d& W, const Eigen::Vector2d& q, double mu);

/// The same in a sweep, from impulses `old`: of steep friction a part of the step (step_fraction).
Eigen::Vector2d solved_coupled(const Eigen::Matrix2d& W, const Eigen::Vector2d& q, double mu,
                               const Eigen::Vector2d& old);

}  // namespace drumlin::particles
