// The compiled part of the Python package: what apps/python/drumlin makes friendly.
#include <pybind11/pybind11.h>

#include "apps/python/bindings.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/provenance.hpp"

namespace py = pybind11;

namespace {

/// Raises drumlin.errors.NAME(text), with the faults of an input one by one.
void raise(const char* name, const char* text, const std::vector<drumlin::InputProblem>& problems = {}) {
  const py::object kind = py::module_::import("drumlin.errors").attr(name);
  const py::object error = kind(text);
  py::list listed;
  for (const auto& problem : problems)
    listed.append(py::dict(py::arg("file") = problem.file, py::arg("line") = problem.line,
                           py::arg("key") = problem.key, py::arg("what") = problem.what,
                           py::arg("allowed") = problem.allowed));
  error.attr("problems") = listed;
  PyErr_SetObject(kind.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const drumlin::InputError& error) {
    raise("InputError", error.what(), error.problems());
  } catch (const drumlin::NotConvergedError& error) {
    raise("NotConvergedError", error.what());
  } catch (const drumlin::IoError& error) {
    raise("IoError", error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_drumlin, module) {
  module.doc() = "Grains, contact problems and laws of Drumlin; use the package drumlin.";
  py::register_exception_translator(translate);
  module.def("version", &drumlin::version_text);
  drumlin::python::add_simulation(module);
  drumlin::python::add_contacts(module);
  drumlin::python::add_laws(module);
}
