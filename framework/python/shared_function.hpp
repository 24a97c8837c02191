#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <vector>

#include "butee/config/parameter.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/python/interpreter_lock.hpp"
#include "butee/python/watch.hpp"

namespace butee::python {

/// A Python function whose last reference may be released by any thread.
inline std::shared_ptr<pybind11::function> shared_function(const pybind11::function& function) {
  return {new pybind11::function(function),
          [](pybind11::function* held) { with_interpreter([held] { delete held; }); }};
}

/// function(first, parameters...), called from any thread. Throws RunError if that is not a number, or NaN.
inline double call_with(const pybind11::function& function, double first, const std::vector<double>& parameters) {
  return with_interpreter([&] {
    pybind11::tuple arguments(parameters.size() + 1);
    arguments[0] = first;
    for (std::size_t i = 0; i < parameters.size(); ++i) arguments[i + 1] = parameters[i];
    pybind11::object result;
    try {
      result = call(function, arguments);
    } catch (const pybind11::error_already_set& error) {
      // Ctrl-C within the function ends the run, and is raised where the run was called.
      if (!error.matches(PyExc_KeyboardInterrupt)) throw;
      keep_interrupt();
      throw RunError("interrupted");
    }
    double value = std::nan("");
    try {
      value = result.cast<double>();
    } catch (const pybind11::cast_error&) {
    }
    if (!std::isnan(value)) return value;
    const auto name = pybind11::str(pybind11::getattr(function, "__name__", function));
    throw RunError("the Python function " + std::string(name) + " returned " + std::string(pybind11::repr(result)) +
                   " at " + to_short_text(first) + ", not a number");
  });
}

/// Names of parameters with their defaults.
using DeclaredParameters = std::vector<std::pair<std::string, std::optional<double>>>;

/// Adds a declaration for each parameter and returns their names.
inline std::vector<std::string> declare(const DeclaredParameters& parameters, std::vector<config::Parameter>& to) {
  std::vector<std::string> names;
  for (const auto& [parameter, value] : parameters) {
    const config::Parameter declared = config::number(parameter, "", "a parameter of the function in Python");
    to.push_back(value ? declared.or_else(*value) : declared);
    names.push_back(parameter);
  }
  return names;
}

}  // namespace butee::python
