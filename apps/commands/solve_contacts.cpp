// drumlin solve-contacts: one contact problem from a file, measured by the project's residual.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/support/commands.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "particles/contact/disc_problem.hpp"
#include "particles/io/contact_problem_file.hpp"
#include "particles/parallel/thread_team.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::apps {
namespace {

using particles::BlockProblem;

/// Impulses and velocities of a problem from a file, and the report of the solver.
struct Solved {
  particles::SolveReport report;
  particles::Solution<BlockProblem> solution;
  bool of_discs = false;
};

template <class Problem>
particles::SolveReport solve(const Problem& problem, const SolveContactsOptions& options,
                             std::vector<double>& impulses) {
  particles::StoppingRule rule;
  rule.tolerance = options.tolerance;
  rule.max_seconds = options.max_seconds;
  rule.max_sweeps = std::numeric_limits<int>::max();
  particles::ThreadTeam team(options.threads);
  particles::SolverWorkspace<Problem> work;
  work.team = &team;
  particles::Solution<Problem> solution;
  const auto report = particles::contact_solver<Problem>(options.solver)(problem, rule, work, solution);
  impulses = std::move(solution.impulses);
  return report;
}

/// Through the discs where W is that of discs, as in a run. The residual is that of the W of the file.
Solved solve(const BlockProblem& problem, const SolveContactsOptions& options) {
  Solved solved;
  const auto discs = particles::disc_problem(problem);
  solved.of_discs = discs.has_value();
  solved.report = discs ? solve(*discs, options, solved.solution.impulses)
                        : solve(problem, options, solved.solution.impulses);
  solved.report.residual = particles::residual_of(problem, solved.solution);
  return solved;
}

void print_json(const particles::ContactProblemFile& file, const Solved& solved,
                const SolveContactsOptions& options) {
  const auto& report = solved.report;
  const nlohmann::ordered_json printed = {{"status", particles::to_string(report.status)},
                                          {"residual", report.residual.rms},
                                          {"residual_max", report.residual.max},
                                          {"sweeps", report.sweeps},
                                          {"seconds", report.seconds},
                                          {"contacts", file.problem.contacts()},
                                          {"discs", solved.of_discs},
                                          {"asymmetry", file.asymmetry},
                                          {"solver", options.solver},
                                          {"tolerance", options.tolerance}};
  print_out(fmt::format("{}\n", printed.dump(2)));
}

void print_text(const particles::ContactProblemFile& file, const Solved& solved,
                const SolveContactsOptions& options) {
  const auto& report = solved.report;
  if (file.asymmetry > 1e-12)
    print_out(fmt::format("the diagonal blocks of W were made symmetric (up to {:.1e} of their trace off)\n",
                          file.asymmetry));
  print_out(fmt::format(
      "{} contacts{}, {}: {} after {} sweeps, {:.3g} s; residual {:.3g} (tolerance {:g}), largest {:.3g}\n",
      file.problem.contacts(), solved.of_discs ? " of discs" : "", options.solver,
      particles::to_string(report.status), report.sweeps, report.seconds, report.residual.rms,
      options.tolerance, report.residual.max));
}

}  // namespace

int solve_contacts(const SolveContactsOptions& options) {
  const particles::ContactProblemFile file = particles::read_contact_problem_file(options.problem);
  std::optional<FolderLock> lock;
  if (options.output) lock.emplace(prepare_output_file(*options.output, ExistingOutput::refuse));
  const Solved solved = solve(file.problem, options);
  if (options.output)
    particles::write_contact_solution(*options.output, solved.solution.impulses,
                                      solved.solution.velocities.contacts);
  if (options.json)
    print_json(file, solved, options);
  else
    print_text(file, solved, options);
  const bool converged = solved.report.status == particles::Status::converged;
  return static_cast<int>(converged ? ExitCode::done : ExitCode::not_converged);
}

}  // namespace drumlin::apps
