// drumlin solve-contacts: one contact problem from a file, measured by the project's residual.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/support/commands.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/common/errors.hpp"
#include "particles/io/contact_problem_file.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::apps {

int solve_contacts(const SolveContactsOptions& options) {
  const particles::BlockProblem problem = particles::read_contact_problem(options.problem);
  if (options.output) prepare_output_file(*options.output, ExistingOutput::refuse);
  const auto solve = particles::contact_solver<particles::BlockProblem>(options.solver);
  particles::StoppingRule rule;
  rule.tolerance = options.tolerance;
  rule.max_seconds = options.max_seconds;
  rule.max_sweeps = std::numeric_limits<int>::max();
  particles::SolverWorkspace<particles::BlockProblem> work;
  particles::Solution<particles::BlockProblem> solution;
  const particles::SolveReport report = solve(problem, rule, work, solution);
  if (options.output)
    particles::write_contact_solution(*options.output, solution.impulses, solution.velocities.contacts);
  if (options.json) {
    const nlohmann::ordered_json printed = {{"status", particles::to_string(report.status)},
                                            {"residual", report.residual.rms},
                                            {"residual_max", report.residual.max},
                                            {"sweeps", report.sweeps},
                                            {"seconds", report.seconds},
                                            {"contacts", problem.contacts()},
                                            {"solver", options.solver},
                                            {"tolerance", options.tolerance}};
    fmt::print("{}\n", printed.dump(2));
  } else {
    fmt::print(
        "{} contacts, {}: {} after {} sweeps, {:.3g} s; residual {:.3g} (tolerance {:g}), largest {:.3g}\n",
        problem.contacts(), options.solver, particles::to_string(report.status), report.sweeps,
        report.seconds, report.residual.rms, options.tolerance, report.residual.max);
  }
  return static_cast<int>(report.status == particles::Status::converged ? ExitCode::done
                                                                        : ExitCode::not_converged);
}

}  // namespace drumlin::apps
