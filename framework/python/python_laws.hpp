#pragma once

#include <vector>

#include "butee/model/types.hpp"

namespace butee::python {

/// The laws written in Python. Call with the interpreter's lock.
const std::vector<model::LawType>& python_laws();

}  // namespace butee::python
