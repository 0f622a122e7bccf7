// One contact problem, solved and judged: u = W r + q, Signorini's condition and Coulomb's law at each
// contact. Two contacts of a disc that slides into a corner; normal components first.
#include <cstdio>
#include <vector>

#include "particles/lab/matrix_problem.hpp"
#include "particles/lab/solve_contacts.hpp"

using namespace drumlin::particles;

int main() {
  // A disc of mass 1 (J = 1/2) on a floor and against a wall: inverse masses of the contacts, and how they
  // couple.
  const std::vector<double> W = {1, 0,  0,  1,  //
                                 0, 3,  -1, 2,  //
                                 0, -1, 1,  0,  //
                                 1, 2,  0,  3};
  const std::vector<double> q = {-1, 0.5, -0.5, -1};  // velocities that there would be without contacts
  const std::vector<double> friction = {0.3, 0.3};
  const BlockProblem problem = dense_problem(W, q, friction);

  StoppingRule rule;
  rule.tolerance = 1e-12;
  rule.max_sweeps = 10000;
  const SolvedContacts solved = solve_contacts(problem, rule);
  const std::vector<double>&r = solved.solution.impulses, &u = solved.solution.velocities.contacts;
  std::printf("%s after %d sweeps, residual %.1e\n", drumlin::name_of(solved.report.status),
              solved.report.sweeps, solved.report.residual.rms);
  for (int a = 0; a < problem.contacts(); ++a)
    std::printf("contact %d: impulse %8.5f normal, %8.5f tangential; velocity %8.5f, %8.5f\n", a, r[2 * a],
                r[2 * a + 1], u[2 * a], u[2 * a + 1]);
  // The judge shares nothing with the solver: it looks at impulses alone.
  const std::vector<double> guess = {1, 0, 0, 0};
  Solution<BlockProblem> other{guess, {}};
  std::printf("a guess has residual %.2f\n", residual_of(problem, other).rms);
  return solved.report.status == Status::converged ? 0 : 3;
}
