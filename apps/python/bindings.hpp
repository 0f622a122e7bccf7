#pragma once
// The parts of the Python module; each adds its functions and classes.

namespace pybind11 __attribute__((visibility("hidden"))) {
  class module_;
  class handle;
}  // namespace )

namespace drumlin::python {

void add_simulation(pybind11::module_& module);
void add_contacts(pybind11::module_& module);
void add_laws(pybind11::module_& module);
void add_bed(pybind11::module_& module);
void add_costs(pybind11::module_& module);
void add_files(pybind11::module_& module);

/// Objects of this class come from functions of the module alone: `cls.__new__(cls)`, which copy and pickle
/// call too, would leave one without content.
void refuse_new(pybind11::handle cls);

}  // namespace drumlin::python
