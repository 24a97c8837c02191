#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// beam, mass, spring, disc and bearing.
std::vector<model::ElementType> element_types();

/// tube, circle, rectangle and general.
std::vector<model::SectionType> section_types();

}  // namespace butee::elements
