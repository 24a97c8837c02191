#pragma once

#include "butee/model/types.hpp"

namespace butee::plugin {

/// The elements, sections, laws and loads that are part of the framework's library.
model::ModelTypes builtin_types();

}  // namespace butee::plugin
