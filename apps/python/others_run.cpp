#include "apps/python/others_run.hpp"

#include <pybind11/pybind11.h>
#include <unistd.h>

namespace drumlin::python {

OthersRun::OthersRun() : state_(PyEval_SaveThread()) {}

OthersRun::~OthersRun() {
  try {
    PyEval_RestoreThread(state_);
  } catch (...) {  // abi::__forced_unwind, of which there is no object to refer to
    for (;;) ::pause();
  }
}

bool in_main_thread() {
  const auto threading = pybind11::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

}  // namespace drumlin::python
