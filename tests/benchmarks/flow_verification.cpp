// The numbers of docs/verification.md: the finite elements against what can be written down, over the mesh.
//
// usage: benchmark_flow_verification RESULT.json
//
// The problems are those of tests/continuum, on one mesh more. docs/figures/verification_figures.py draws
// them.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/json/json_file.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "continuum/postprocessing/gap_profiles.hpp"
#include "continuum/reference/closed_forms.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/continuum/gap_flows.hpp"
#include "tests/continuum/manufactured_flow.hpp"
#include "tests/continuum/tangent_error.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace {

using namespace drumlin;
using namespace drumlin::continuum;
using Json = nlohmann::ordered_json;

constexpr double degree = std::numbers::pi / 180;

/// Solves on all meshes; `look` sees each. Throws NotConvergedError.
void solve_and_look(const FlowProblem& problem, const FlowSolverOptions& options,
                    const std::function<void(const FlowField&)>& look) {
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) { look(field); };
  const FlowSolution solution = solve_flow(problem, options, observer);
  if (!solution.report.converged) throw NotConvergedError(solution.report.failure);
}

Json manufactured(const testing_manufactured::Manufactured& made, int levels = 4) {
  FlowSolverOptions options;
  options.levels = levels;
  options.tolerance = 1e-11;
  options.coarse_tolerance = options.tolerance;  // the errors of all meshes are compared
  options.picard_tolerance = 1e-7;               // below the errors of the finest mesh
  Json meshes = Json::array();
  double cell = 0.25;
  solve_and_look(problem_of(made), options, [&](const FlowField& field) {
    const auto e = testing_manufactured::errors(field);
    meshes.push_back(
        {{"cell", cell}, {"velocity", e.velocity}, {"gradient", e.gradient}, {"pressure", e.pressure}});
    cell /= 2;
  });
  return meshes;
}

Json gap_meshes(const testing_gaps::GapFlow& flow) {
  constexpr int levels = 4;
  // One mesh finer than the tests: the coarsest stays theirs.
  const FlowMesh mesh{.surface_cell = flow.cell / 2, .surface_zone = 100, .levels = levels};
  const FlowProblem problem = gap_problem(flow.gap, testing_gaps::steep, mesh, flow.regularisation);
  FlowSolverOptions options;
  options.levels = levels;
  options.coarse_tolerance = options.tolerance;  // the errors of all meshes are compared
  Json meshes = Json::array();
  double cell = flow.cell * 4;
  solve_and_look(problem, options, [&](const FlowField& field) {
    const auto c = gap_comparison(field, flow.gap, testing_gaps::steep, problem.regularisation);
    meshes.push_back({{"cell", cell}, {"velocity", c.mesh_error}, {"closed_form", c.closed_form_error}});
    cell /= 2;
  });
  return meshes;
}

/// Bagnold's flow, whose surface speed goes as exp((tan(theta) - a)/b).
Json changed_laws() {
  Json rows = Json::array();
  for (const LogLaw law : {LogLaw{0.35, 0.05}, LogLaw{0.33, 0.05}, LogLaw{0.37, 0.05}, LogLaw{0.35, 0.04},
                           LogLaw{0.35, 0.065}}) {
    const Gap gap = testing_gaps::incline_flow().gap;
    const FlowProblem problem =
        gap_problem(gap, law, {.surface_cell = 0.25, .surface_zone = 100, .levels = 2},
                    {.shear_rate = 1e-6, .pressure = 1e-3});
    FlowSolverOptions options;
    options.levels = 2;
    double speed = 0;
    solve_and_look(problem, options,
                   [&](const FlowField& field) { speed = gap_scalars(field, gap).value("surface_speed"); });
    rows.push_back({{"a", law.a},
                    {"b", law.b},
                    {"surface_speed", speed},
                    {"closed_form", bagnold_speed(law, gap.nu, gap.slope, gap.depth, gap.depth)}});
  }
  return rows;
}

