// drumlin solve-contacts: one contact problem from a file, measured by the project's residual.
#include "particles/lab/solve_contacts.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "particles/lab/any_solver.hpp"
#include "particles/lab/backward_error.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "particles/lab/disc_problem.hpp"
#include "particles/lab/state_changes.hpp"

namespace drumlin::apps {
namespace {

using particles::BlockProblem;

struct SolveContactsOptions {
  std::filesystem::path problem;
  std::string solver = "accelerated";
  double tolerance = 1e-4;
  double max_seconds = 60;
  int threads = 1;
  std::optional<std::filesystem::path> output;
  ExistingOutput existing = ExistingOutput::refuse;
  bool backward_error = false;
  std::optional<int> watch;
  bool json = false;

  void describe(Description& d) {
    d.add("problem", problem, "PROBLEM.h5", "Problem in FCLIB's fclib_local layout, spacedim 2").required();
    d.add("--solver", solver, "", one_of(particles::any_solver_names()), "Contact solver");
    d.add("--tolerance", tolerance, "", above(0, 10),
          "It may stop below this residual (docs/conventions.md)");
    d.add("--max-seconds", max_seconds, "s", above(0), "It stops after this wall time in any case");
    d.add("--threads", threads, "", at_least(1, most_threads),
          "Threads, of solvers that know them and W of discs; the impulses do not depend on it");
    d.output(output, "SOL.h5",
             "File for the solution, r, u, state and error under /solution; none is written without");
    d.overwrite(existing, "Replaces a file of that name");
    d.add("--backward-error", backward_error,
          "Says how far the problem that the solution solves exactly is from this one");
    d.add("--watch", watch, "", at_least(1, 1000000),
          "Sweeps on so many times from the solution and counts which contacts change their state");
    d.add("--json", json, "Prints status, residual, residual_max, sweeps, seconds as JSON");
  }
};

/// A solved problem, and what else was asked about it.
struct Solved : particles::SolvedContacts {
  std::vector<particles::BackwardError> backward_errors;  ///< of --backward-error
  std::optional<particles::StateChanges> changes;         ///< of --watch
};

/// Lets the C library use again what a phase of this short program has freed. Else each gives its pages back
/// and the next one asks the system for new ones, which takes longer than what is done with them.
void keep_freed_memory() {
#ifdef M_MMAP_THRESHOLD
  (void)::mallopt(M_MMAP_THRESHOLD, 1 << 30);
  (void)::mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

/// By how much the friction of contacts may be off the given one in a backward error.
constexpr std::array friction_changes{0.0, 1e-3, 1e-2, 5e-2};

Solved solve(const BlockProblem& problem, const SolveContactsOptions& options) {
  particles::StoppingRule rule;
  rule.tolerance = options.tolerance;
  rule.max_seconds = options.max_seconds;
  rule.max_sweeps = std::numeric_limits<int>::max();
  Solved solved{particles::solve_contacts(problem, rule, options.solver, options.threads), {}, {}};
  const std::span<const double> r = solved.solution.impulses;
  if (options.backward_error)
    solved.backward_errors = particles::backward_errors(problem, r, friction_changes);
  if (!options.watch) return solved;
  const auto discs = particles::disc_problem(problem);
  solved.changes = discs ? particles::state_changes(*discs, r, *options.watch)
                         : particles::state_changes(problem, r, *options.watch);
  return solved;
}

double rms_of_q(const BlockProblem& problem) {
  return std::sqrt(particles::squared_norm(problem.q) / static_cast<double>(problem.q.size()));
}

/// What the solution file says of each contact.
particles::ContactNotes notes_of(const BlockProblem& problem, const Solved& solved) {
  particles::ContactNotes notes;
  const std::span<const double> r = solved.solution.impulses, u = solved.solution.velocities.contacts;
  for (const auto state : particles::contact_states_of(problem, r))
    notes.state.push_back(static_cast<std::int32_t>(state));
  const double scale = rms_of_q(problem);
  for (int a = 0; a < problem.contacts(); ++a) {
    const double error = std::sqrt(particles::squared_error(problem, a, r, u));
    notes.error.push_back(error == 0 ? 0 : error / scale);
  }
  if (solved.changes) notes.changes = solved.changes->changes;
  return notes;
}

nlohmann::ordered_json error_json(const particles::BackwardError& error,
                                  const particles::ContactProblemFile& file) {
  nlohmann::ordered_json json = {{"friction", error.friction}, {"dq", error.dq},
                                 {"dq_max", error.dq_max},     {"dq_gh", nullptr},
                                 {"force", error.force},       {"dr", error.dr},
                                 {"normal", error.normal},     {"most_of_it", error.most_of_it}};
  if (file.time_step) json["dq_gh"] = error.dq * rms_of_q(file.problem) / *file.time_step;
  const std::array<const char*, particles::contact_states> names{"open", "sticking", "sliding"};
  for (std::size_t k = 0; k < names.size(); ++k)
    json[names[k]] = {{"contacts", error.states[k].contacts}, {"share", error.states[k].share}};
  return json;
}

void print_backward_errors(const Solved& solved) {
  for (const auto& error : solved.backward_errors)
    print_out(fmt::format(
        "exact for friction within {:g} % of the given and free velocities that differ by "
        "{:.3g} of their rms, or impulses by {:.2g} of the mean ({:.0f} % of it at sticking, {:.0f} % at "
        "sliding, {:.0f} % at open contacts)\n",
        100 * error.friction, error.dq, error.force, 100 * error.states[1].share, 100 * error.states[2].share,
        100 * error.states[0].share));
}

void print_changes(const particles::StateChanges& changes, int sweeps) {
  print_out(fmt::format("in {} more sweeps {} contacts change their state, {} times; {} of them make 80 %\n",
                        sweeps, changes.changed, changes.total, changes.most_of_it));
}

void print_json(const particles::ContactProblemFile& file, const Solved& solved,
                const SolveContactsOptions& options) {
  const auto& report = solved.report;
  nlohmann::ordered_json printed = {{"status", name_of(report.status)},
                                    {"residual", report.residual.rms},
                                    {"residual_max", report.residual.max},
                                    {"sweeps", report.sweeps},
                                    {"seconds", report.seconds},
                                    {"contacts", file.problem.contacts()},
                                    {"discs", solved.of_discs},
                                    {"asymmetry", file.asymmetry},
                                    {"solver", options.solver},
                                    {"tolerance", options.tolerance}};
  for (const auto& error : solved.backward_errors)
    printed["backward_error"].push_back(error_json(error, file));
  if (const auto& changes = solved.changes)
    printed["changes"] = {{"sweeps", *options.watch},
                          {"contacts", changes->changed},
                          {"total", changes->total},
                          {"most_of_it", changes->most_of_it}};
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
      file.problem.contacts(), solved.of_discs ? " of discs" : "", options.solver, name_of(report.status),
      report.sweeps, report.seconds, report.residual.rms, options.tolerance, report.residual.max));
  print_backward_errors(solved);
  if (solved.changes) print_changes(*solved.changes, *options.watch);
}

int solve_contacts(const SolveContactsOptions& options) {
  keep_freed_memory();
  const particles::ContactProblemFile file = particles::read_contact_problem_file(options.problem);
  std::optional<FolderLock> lock;
  if (options.output) lock.emplace(prepare_output_file(*options.output, options.existing));
  const Solved solved = solve(file.problem, options);
  if (options.output)
    particles::write_contact_solution(*options.output, solved.solution.impulses,
                                      solved.solution.velocities.contacts, notes_of(file.problem, solved));
  if (options.json)
    print_json(file, solved, options);
  else
    print_text(file, solved, options);
  const bool converged = solved.report.status == particles::Status::converged;
  return static_cast<int>(converged ? ExitCode::done : ExitCode::not_converged);
}

}  // namespace

Command solve_contacts_command() {
  return command("solve-contacts", "Solves one contact problem from a file", solve_contacts);
}

}  // namespace drumlin::apps
