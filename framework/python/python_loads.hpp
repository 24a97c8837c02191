#pragma once

#include "butee/plugin/catalogue.hpp"

namespace butee::python {

/// The program's catalogue with the loads written in Python. Call with the interpreter's lock.
plugin::Catalogue catalogue_with(const std::vector<std::string>& plugins);

}  // namespace butee::python