Json plane_shear() {
  Json rows = Json::array();
  const LogLaw paper{0.35, 0.013};
  for (const double I : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const Gap gap{
        .depth = 10, .nu = testing_gaps::nu, .pressure = 4, .speed = 2 * I * 10, .scalars = {"mu_wall"}};
    FlowSolverOptions options;
    options.levels = 1;
    options.tolerance = 1e-11;
    solve_and_look(gap_problem(gap, paper, {.surface_cell = 2.5, .surface_zone = 100, .levels = 1},
                               {.shear_rate = 1e-9, .pressure = 1e-6}),
                   options, [&](const FlowField& field) {
                     rows.push_back({{"I", I},
                                     {"mu", gap_scalars(field, gap).value("mu_wall")},
                                     {"closed_form", paper.a + paper.b * std::log(I)}});
                   });
  }
  return rows;
}

Json tangent() {
  Json rows = Json::array();
  for (int power = 1; power <= 9; ++power) {
    const double h = std::pow(10.0, -power);
    rows.push_back(
        {{"h", h}, {"error", testing_tangent::tangent_error(testing_tangent::small_segment(), false, h)}});
  }
  return rows;
}

Json drum_invariants() {
  const DrumGeometry drum = small_drum();
  FlowSolverOptions options;
  options.levels = 4;
  Json rows = Json::array();
  double cell = 2;
  solve_and_look(small_drum_problem(LogLaw{0.35, 0.013}), options, [&](const FlowField& field) {
    Json row{{"cell", cell}, {"unknowns", field.unknowns()}, {"theta_deg", field.theta() / degree}};
    apps::add_scalars(row, drum_checks(field, drum));
    rows.push_back(std::move(row));
    cell /= 2;
  });
  return rows;
}

/// The half-filled drum with profiles that decay over 3.4 d, at 2, 6 and 15 rpm.
Json drum_centre() {
  const LogLaw paper{0.35, 0.013};
  const double kappa = 2 * paper.b / 3.4;
  Json rows = Json::array();
  for (const double rpm : {2.0, 6.0, 15.0}) {
    const double Q = 21.97 * rpm / 6, theta = drum_centre_slope(paper, testing_gaps::nu, kappa, Q);
    rows.push_back({{"rpm", rpm}, {"Q", Q}, {"kappa", kappa}, {"theta_deg", theta / degree}});
  }
  return rows;
}

int measure(const std::string& file) {
  Json result{{"format", "drumlin-flow-verification-1"},
              {"command", "benchmark_flow_verification RESULT"},
              {"provenance", provenance()}};
  result["manufactured_newtonian"] =
      manufactured({NewtonianLaw{1}, testing_manufactured::of_friction_law().regularisation});
  result["manufactured_friction"] = manufactured(testing_manufactured::of_friction_law());
  result["manufactured_given_turn"] = manufactured(testing_manufactured::of_given_turn());
  result["manufactured_found_turn"] = manufactured(testing_manufactured::of_found_turn(), 3);
  result["incline"] = gap_meshes(testing_gaps::incline_flow());
  result["chute"] = gap_meshes(testing_gaps::chute_flow());
  result["annulus"] = gap_meshes(testing_gaps::annulus_flow());
  result["changed_laws"] = changed_laws();
  result["plane_shear"] = plane_shear();
  result["tangent"] = tangent();
  result["drum"] = drum_invariants();
  result["drum_centre"] = drum_centre();
  apps::write_json(file, result);
  return static_cast<int>(ExitCode::done);
}

}  // namespace

int main(int argc, char** argv) {
  const FemRuntime runtime(argc, argv);
  if (argc != 2 || FemRuntime::ranks() != 1) {
    fmt::print(stderr, "usage: benchmark_flow_verification RESULT.json, on one rank\n");
    return static_cast<int>(ExitCode::wrong_input);
  }
  try {
    return measure(argv[1]);
  } catch (const NotConvergedError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitCode::not_converged);
  } catch (const IoError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitCode::input_output);
  }
}
