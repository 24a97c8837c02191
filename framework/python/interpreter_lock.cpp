#include "butee/python/interpreter_lock.hpp"

#include <chrono>
#include <cxxabi.h>
#include <thread>

namespace butee::python {
namespace {

[[noreturn]] void wait_for_the_end() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// The result of `take`, which acquires the lock.
template <class Take>
auto taken(const Take& take) {
  // Later its thread states, which `take` would access, are gone.
  if (_Py_IsFinalizing() != 0) wait_for_the_end();
  try {
    return take();
  } catch (const abi::__forced_unwind&) {  // may be held up, but not ended
    wait_for_the_end();
  }
}

}  // namespace

WithInterpreter::WithInterpreter() : state_(taken(&PyGILState_Ensure)) {}

WithoutInterpreter::~WithoutInterpreter() {
  taken([this] { PyEval_RestoreThread(thread_); });
}

}  // namespace butee::python
