#pragma once

#include <pybind11/pybind11.h>

namespace butee::python {

/// Holds the interpreter's lock. Like pybind11::gil_scoped_acquire, except at the end of an
/// interpreter: CPython before 3.14 then ends a thread that waits for its lock by unwinding, which
/// aborts the program if a C++ frame catches everything or is noexcept. Here such a thread waits
/// for the end of the process, as in CPython 3.14.
class WithInterpreter {
 public:
  WithInterpreter();
  ~WithInterpreter() { PyGILState_Release(state_); }
  WithInterpreter(const WithInterpreter&) = delete;
  WithInterpreter& operator=(const WithInterpreter&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Releases the lock, and acquires it again as WithInterpreter does.
class WithoutInterpreter {
 public:
  WithoutInterpreter() : thread_(PyEval_SaveThread()) {}
  ~WithoutInterpreter();
  WithoutInterpreter(const WithoutInterpreter&) = delete;
  WithoutInterpreter& operator=(const WithoutInterpreter&) = delete;

 private:
  PyThreadState* thread_;
};

}  // namespace butee::python
