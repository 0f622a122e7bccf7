#include "apps/python/others_run.hpp"

#include <Python.h>
#include <cxxabi.h>
#include <unistd.h>

namespace drumlin::python {

OthersRun::OthersRun() : state_(PyEval_SaveThread()) {}

OthersRun::~OthersRun() {
  try {
    PyEval_RestoreThread(state_);
  } catch (const abi::__forced_unwind&) {
    for (;;) ::pause();
  }
}

}  // namespace drumlin::python
