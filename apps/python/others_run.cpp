#include "apps/python/others_run.hpp"

#include <Python.h>
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

}  // namespace drumlin::python
