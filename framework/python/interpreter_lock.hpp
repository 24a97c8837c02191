#pragma once

#include <pybind11/pybind11.h>

namespace butee::python {

/// Holds the interpreter's lock. As pybind11::gil_scoped_acquire, but for the end of an interpreter: CPython
/// before 3.14 ends a thread that waits for its lock then by unwinding, which aborts the program where a frame of C++
/// catches everything or promises to throw nothing. Such a thread waits here for the end of the process instead, as
/// CPython 3.14 has it.
class WithInterpreter {
 public:
  WithInterpreter();
  ~WithInterpreter() { PyGILState_Release(state_); }
  WithInterpreter(const WithInterpreter&) = delete;
  WithInterpreter& operator=(const WithInterpreter&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Gives the lock away, and takes it again as WithInterpreter does.
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
