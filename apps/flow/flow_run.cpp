#include "apps/flow/flow_run.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <optional>

#include "apps/flow/flow_files.hpp"
#include "apps/flow/flow_marching.hpp"
#include "apps/flow/flow_sensitivity.hpp"
#include "apps/flow/flow_state_file.hpp"
#include "apps/flow/flow_text.hpp"
#include "apps/flow/law_band.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/output_folder.hpp"
#include "continuum/rheology/ill_posed_ranges.hpp"
#include "continuum/rheology/nonlocal_law.hpp"
#include "continuum/sampling/flow_case.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

constexpr double degrees = 180 / std::numbers::pi;

void print_iteration(const IterationReport& line) {
  fmt::print(
      "mesh {} {:<11} eps {:8.2e}  it {:2}  residual {:8.2e}  step {:8.2e} x {:4.2f}  theta "
      "{:7.3f} deg {:7.1f} s\n",
      line.level, line.phase, line.shear_rate, line.iteration, line.residual, line.step_size,
      line.step_length, line.theta * degrees, line.seconds);
  std::fflush(stdout);
}

void print_surface_step(const SurfaceStepReport& step) {
  fmt::print(
      "mesh {} surface: up to {:.3f} d from the chord, {:.4f} d (rms, {:.4f} resolved, largest {:.2f}) press "
      "on "
      "it\n",
      step.level, step.height, step.rms, step.resolved, step.largest);
  std::fflush(stdout);
}

void print_mesh(int level, const MeshResult& mesh) {
  fmt::print("mesh {} done: {} unknowns", level, mesh.unknowns);
  for (const Scalar& scalar : mesh.scalars.scalars) fmt::print(", {} {:.4g}", scalar.name, scalar.value);
  fmt::print("\n");
  std::fflush(stdout);
}

double ill_posed_share(const FlowField& field) {
  const FlowIntegrals sums = field.integrals();
  return sums.ill_posed_area / sums.area;
}

FlowSolverOptions solver_options(const FlowScene& scene) {
  FlowSolverOptions options;
  options.levels = scene.mesh.levels;
  options.refined_share = scene.mesh.refined_share;
  options.tolerance = scene.solver.tolerance;
  // Three meshes show an order: then they differ by their cells alone.
  if (options.levels > 2) options.coarse_tolerance = options.tolerance;
  options.linear_tolerance = scene.solver.linear_tolerance;
  options.max_iterations = scene.solver.max_iterations;
  return options;
}

// What a scene asks of a law that the file of the law does not give.
void check_law(const FlowOptions& options, const FlowScene& scene, const RheologyFit& fit,
               const StressLaw& law) {
  std::vector<InputProblem> problems;
  if (scene.effects.fabric && !fit.k)
    problems.push_back(
        {.file = options.scene.string(),
         .key = "effects.fabric",
         .what = fmt::format("carries k along with the material, and {} has no k", options.rheology.string()),
         .allowed = "a rheology file with a table [k]"});
  if (scene.effects.nonlocal && !tells_fluidity(law))
    problems.push_back(
        {.file = options.scene.string(),
         .key = "effects.nonlocal",
         .what =
             fmt::format("spreads the fluidity that mu tells, and in {} mu is the same at all rates or has "
                         "a threshold, below which it tells none",
                         options.rheology.string()),
         .allowed = "a rheology file whose mu is a logarithm or a table"});
  if (!problems.empty()) throw InputError(problems);
}

void add_k(const NormalStressRatio& points, const FlowEffects& effects, FlowCase& chosen) {
  chosen.problem.turned = TurnedStress{.k = StressRatioLaw(points.I, points.k)};
  if (effects.fabric) chosen.problem.turned->fabric = CarriedFabric{effects.fabric->relaxation};
  // In a ring k changes the pressure along the radius, and with it what the closed form takes for granted.
  if (std::holds_alternative<AnnulusDomain>(chosen.problem.domain)) chosen.closed_form = nullptr;
}

// What is known to go wrong before anything is solved.
std::string ill_posedness_text(const FlowProblem& problem) {
  std::string text;
  for (const InertialRange& range :
       ill_posed_ranges(problem.law, problem.turned ? &problem.turned->k : nullptr))
    text += fmt::format("{} {:.2g} to {:.2g}", text.empty() ? "" : ",", range.from, range.to);
  if (text.empty()) return text;
  return fmt::format(
      "the law is ill-posed in simple shear for I from{} (searched from 1e-6 to 1): where the flow has such "
      "I, "
      "it depends on the mesh (docs/theory/rheology.md)\n",
      text);
}

FlowScene at_share_of_speed(FlowScene scene, double share) {
  if (auto* drum = std::get_if<FlowDrum>(&scene.geometry)) drum->rotation_rpm *= share;
  return scene;
}

MarchPlan march_plan(const FlowOptions& options, const FlowScene& scene,
                     const std::function<FlowCase(double)>& case_at) {
  MarchPlan plan{.folder = options.output,
                 .time = *scene.time,
                 .time_unit_s = scales_of(scene).time_s,
                 .rotation_rpm = std::get<FlowDrum>(scene.geometry).rotation_rpm,
                 .start = march_start(options, scene, flow_scene_text(scene), file_text(options.rheology)),
                 .said = options.from ? options.from->string() : "rest",
                 .case_at = case_at,
                 .options = solver_options(scene)};
  return plan;
}

