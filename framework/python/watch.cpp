#include "butee/python/watch.hpp"

#include <algorithm>
#include <atomic>

#include "butee/python/interpreter_lock.hpp"

namespace py = pybind11;

namespace butee::python {
namespace {

using namespace std::chrono_literals;

/// Interval between two calls into the interpreter.
constexpr auto kBetweenCalls = 50ms;
/// The clock is read after this many steps at most, and more often if steps take longer than
/// kQuick.
constexpr int kMostStride = 256;
constexpr auto kQuick = 1ms, kSlow = 5ms;

std::atomic<bool> is_interrupted = false;

}  // namespace

void keep_interrupt() {
  is_interrupted = true;
}

bool take_interrupt() {
  return is_interrupted.exchange(false);
}

const char* PythonWatch::look(double t) {
  if (--until_look_ > 0) return nullptr;
  const auto now = Clock::now();
  if (now - looked_ < kQuick) stride_ = std::min(2 * stride_, kMostStride);
  if (now - looked_ > kSlow) stride_ = 1;
  until_look_ = stride_;
  looked_ = now;
  if (now - called_ < kBetweenCalls) return nullptr;
  called_ = now;
  return has_raised(t) ? "Python" : nullptr;
}

bool PythonWatch::has_raised(double t) {
  return with_interpreter([&] {
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress_.is_none()) call(progress_, pybind11::make_tuple(t));
    } catch (py::error_already_set& error) {
      error_.emplace(error);
    }
    return error_.has_value();
  });
}

void PythonWatch::rethrow() {
  if (!error_) return;
  py::error_already_set error = *error_;
  error_.reset();
  throw error;
}

}  // namespace butee::python
