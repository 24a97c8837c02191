#pragma once

#include <chrono>
#include <optional>
#include <pybind11/pybind11.h>

#include "butee/python/outcome.hpp"

namespace butee::python {

/// Keeps in mind that Ctrl-C was pressed within a function in Python that C++ called.
void keep_interrupt();
/// True, once, if it was.
bool take_interrupt();

/// Checks for Ctrl-C and calls `progress(t)` from time to time, while a run continues without the
/// interpreter's lock.
class PythonWatch final : public Watch {
 public:
  /// `progress` may be None. Constructed and destroyed with the lock.
  explicit PythonWatch(pybind11::object progress) : progress_(std::move(progress)) {}

  /// Called without the lock.
  const char* look(double t) override;
  /// Called with the lock: throws the exception that Ctrl-C or `progress` raised.
  void rethrow();

 private:
  using Clock = std::chrono::steady_clock;
  bool has_raised(double t);

  pybind11::object progress_;
  std::optional<pybind11::error_already_set> error_;
  Clock::time_point looked_ = Clock::now(), called_ = looked_;
  int stride_ = 1, until_look_ = 1;
};

}  // namespace butee::python
