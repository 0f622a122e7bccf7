// One contact problem from a file, solved by the Gauss-Seidel of Siconos for planar friction (fc2d, NSGS) on
// sparse blocks, and judged by our residual.
//
// usage: benchmark_siconos PROBLEM.h5 ITERATIONS
//
// Siconos does ITERATIONS sweeps from no impulses. Its own test for leaving early is the cheapest that it
// has, and never satisfied. Prints JSON.
#include <fmt/format.h>
#include <siconos/numerics/FrictionContactProblem.h>
#include <siconos/numerics/Friction_cst.h>
#include <siconos/numerics/NonSmoothDrivers.h>
#include <siconos/numerics/NumericsMatrix.h>
#include <siconos/numerics/SolverOptions.h>
#include <siconos/numerics/SparseBlockMatrix.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/json/json_file.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/contact/residual.hpp"
#include "particles/lab/contact_problem_file.hpp"

namespace {

using namespace drumlin;
using particles::BlockProblem;

/// W of a problem as Siconos takes it. Points into the problem and its own arrays.
class SiconosMatrix {
 public:
  explicit SiconosMatrix(BlockProblem& problem) {
    auto& W = problem.W;
    const auto count = static_cast<unsigned>(W.contacts());
    for (auto& block : W.block) blocks_.push_back(block.data());  // by columns, as Siconos has them
    for (unsigned a = 0; a < count; ++a) ends_.push_back(2 * (a + 1));
    rows_.assign(W.row_start.begin(), W.row_start.end());
    columns_.assign(W.column.begin(), W.column.end());
    SBM_null(&sparse_);
    sparse_.nbblocks = static_cast<unsigned>(blocks_.size());
    sparse_.block = blocks_.data();
    sparse_.blocknumber0 = sparse_.blocknumber1 = count;
    sparse_.blocksize0 = sparse_.blocksize1 = ends_.data();
    sparse_.filled1 = rows_.size(), sparse_.filled2 = columns_.size();
    sparse_.index1_data = rows_.data(), sparse_.index2_data = columns_.data();
    const int size = 2 * static_cast<int>(count);
    NM_null(&matrix_);
    NM_fill(&matrix_, NM_SPARSE_BLOCK, size, size, &sparse_);
  }
  NumericsMatrix* get() { return &matrix_; }

 private:
  std::vector<double*> blocks_;
  std::vector<unsigned> ends_;
  std::vector<std::size_t> rows_, columns_;
  SparseBlockStructuredMatrix sparse_{};
  NumericsMatrix matrix_{};
};

/// Goes on from `impulses` by so many sweeps.
void sweep_with_siconos(SiconosMatrix& W, BlockProblem& problem, int iterations,
                        std::vector<double>& impulses) {
  FrictionContactProblem posed{};
  posed.dimension = 2, posed.numberOfContacts = problem.contacts();
  posed.M = W.get(), posed.q = problem.q.data(), posed.mu = problem.mu.data();
  SolverOptions* options = solver_options_create(SICONOS_FRICTION_2D_NSGS);
  options->iparam[SICONOS_IPARAM_MAX_ITER] = iterations;
  options->iparam[SICONOS_IPARAM_ERROR_EVALUATION] = SICONOS_ERROR_LIGHT_EVALUATION_NO_UPDATE;
  options->dparam[SICONOS_DPARAM_TOL] = 1e-300;
  options->filterOn = false;
  std::vector<double> velocities(problem.q.size());
  (void)fc2d_driver(&posed, impulses.data(), velocities.data(), options);
  solver_options_delete(options);
}

struct Solved {
  int iterations = 0;
  double processor_seconds = 0;
  particles::ContactResidual residual;
};

/// All `iterations` at once, or, with a tolerance, in parts until it is met.
Solved solve(BlockProblem& problem, int iterations, std::optional<double> tolerance) {
  Solved solved;
  std::vector<double> impulses(problem.q.size());
  while (solved.iterations < iterations &&
         !(tolerance && solved.residual.rms <= *tolerance && solved.iterations)) {
    const int part =
        tolerance ? std::min(iterations - solved.iterations, 1 + solved.iterations / 20) : iterations;
    const double before = own_cpu_seconds();
    SiconosMatrix W(problem);
    sweep_with_siconos(W, problem, part, impulses);
    solved.processor_seconds += own_cpu_seconds() - before;
    solved.iterations += part;
    solved.residual = particles::residual_of(problem, std::span<const double>(impulses));
  }
  return solved;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    fmt::print(stderr, "usage: {} PROBLEM.h5 ITERATIONS [RESIDUAL]\n", argv[0]);
    return static_cast<int>(ExitCode::wrong_input);
  }
  try {
    BlockProblem problem = particles::read_contact_problem(argv[1]);
    std::optional<double> tolerance;
    if (argc == 4) tolerance = checked_number(argv[3], {"command line", 0, "RESIDUAL"});
    const int iterations = checked_count(argv[2], {"command line", 0, "ITERATIONS"});
    if (iterations == 0) throw InputError("ITERATIONS: at least 1");
    const Solved solved = solve(problem, iterations, tolerance);
    const nlohmann::ordered_json printed = {{"contacts", problem.contacts()},
                                            {"iterations", solved.iterations},
                                            {"residual", solved.residual.rms},
                                            {"residual_max", solved.residual.max},
                                            {"processor_seconds", solved.processor_seconds},
                                            {"provenance", provenance()}};
    fmt::print("{}\n", printed.dump(2));
    return static_cast<int>(ExitCode::done);
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitCode::wrong_input);
  }
}
