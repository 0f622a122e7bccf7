#include "apps/flow/flow_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "apps/flow/flow_files.hpp"
#include "apps/flow/flow_marching.hpp"
#include "apps/flow/flow_region.hpp"
#include "apps/flow/flow_text.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/request_sum.hpp"
#include "apps/process/standard_streams.hpp"
#include "continuum/estimates/flow_limits.hpp"
#include "continuum/fem/scene_options.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/documents/key_reader.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/law/ill_posed.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "coupling/core/results/measured_run.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

constexpr double degrees = 180 / std::numbers::pi;

void print_iteration(const continuum::IterationReport& line) {
  const auto slope = continuum::slope_of(line);
  print_out(
      fmt::format("mesh {} {:<11} eps {:8.2e}  it {:2}  residual {:8.2e}  step {:8.2e} x {:4.2f}  theta "
                  "{:>7} deg {:7.1f} s\n",
                  line.level, line.phase, line.shear_rate, line.iteration, line.residual, line.step_size,
                  line.step_length, slope ? fmt::format("{:.3f}", *slope * degrees) : "-", line.seconds));
  flush_out();
}

void print_rejected(const continuum::IterationReport& line) {
  print_out(fmt::format("mesh {} {:<11} eps {:8.2e}  not found, back to the flow before\n", line.level,
                        line.phase, line.shear_rate));
  flush_out();
}

void print_surface_step(const continuum::SurfaceStepReport& step) {
  print_out(fmt::format(
      "mesh {} surface: up to {:.3f} d from the chord, {:.4f} d (rms, {:.4f} resolved, largest {:.2f}) press "
      "on "
      "it\n",
      step.level, step.height, step.rms, step.resolved, step.largest));
  flush_out();
}

void print_mesh(int level, const continuum::MeshResult& mesh) {
  print_out(fmt::format("mesh {} done: {} unknowns", level, mesh.unknowns));
  for (const Scalar& scalar : mesh.scalars.scalars)
    print_out(fmt::format(", {} {:.4g}", scalar.name, scalar.value));
  print_out("\n");
  flush_out();
}

void print_added_mesh(double imbalance) {
  print_out(fmt::format("flux_imbalance {:.2g}, at most {:g} may be: cells half as large\n", imbalance,
                        continuum::largest_flux_imbalance));
  flush_out();
}

// Faults of the scene that show only with its law, too, name the file of the scene.
continuum::FlowCase case_of(const fs::path& scene_file, const continuum::FlowScene& scene,
                            const RheologyFit& law, const std::vector<std::string>& overrides) {
  try {
    return continuum::flow_case(scene, law);
  } catch (const InputError& error) {
    std::vector<InputProblem> problems = error.problems();
    const Document document = read_toml(scene_file, overrides);
    for (InputProblem& problem : problems)
      if (problem.file.empty() && !problem.key.empty())
        problem = problem_at(document, problem.key, problem.what, problem.allowed);
    throw InputError(problems);
  }
}

FlowRequest read_request(const FlowOptions& options) {
  FlowRequest asked{.scene = continuum::read_flow_scene(options.scene, options.overrides),
                    .law = read_rheology(options.rheology),
                    .flow_case = {}};
  if (options.law_draws > 0 && asked.scene.effects.memory)
    throw InputError({InputProblem{.file = options.scene.string(),
                                   .key = "effects.memory",
                                   .what = "has no draws of its law's points, which --law-draws requires",
                                   .allowed = "absent, or no --law-draws"}});
  asked.flow_case = case_of(options.scene, asked.scene, asked.law, options.overrides);
  if (options.from) {
    const ResultFolder from = open_flow_run(*options.from);
    for (const char* name : {"state.h5", "flow.json"}) (void)checked_file(from, name);
    asked.accepted = accepted_edits(from);
  }
  return asked;
}

// What is known to go wrong before anything is solved.
std::string ill_posedness_text(const RheologyFit& law) {
  std::string text;
  for (const InertialRange& range : ill_posed_intervals(law))
    text += fmt::format("{} {:.2g} to {:.2g}", text.empty() ? "" : ",", range.from, range.to);
  if (text.empty()) return text;
  return fmt::format(
      "the law is ill-posed in simple shear for I from{} (searched from 1e-6 to 1): where the flow has such "
      "I, "
      "it depends on the mesh (docs/theory/rheology.md)\n",
      text);
}

// Where the solve begins: cold where both are absent.
struct FlowStart {
  std::optional<continuum::FlowState> neighbour;
  std::optional<FlowMarching> marching;
};

