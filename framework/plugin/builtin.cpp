#include "butee/plugin/builtin.hpp"

#include "contact/laws.hpp"
#include "elements/elements.hpp"

namespace butee::plugin {

model::ModelTypes builtin_types() {
  model::ModelTypes types;
  types.elements = elements::element_types();
  types.sections = elements::section_types();
  types.laws = {contact::linear_type(), contact::arctan_type(), contact::hertz_type()};
  types.contacts = {contact::ring_type(), contact::plane_type()};
  types.loads = model::standard_load_types();
  return types;
}

}  // namespace butee::plugin
