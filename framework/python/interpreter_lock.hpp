#pragma once

#include <cxxabi.h>
#include <pybind11/pybind11.h>

namespace butee::python {

/// Waits for the end of the process.
[[noreturn]] void wait_for_the_end();

/// The result of `use`, called with the interpreter's lock. Like pybind11::gil_scoped_acquire,
/// except at the end of an interpreter: CPython before 3.14 then ends a thread that waits for its
/// lock, here or between two instructions of Python code, by unwinding, which aborts the program if
/// a C++ frame catches everything or is noexcept. Here such a thread waits for the end of the
/// process, as in CPython 3.14.
template <class Use>
auto with_interpreter(const Use& use);

/// function(arguments...), called with the lock held. A thread that waits for the end of the process in it keeps the
/// objects of its callers alive: they must not be released without the lock.
pybind11::object call(pybind11::handle function, const pybind11::tuple& arguments);

/// Makes Python say which thread ends the interpreter; called when the module is imported.
void bind_end_of_interpreter();

/// Releases the lock, and acquires it again in the same way.
class WithoutInterpreter {
 public:
  WithoutInterpreter() : thread_(PyEval_SaveThread()) {}
  ~WithoutInterpreter();
  WithoutInterpreter(const WithoutInterpreter&) = delete;
  WithoutInterpreter& operator=(const WithoutInterpreter&) = delete;

 private:
  bool is_last_ = _Py_IsFinalizing() != 0;  ///< in the thread that ends the interpreter, which alone has the lock then
  PyThreadState* thread_;
};

/// Holds the lock; the part of with_interpreter that is not a template.
class InterpreterLock {
 public:
  InterpreterLock();
  ~InterpreterLock() { PyGILState_Release(state_); }
  InterpreterLock(const InterpreterLock&) = delete;
  InterpreterLock& operator=(const InterpreterLock&) = delete;

 private:
  PyGILState_STATE state_;
};

template <class Use>
auto with_interpreter(const Use& use) {
  const InterpreterLock lock;
  try {
    return use();
  } catch (const abi::__forced_unwind&) {
    wait_for_the_end();
  }
}

}  // namespace butee::python
