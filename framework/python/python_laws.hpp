#pragma once

#include <vector>

#include "butee/model/types.hpp"

namespace butee::python {

/// The laws that were written in Python. With the interpreter's lock.
const std::vector<model::LawType>& python_laws();

}  // namespace butee::python
