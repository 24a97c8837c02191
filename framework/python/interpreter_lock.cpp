#include "butee/python/interpreter_lock.hpp"

#include <chrono>
#include <thread>

namespace butee::python {
namespace {

/// The result of `take`, which acquires the lock.
template <class Take>
auto taken(const Take& take) {
  // The thread states of other threads, which `take` would access, are gone then. The thread that
  // ends the interpreter holds the lock and continues: objects that outlived the program die in it.
  if (_Py_IsFinalizing() != 0 && PyGILState_Check() == 0) wait_for_the_end();
  try {
    return take();
  } catch (const abi::__forced_unwind&) {
    wait_for_the_end();
  }
}

}  // namespace

void wait_for_the_end() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

InterpreterLock::InterpreterLock() : state_(taken(&PyGILState_Ensure)) {}

WithoutInterpreter::~WithoutInterpreter() {
  if (is_last_)
    PyEval_RestoreThread(thread_);
  else
    taken([this] { PyEval_RestoreThread(thread_); });
}

}  // namespace butee::python
