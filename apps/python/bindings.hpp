#pragma once
// The parts of the Python module; each adds its functions and classes.

namespace pybind11 __attribute__((visibility("hidden"))) {
  class module_;
}

namespace drumlin::python {

void add_simulation(pybind11::module_& module);
void add_contacts(pybind11::module_& module);
void add_laws(pybind11::module_& module);

}  // namespace drumlin::python
