// The compiled part of the Python package: what apps/python/drumlin makes friendly.
#include <pybind11/pybind11.h>

#include "apps/python/bindings.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"

namespace py = pybind11;

namespace {

/// A text that may hold a name that is no UTF-8.
py::str shown(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "backslashreplace"));
}

/// Raises drumlin.errors.NAME(text), with the faults of an input one by one.
void raise(const char* name, const char* text, const std::vector<drumlin::InputProblem>& problems = {}) {
  const py::object kind = py::module_::import("drumlin.errors").attr(name);
  const py::object error = kind(shown(text));
  py::list listed;
  for (const auto& problem : problems)
    listed.append(py::dict(py::arg("file") = shown(problem.file), py::arg("line") = problem.line,
                           py::arg("key") = shown(problem.key), py::arg("what") = shown(problem.what),
                           py::arg("allowed") = shown(problem.allowed)));
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

/// Lets each function of a module or class say the types that it takes, not all that it was given.
void say_types_alone(const py::object& holder, bool is_class) {
  for (const auto& [name, found] : py::dict(py::module_::import("builtins").attr("vars")(holder))) {
    if (PyType_Check(found.ptr())) say_types_alone(py::reinterpret_borrow<py::object>(found), true);
    if (!PyCFunction_Check(found.ptr()) && !PyInstanceMethod_Check(found.ptr())) continue;
    const auto call = [function = py::reinterpret_borrow<py::object>(holder.attr(name))](
                          const py::args& values, const py::kwargs& named) -> py::object {
      try {
        return function(*values, **named);
      } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_TypeError)) throw;
        const std::string text = py::str(error.value());
        throw py::type_error(text.substr(0, text.find("\nInvoked with: ")));
      }
    };
    const std::string word = py::str(name);
    holder.attr(name) = is_class ? py::cpp_function(call, py::name(word.c_str()), py::is_method(holder))
                                 : py::cpp_function(call, py::name(word.c_str()));
  }
}

PyObject* refused(PyTypeObject* type, PyObject*, PyObject*) {
  PyErr_Format(PyExc_TypeError, "%s: is not made by its name", type->tp_name);
  return nullptr;
}

}  // namespace

void drumlin::python::refuse_new(pybind11::handle cls) {
  reinterpret_cast<PyTypeObject*>(cls.ptr())->tp_new = refused;
}

PYBIND11_MODULE(_drumlin, module) {
  module.doc() = "Grains, contact problems and laws of Drumlin; use the package drumlin.";
  py::register_exception_translator(translate);
  module.def("version", &drumlin::version_text, "Version and revision, a text.");
  drumlin::python::add_simulation(module);
  drumlin::python::add_contacts(module);
  drumlin::python::add_laws(module);
  drumlin::python::add_bed(module);
  drumlin::python::add_costs(module);
  drumlin::python::add_files(module);
  say_types_alone(module, false);
}
