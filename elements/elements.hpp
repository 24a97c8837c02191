#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// beam, mass and spring.
std::vector<model::ElementType> element_types();

/// tube, circle, rectangle and general.
std::vector<model::SectionType> section_types();

}  // namespace butee::elements
