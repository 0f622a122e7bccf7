// Contact problems for Python: arrays in, impulses, velocities and the report out.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>

#include "apps/python/arrays-inl.h"
#include "apps/python/bindings.hpp"
#include "apps/python/others_run.hpp"
#include "coupling/core/basics/errors.hpp"
#include "particles/lab/any_solver.hpp"
#include "particles/lab/matrix_problem.hpp"
#include "particles/lab/solve_contacts.hpp"

namespace py = pybind11;

namespace drumlin::python {
namespace {

using Indices = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

std::vector<double> values_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}
py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

particles::MatrixProblem problem_of(const Indices& rows, const Indices& columns, const Numbers& entries,
                                    const Numbers& q, const Numbers& mu) {
  const particles::Refusal refuse = [](const std::string& name, const std::string& what) {
    throw InputError({InputProblem{"", 0, 0, name, what, ""}});
  };
  if (rows.size() != entries.size() || columns.size() != entries.size())
    refuse("W", "not as many rows and columns as numbers");
  std::vector<particles::MatrixEntry> W;
  for (py::ssize_t k = 0; k < entries.size(); ++k)
    W.push_back({rows.data()[k], columns.data()[k], entries.data()[k]});
  return particles::matrix_problem(W, values_of(q), values_of(mu), refuse);
}

// Ctrl-C during a solve: seen where the solver looks at its residual, and raised once it has returned.
// Signals belong to the main thread: others neither see them nor touch this.
bool signalled = false;
bool look_for_signals() {
  if (signalled) return true;
  const py::gil_scoped_acquire lock;
  signalled = PyErr_CheckSignals() != 0;
  return signalled;
}

py::dict solved(const particles::MatrixProblem& of, double tolerance, double max_seconds,
                const std::string& solver, int threads) {
  particles::StoppingRule rule;
  rule.tolerance = tolerance;
  rule.max_seconds = max_seconds;
  rule.max_sweeps = std::numeric_limits<int>::max();
  const bool sees_signals = in_main_thread();
  if (sees_signals) {
    rule.interrupted = &look_for_signals;
    signalled = false;
  }
  particles::SolvedContacts result;
  {
    const OthersRun others_run;
    result = particles::solve_contacts(of.problem, rule, solver, threads);
  }
  if (sees_signals && signalled) throw py::error_already_set();
  const auto& report = result.report;
  return py::dict(py::arg("r") = array_of(result.solution.impulses),
                  py::arg("u") = array_of(result.solution.velocities.contacts),
                  py::arg("status") = name_of(report.status),
                  py::arg("converged") = report.status == particles::Status::converged,
                  py::arg("sweeps") = report.sweeps, py::arg("seconds") = report.seconds,
                  py::arg("residual") = report.residual.rms, py::arg("residual_max") = report.residual.max,
                  py::arg("discs") = result.of_discs, py::arg("asymmetry") = of.asymmetry);
}

}  // namespace

void add_contacts(py::module_& module) {
  module.def("contact_solvers", &particles::any_solver_names);
  module.def("solve_contacts", [](const Indices& rows, const Indices& columns, const Numbers& entries,
                                  const Numbers& q, const Numbers& mu, double tolerance, double max_seconds,
                                  const std::string& solver, int threads) {
    return solved(problem_of(rows, columns, entries, q, mu), tolerance, max_seconds, solver, threads);
  });
  module.def("contact_residual", [](const Indices& rows, const Indices& columns, const Numbers& entries,
                                    const Numbers& q, const Numbers& mu, const Numbers& r) {
    const auto problem = problem_of(rows, columns, entries, q, mu).problem;
    if (r.size() != q.size()) throw InputError({InputProblem{"", 0, 0, "r", "not as long as q", ""}});
    particles::Solution<particles::BlockProblem> solution{values_of(r), {}};
    return particles::residual_of(problem, solution).rms;
  });
}

}  // namespace drumlin::python
