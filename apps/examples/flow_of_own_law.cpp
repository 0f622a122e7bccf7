// A layer flows down a rough incline with a law of one's own: any mu(I) that grows. Finite elements, beside
// the exact solution.
#include <cmath>
#include <cstdio>

#include "continuum/fem/flow_solver.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/fem/scene_options.hpp"
#include "continuum/postprocessing/flow_case.hpp"
#include "coupling/core/law/friction_law.hpp"

using namespace drumlin;

const char* const incline = R"(
format = "drumlin-flow-scene-1"
title = "A layer of ten grains"
incline = { height_mm = 33, slope_deg = 24 }
grains = { diameter_min_mm = 3.0, diameter_max_mm = 3.6, density_kg_m3 = 2700 }
mesh.levels = 1
regularisation.pressure = 0.01
)";

int main(int argc, char** argv) {
  const continuum::FemRuntime runtime(argc, argv);  // MPI and PETSc, while it lives
  RheologyFit law;
  law.mu = sampled_friction([](double I) { return 0.36 + 0.5 * std::pow(I, 0.7); }, 1e-4, 1);
  law.nu = 0.8;

  const continuum::FlowScene scene = continuum::parse_flow_scene(incline, "incline");
  const continuum::FlowCase flow = continuum::flow_case(scene, law);
  const auto solution = continuum::solve_flow(flow.problem, continuum::solver_options(scene));
  if (!solution.report.converged) {
    std::fprintf(stderr, "%s\n", solution.report.failure.c_str());
    return 3;
  }
  const ProfileSet profiles = flow.profiles(solution.field);
  std::printf("z [d], v_x [sqrt(gd)], mu:\n");
  for (std::size_t i = 0; i < profiles.z.size(); ++i)
    std::printf("%6.2f %8.4f %7.4f\n", profiles.z[i], profiles.column("v_x").value[i],
                profiles.column("mu").value[i]);
  const auto exact = flow.closed_form(solution.field);
  std::printf(
      "%d iterations; off the solution by quadrature by %.1e, off that without regularisation by %.1e\n",
      solution.report.iterations, exact.mesh_error, exact.closed_form_error);
  return exact.mesh_error < 0.01 ? 0 : 1;
}