// A state that does not fit is refused before the folder is made.
void require_fit(const FlowState& state, const fs::path& file, const FlowProblem& problem,
                 const FlowSolverOptions& solver) {
  try {
    (void)flow_of_state(state, problem, solver);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace

int solve_flow_scene(const FlowOptions& options, const FemRuntime& runtime) {
  const bool speaks = runtime.rank() == 0;
  const fs::path finished = options.output / "flow.json";
  if (options.existing == ExistingOutput::resume && fs::exists(finished)) {
    if (speaks) fmt::print("{}: done already\n", options.output.string());
    return static_cast<int>(ExitCode::done);
  }
  const FlowScene scene = read_flow_scene(options.scene, options.overrides);
  const RheologyFit fit = read_rheology(options.rheology);
  const StressLaw law = stress_law(fit);
  check_law(options, scene, fit, law);
  const auto case_at = [&](double share) {
    FlowCase chosen = flow_case(at_share_of_speed(scene, share), fit.nu, law);
    if (fit.k) add_k(*fit.k, scene.effects, chosen);
    return chosen;
  };
  const FlowCase chosen = case_at(1);
  const bool reduced = scene.reduced || fit.reduced;
  std::optional<FlowState> neighbour;
  std::optional<MarchPlan> plan;
  if (scene.time)
    plan = march_plan(options, scene, case_at);
  else if (options.from)
    neighbour = read_flow_state(*options.from);
  const bool goes_on = plan && plan->start.steps > 0;  // from a state of this very scene
  if (options.from && !goes_on)
    require_fit(plan ? plan->start.state : *neighbour, *options.from / "state.h5", chosen.problem,
                solver_options(scene));
  runtime.on_first_rank([&] {
    std::vector<fs::path> inputs = {options.scene, options.rheology};
    if (options.from) inputs.push_back(*options.from / "state.h5");
    prepare_output(options.output, options.existing, {"flow_scene.toml", "flow.json"}, inputs);
    replace_file(options.output / "flow_scene.toml", flow_scene_text(scene));
    replace_file(options.output / "rheology.toml", file_text(options.rheology));
    fmt::print("{}{}: {}, nu = {:.3f}, {}{}\n", scene.title, reduced ? " (reduced)" : "", chosen.summary,
               fit.nu, described(fit.mu),
               runtime.ranks() > 1 ? fmt::format(", {} ranks", runtime.ranks()) : "");
    fmt::print("{}", ill_posedness_text(chosen.problem));
  });
  catch_interruptions();
  std::vector<MeshResult> meshes;
  FlowObserver observer;
  if (speaks) observer.iteration = print_iteration;
  if (speaks) observer.surface_step = print_surface_step;
  observer.interrupted = [] { return interruption() != 0; };
  observer.level_finished = [&](int level, const FlowField& field) {
    // A neighbour that did not serve may have finished a mesh before: the cold start does them anew.
    while (!meshes.empty() && meshes.back().level >= level) meshes.pop_back();
    meshes.push_back({level, field.cells(), field.unknowns(), chosen.scalars(field)});
    if (speaks) print_mesh(level, meshes.back());
  };
  std::optional<PlainFlow> plain;
  observer.solved_plain = [&](const FlowField& field) {
    plain = PlainFlow{chosen.scalars(field), chosen.profiles(field)};
  };
  const std::clock_t begun = std::clock();
  const FlowSolution solution =
      plan        ? march_scene(*plan, runtime, observer)
      : neighbour ? solve_flow_from(*neighbour, chosen.problem, solver_options(scene), observer)
                  : solve_flow(chosen.problem, solver_options(scene), observer);
  const double cpu_seconds = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  runtime.on_first_rank([&] { write_iterations(options.output / "iterations.csv", solution.report); });
  if (const int signal = interruption(); signal != 0)
    return static_cast<int>(signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted);
  if (!solution.report.converged)
    throw NotConvergedError(
        fmt::format("the flow did not converge: {}; the last iterate is ill-posed in {:.1f} % of the area",
                    solution.report.failure, 100 * ill_posed_share(solution.field)));
  if (plan) observer.level_finished(scene.mesh.levels - 1, solution.field);
  if (plain) plain->v_x_change = v_x_change(plain->profiles, chosen.profiles(solution.field));
  std::vector<Sensitivity> sensitivities;
  if (scene.solver.sensitivity && !plan)
    sensitivities = sensitivities_of(chosen, solution, meshes, solver_options(scene));
  LawBand law_band;
  if (options.law_draws > 0 && !fit.draws.empty() && !plan)
    law_band = law_band_of(chosen, solution, fit, options.law_draws, scene.output.map_spacing,
                           solver_options(scene));
  const FlowFindings findings = findings_of(chosen, solution.field);
  const FinishedFlow flow{scene,           fit,           chosen,   solution, meshes, reduced,
                          runtime.ranks(), sensitivities, law_band, findings, plain,  cpu_seconds};
  write_flow(options.output, flow);
  if (plan) runtime.on_first_rank([&] { fs::remove(options.output / "checkpoint.h5"); });
  if (speaks) fmt::print("{}", finished_text(options.output, flow));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
