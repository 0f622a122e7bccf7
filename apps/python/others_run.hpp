#pragma once
// The interpreter's lock, given away while this thread computes.

struct _ts;  // CPython's PyThreadState

namespace drumlin::python {

/// Lets other threads of Python run while it lives. A daemon thread that comes back when the interpreter has
/// begun to end would be unwound by CPython, through destructors that need the lock: it waits for the end of
/// the process instead, as Python 3.14 does by itself.
class OthersRun {
 public:
  OthersRun();
  ~OthersRun();
  OthersRun(const OthersRun&) = delete;
  OthersRun& operator=(const OthersRun&) = delete;

 private:
  _ts* state_;
};

/// Whether signals, and what Python does with them, are those of this thread. With the interpreter's lock.
bool in_main_thread();

}  // namespace drumlin::python
