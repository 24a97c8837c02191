#pragma once

#include "butee/model/types.hpp"

namespace butee::elements {

/// The element types beam, mass, spring, disc, bearing and matrices.
std::vector<model::ElementType> element_types();

/// The section types tube, circle, rectangle and general.
std::vector<model::SectionType> section_types();

}  // namespace butee::elements
