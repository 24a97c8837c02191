#pragma once

#include <pybind11/pybind11.h>

#include "butee/config/value.hpp"

namespace butee::python {

/// A Python value as one of a scene: bool, int, float, str, numpy scalars, and sequences, arrays and mappings of them.
/// Throws TypeError, ValueError or OverflowError of Python.
config::Value to_value(pybind11::handle from);

pybind11::object to_python(const config::Value& value);

}  // namespace butee::python
