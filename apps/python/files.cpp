// Checks of files for Python, which then reads them with h5py. HDF5 serves one thread: they keep the
// interpreter's lock.
#include <pybind11/pybind11.h>

#include "apps/python/bindings.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "particles/lab/contact_problem_file.hpp"

namespace drumlin::python {

void add_files(pybind11::module_& module) {
  module.def("check_hdf5", [](const std::string& file) { require_readable(file); });
  module.def("check_contact_problem",
             [](const std::string& file) { (void)particles::read_contact_problem_file(file); });
}

}  // namespace drumlin::python