// A state that does not fit is refused before the folder is made.
void require_fit(const continuum::FlowState& state, const fs::path& file, const FlowRequest& asked) {
  try {
    (void)continuum::flow_of_state(state, asked.flow_case.problem, continuum::solver_options(asked.scene));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

FlowStart read_start(const FlowOptions& options, const FlowRequest& asked) {
  FlowStart start;
  if (asked.scene.time)
    start.marching = read_marching(options, asked);
  else if (options.from)
    start.neighbour = continuum::read_flow_state(*options.from);
  const bool goes_on = start.marching && start.marching->march.start.steps > 0;  // from a state of this scene
  if (options.from && !goes_on)
    require_fit(start.marching ? start.marching->march.start.state : *start.neighbour,
                *options.from / "state.h5", asked);
  return start;
}

// Of the first rank alone, which writes for all.
using FlowOutput = std::optional<GrowingOutput>;

std::vector<std::string> flow_file_names() {
  return {"flow_scene.toml",
          "rheology.toml",
          "iterations.csv",
          "profiles.csv",
          "maps.h5",
          "flow.vtu",
          "state.h5",
          "flow.json",
          "flow.json.part",
          "maps.png",
          "profiles.png",
          "newton.png",
          "well_posedness.png",
          "sensitivity.png",
          "series.png",
          "series.csv",
          checkpoint_name,
          previous_checkpoint_name,
          passed_over_checkpoint_name};
}

void begin_folder(FlowOutput& output, const FlowOptions& options, const FlowRequest& asked, int ranks) {
  std::vector<fs::path> inputs = {options.scene, options.rheology};
  if (options.from) inputs.push_back(*options.from / "state.h5");
  output.emplace(OutputRequest{options.output, options.existing, "flow", inputs, {}, asked.sum},
                 flow_file_names());
  output->forget("*");  // all is written anew
  replace_file(options.output / "flow_scene.toml", continuum::flow_scene_text(asked.scene));
  replace_file(options.output / "rheology.toml", file_text(options.rheology));
  for (const char* name : {"flow_scene.toml", "rheology.toml"}) output->list(name);
  output->save();
  print_out(fmt::format("{}{}: {}, nu = {:.3f}, {}{}\n", asked.scene.title,
                        asked.reduced() ? " (reduced)" : "", asked.flow_case.summary, asked.law.nu,
                        described(asked.law.mu), ranks > 1 ? fmt::format(", {} ranks", ranks) : ""));
  print_out(ill_posedness_text(asked.law));
}

// The flow, and what was read off it on its way.
struct SolvedFlow {
  continuum::FlowSolution solution;
  std::vector<continuum::MeshResult> meshes;
  continuum::FlowOnFinerMeshes finer;
  std::optional<continuum::PlainFlow> plain;
  double cpu_seconds = 0;
  std::vector<double> rank_cpu_seconds, rank_peak_memory_mb;
};

continuum::FlowSolution solution_of(FlowOutput& output, const FlowRequest& asked, const FlowStart& start,
                                    const continuum::FemRuntime& runtime,
                                    const continuum::FlowObserver& observer) {
  if (start.marching) return march_scene(*start.marching, output ? &*output : nullptr, runtime);
  const continuum::FlowProblem& problem = asked.flow_case.problem;
  if (start.neighbour)
    return continuum::solve_flow_from(*start.neighbour, problem, continuum::solver_options(asked.scene),
                                      observer);
  return continuum::solve_flow(problem, continuum::solver_options(asked.scene), observer);
}

SolvedFlow solved_flow(FlowOutput& output, const FlowRequest& asked, const FlowStart& start,
                       const continuum::FemRuntime& runtime) {
  const bool speaks = runtime.rank() == 0;
  const continuum::FlowCase& chosen = asked.flow_case;
  std::vector<continuum::MeshResult> meshes;
  std::optional<continuum::PlainFlow> plain;
  continuum::FlowObserver observer;
  if (speaks) observer.iteration = print_iteration;
  if (speaks) observer.rejected = print_rejected;
  if (speaks) observer.surface_step = print_surface_step;
  observer.interrupted = [] { return interruption() != 0; };
  observer.level_finished = [&](int level, const continuum::FlowField& field) {
    // A neighbour that did not serve may have finished a mesh before: the cold start does them anew.
    while (!meshes.empty() && meshes.back().level >= level) meshes.pop_back();
    meshes.push_back({level, field.cells(), field.unknowns(), chosen.scalars(field)});
    if (speaks) print_mesh(level, meshes.back());
  };
  observer.solved_plain = [&](const continuum::FlowField& field) {
    plain = continuum::PlainFlow{chosen.scalars(field), chosen.profiles(field)};
  };
  const std::clock_t begun = std::clock();
  continuum::FlowSolution solution = solution_of(output, asked, start, runtime, observer);
  continuum::FlowOnFinerMeshes finer;
  if (solution.report.converged)
    finer = continuum::add_meshes(asked.scene, chosen, solution, observer, [&](double imbalance) {
      if (speaks) print_added_mesh(imbalance);
    });
  const double cpu_seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  if (start.marching && solution.report.converged)
    observer.level_finished(asked.scene.mesh.levels - 1, solution.field);
  if (plain && solution.report.converged)
    plain->v_x_change = continuum::v_x_change(plain->profiles, chosen.profiles(solution.field));
  return {std::move(solution),
          std::move(meshes),
          std::move(finer),
          std::move(plain),
          cpu_seconds,
          continuum::FemRuntime::of_ranks(own_cpu_seconds()),
          continuum::FemRuntime::of_ranks(own_peak_memory_mb())};
}

// What comes after it is ended by a signal at once: nothing is kept before all of it is there.
SolvedFlow solved_until_interrupted(FlowOutput& output, const FlowRequest& asked, const FlowStart& start,
                                    const continuum::FemRuntime& runtime) {
  const CaughtInterruptions caught;
  return solved_flow(output, asked, start, runtime);
}

void require_converged(const continuum::FlowSolution& solution) {
  if (solution.report.converged) return;
  const continuum::FlowIntegrals sums = solution.field.integrals();
  throw NotConvergedError(
      fmt::format("the flow did not converge: {}; the last iterate is ill-posed in {:.1f} % of the area",
                  solution.report.failure, 100 * (sums.ill_posed_area / sums.area)));
}

FinishedFlow finished_flow(const FlowOptions& options, const FlowRequest& asked, SolvedFlow&& solved,
                           int ranks) {
  const continuum::FlowScene& scene = asked.scene;
  FinishedFlow flow{.asked = asked,
                    .solution = std::move(solved.solution),
                    .meshes = std::move(solved.meshes),
                    .plain = std::move(solved.plain),
                    .cpu_seconds = solved.cpu_seconds,
                    .ranks = ranks,
                    .rank_cpu_seconds = std::move(solved.rank_cpu_seconds),
                    .rank_peak_memory_mb = std::move(solved.rank_peak_memory_mb),
                    .findings = {},
                    .missed = {},
                    .sensitivities = {},
                    .law_band = {},
                    .accuracy = {}};
  if (scene.solver.sensitivity && !scene.time)
    flow.sensitivities = continuum::sensitivities_of(asked.flow_case, flow.solution, flow.meshes,
                                                     continuum::solver_options(scene));
  if (options.law_draws > 0 && !asked.law.draws.empty() && !scene.time)
    flow.law_band = continuum::law_band_of(asked.flow_case, flow.solution, asked.law, options.law_draws,
                                           scene.output.map_spacing, continuum::solver_options(scene));
  flow.findings = continuum::findings_of(asked.flow_case, flow.solution.field, solved.finer.checks);
  flow.missed = continuum::missed_limits(scene, asked.flow_case, flow.meshes, flow.findings, solved.finer);
  flow.accuracy = continuum::accuracy_of(
      scene, {flow.solution.report, flow.meshes, flow.sensitivities, flow.law_band, flow.cpu_seconds});
  return flow;
}

// Results that are there, but of no flow of these equations.
void require_met(const fs::path& folder, const std::vector<std::string>& missed) {
  if (missed.empty()) return;
  throw NotConvergedError(fmt::format("{}: the results are kept, but are no flow of these equations:\n  {}",
                                      folder.string(), fmt::join(missed, "\n  ")));
}

}  // namespace

int solve_flow_scene(const FlowOptions& options, const continuum::FemRuntime& runtime) {
  const bool speaks = runtime.rank() == 0;
  const auto say = [](const std::string& what) { print_error(what + "\n"); };
  bool is_region = false;
  runtime.on_all_ranks(
      [&] {
        is_region = std::holds_alternative<continuum::FlowRegion>(
            continuum::read_flow_scene(options.scene, options.overrides).geometry);
      },
      say);
  if (is_region) return solve_region_scene(options, runtime);
  FlowRequest asked;
  // One of several machines may not see a file, or see another one.
  runtime.on_all_ranks([&] { asked = read_request(options); }, say);
  asked.sum = requested_sum(described(options), {continuum::flow_scene_text(asked.scene)});
  runtime.require_same(asked.sum + options.output.string() + version_text(),
                       "scene, law, options or revision are");
  if (options.existing == ExistingOutput::resume && holds_results(options.output, "flow.json")) {
    refuse_other(options.output, asked.sum);
    if (speaks) print_out(fmt::format("{}: done already\n", options.output.string()));
    require_met(options.output, limits_missed_by(options.output));
    return static_cast<int>(ExitCode::done);
  }
  FlowStart start;
  runtime.on_all_ranks([&] { start = read_start(options, asked); }, say);
  FlowOutput output;
  runtime.on_first_rank([&] { begin_folder(output, options, asked, runtime.ranks()); });
  SolvedFlow solved = solved_until_interrupted(output, asked, start, runtime);
  runtime.on_first_rank([&] { write_iterations(options.output / "iterations.csv", solved.solution.report); });
  if (const int signal = interruption(); signal != 0) return exit_code_of(signal);
  require_converged(solved.solution);
  const FinishedFlow flow = finished_flow(options, asked, std::move(solved), runtime.ranks());
  write_flow(options.output, flow);
  runtime.on_first_rank([&] {
    for (const char* name : {checkpoint_name, previous_checkpoint_name, passed_over_checkpoint_name})
      fs::remove(options.output / name);
    output->finish();
  });
  if (speaks) print_out(finished_text(options.output, flow));
  require_met(options.output, flow.missed);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
