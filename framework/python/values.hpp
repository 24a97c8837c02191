#pragma once

#include <pybind11/pybind11.h>

#include "butee/config/value.hpp"

namespace butee::python {

/// Converts a Python value to one of a scene: bool, int, float, str, numpy scalars, and sequences,
/// arrays and mappings of them. Throws Python's TypeError, ValueError or OverflowError.
config::Value to_value(pybind11::handle from);

pybind11::object to_python(const config::Value& value);

}  // namespace butee::python
