#include "elements/elements.hpp"

#include "elements/beam.hpp"
#include "elements/bearing.hpp"
#include "elements/disc.hpp"
#include "elements/mass.hpp"
#include "elements/matrices.hpp"
#include "elements/spring.hpp"

namespace butee::elements {

std::vector<model::ElementType> element_types() {
  return {beam_type(), mass_type(), spring_type(), disc_type(), bearing_type(), matrices_type()};
}

}  // namespace butee::elements
