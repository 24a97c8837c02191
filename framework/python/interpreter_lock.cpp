#include "butee/python/interpreter_lock.hpp"

#include <atomic>
#include <chrono>
#include <thread>

namespace butee::python {
namespace {

/// The thread that ends the interpreter, known from the exit functions of Python on. (PyGILState_Check cannot tell it:
/// once the interpreter has ended, it answers yes in each thread.)
std::atomic<std::thread::id> ending;

/// The result of `take`, which acquires the lock.
template <class Take>
auto taken(const Take& take) {
  // The thread states of other threads, which `take` would access, are gone then. The thread that
  // ends the interpreter holds the lock and continues: objects that outlived the program die in it.
  if (_Py_IsFinalizing() != 0 && ending.load() != std::this_thread::get_id()) wait_for_the_end();
  try {
    return take();
  } catch (const abi::__forced_unwind&) {
    wait_for_the_end();
  }
}

/// Python makes a thread state for a thread that it did not start and deletes it when the thread releases the lock;
/// both cost more than most calls. Here the state is kept until the thread ends.
class KeptThreadState {
 public:
  KeptThreadState() = default;
  KeptThreadState(const KeptThreadState&) = delete;
  KeptThreadState& operator=(const KeptThreadState&) = delete;
  ~KeptThreadState() {
    if (!is_kept_ || Py_IsInitialized() == 0 || _Py_IsFinalizing() != 0) return;
    const PyGILState_STATE state = taken(&PyGILState_Ensure);
    PyGILState_Release(PyGILState_LOCKED);  // balances keep()
    PyGILState_Release(state);
  }

  /// The calling thread holds the lock and will release it as often as it acquired it.
  void keep() {
    if (!is_kept_) (void)PyGILState_Ensure();
    is_kept_ = true;
  }

 private:
  bool is_kept_ = false;
};

thread_local KeptThreadState kept;

}  // namespace

void wait_for_the_end() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

pybind11::object call(pybind11::handle function, const pybind11::tuple& arguments) {
  PyObject* result = nullptr;
  try {
    result = PyObject_CallObject(function.ptr(), arguments.ptr());
  } catch (const abi::__forced_unwind&) {
    wait_for_the_end();
  }
  if (result == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(result);
}

void bind_end_of_interpreter() {
  pybind11::module_::import("atexit").attr("register")(
      pybind11::cpp_function([] { ending = std::this_thread::get_id(); }));
}

InterpreterLock::InterpreterLock() {
  const bool is_known = PyGILState_GetThisThreadState() != nullptr;
  state_ = taken(&PyGILState_Ensure);
  if (!is_known) kept.keep();
}

WithoutInterpreter::~WithoutInterpreter() {
  if (is_last_)
    PyEval_RestoreThread(thread_);
  else
    taken([this] { PyEval_RestoreThread(thread_); });
}

}  // namespace butee::python
