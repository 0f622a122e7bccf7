// drumlin solve-contacts: one contact problem from a file, judged by the project's residual.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/io/contact_problem_file.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::apps {

int solve_contacts(const SolveContactsOptions& options) {
  const BlockProblem problem = read_contact_problem(options.problem);
  if (options.output) prepare_output_file(*options.output, ExistingOutput::refuse);
  const auto solve = contact_solver<BlockProblem>(options.solver);
  StoppingRule rule;
  rule.tolerance = options.tolerance;
  rule.max_seconds = options.max_seconds;
  rule.max_sweeps = std::numeric_limits<int>::max();
  SolverScratch<BlockProblem> scratch;
  std::vector<double> r(problem.q.size(), 0.0);
  const SolveReport report = solve(problem, rule, scratch, r);
  if (options.output) {
    std::vector<double> u, unused;
    problem.W.velocities(r, problem.q, unused, u);
    write_contact_solution(*options.output, r, u);
  }
  if (options.json) {
    const nlohmann::ordered_json printed = {{"status", to_string(report.status)},
                                            {"residual", report.judgement.residual},
                                            {"residual_max", report.judgement.residual_max},
                                            {"sweeps", report.sweeps},
                                            {"seconds", report.seconds},
                                            {"contacts", problem.contacts()},
                                            {"solver", options.solver},
                                            {"tolerance", options.tolerance}};
    fmt::print("{}\n", printed.dump(2));
  } else {
    fmt::print(
        "{} contacts, {}: {} after {} sweeps, {:.3g} s; residual {:.3g} (tolerance {:g}), largest {:.3g}\n",
        problem.contacts(), options.solver, to_string(report.status), report.sweeps, report.seconds,
        report.judgement.residual, options.tolerance, report.judgement.residual_max);
  }
  return static_cast<int>(report.status == Status::converged ? ExitCode::done : ExitCode::not_converged);
}

}  // namespace drumlin::apps
