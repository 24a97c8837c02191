#pragma once

#include "butee/plugin/catalogue.hpp"

namespace butee::python {

/// The catalogue of the program with the loads that were written in Python. With the interpreter's lock.
plugin::Catalogue catalogue_with(const std::vector<std::string>& plugins);

}  // namespace butee::python
