#include "continuum/fem/detail/linear_solver.hpp"

#include <algorithm>

#include "coupling/common/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

// True relative residual of a solve with factors that asks for no refinement: below every tolerance on the
// flow.
constexpr double enough = 1e-9;

// Iterations go somewhat below the tolerance: their residual is judged against it by the matrix.
constexpr double share_of_tolerance = 0.5;

}  // namespace

bool iterates(const FlowSolverOptions& options, double unknowns) {
  return options.linear_method == LinearMethod::iterative ||
         (options.linear_method == LinearMethod::automatic && unknowns >= options.iterative_from);
}

LinearSolver::LinearSolver(const FlowSolverOptions& options, const Discretisation& d) : options_(options) {
  if (!d.nesting.empty() && iterates(options, static_cast<double>(d.unknowns.n_dofs())))
    iterative_.emplace(d, options.most_linear_iterations);
}

void LinearSolver::prepare(const SystemMatrix& matrix) {
  matrix_ = &matrix;
  has_factors_ = !iterative_;
  if (iterative_)
    iterative_->prepare(matrix);
  else
    factors_.factorise(matrix);
}

double LinearSolver::solve_with_factors(const FieldVector& rhs, FieldVector& solution) {
  if (!has_factors_) factors_.factorise(*matrix_);
  has_factors_ = true;
  return factors_.solve(rhs, solution, enough);
}

double LinearSolver::solve(const FieldVector& rhs, FieldVector& solution, LinearReport& report) {
  ++report.solves;
  report.iterative = iterative_.has_value();
  if (!iterative_) return solve_with_factors(rhs, solution);
  const auto outcome = iterative_->solve(rhs, solution, share_of_tolerance * options_.linear_tolerance);
  report.iterations += outcome.iterations;
  report.most_iterations = std::max(report.most_iterations, outcome.iterations);
  if (outcome.residual <= options_.linear_tolerance || options_.linear_method == LinearMethod::iterative)
    return outcome.residual;
  ++report.direct_instead;
  return solve_with_factors(rhs, solution);
}

}  // namespace drumlin::continuum::fem
