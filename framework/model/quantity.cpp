#include "butee/model/quantity.hpp"

#include <algorithm>
#include <array>

#include "butee/core/error.hpp"

namespace butee::model {
namespace {

struct Description {
  const char *name, *unit, *summary;
  Source source;
};

/// In the order of Quantity.
constexpr std::array<Description, 16> kAll = {{
    {"u", "m", "displacement", Source::motion},
    {"v", "m/s", "velocity", Source::motion},
    {"a", "m/s2", "acceleration", Source::motion},
    {"theta", "rad", "rotation, du/dx on a beam", Source::motion},
    {"theta_v", "rad/s", "its velocity", Source::motion},
    {"theta_a", "rad/s2", "its acceleration", Source::motion},
    {"contact_force", "N", "the force of all stops on the node", Source::stops},
    {"stop_state", "1", "the side on which a stop on the node is closed: +1, -1, or 0", Source::stops},
    {"V", "N", "shear force of a beam: what larger x exerts on smaller x, along u", Source::section},
    {"M", "N m", "bending moment of a beam, E I d2u/dx2: positive stretches the side of -u", Source::section},
    {"bending_stress", "Pa", "M over the section modulus: of the outer fibre on the side of -u", Source::section},
    {"von_mises", "Pa", "von Mises stress of the outer fibre", Source::section},
    {"spring_force", "N", "the force of springs and their dashpots on u of the node", Source::springs},
    {"spring_moment", "N m", "the moment of springs on theta and their dashpots on the node", Source::springs},
    {"reaction", "N", "the force of a support that fixes u of the node", Source::support},
    {"reaction_moment", "N m", "the moment of a support that fixes theta of the node", Source::support},
}};

const Description& description_of(Quantity quantity) {
  return kAll.at(static_cast<std::size_t>(quantity));
}

template <class Wanted>
std::vector<std::string> names_where(Wanted wanted) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kAll.size(); ++i)
    if (wanted(static_cast<Quantity>(i))) names.emplace_back(kAll[i].name);
  return names;
}

}  // namespace

const char* name_of(Quantity quantity) {
  return description_of(quantity).name;
}

const char* unit_of(Quantity quantity) {
  return description_of(quantity).unit;
}

const char* summary_of(Quantity quantity) {
  return description_of(quantity).summary;
}

Source source_of(Quantity quantity) {
  return description_of(quantity).source;
}

Quantity quantity_of(const std::string& name) {
  const auto* const found = std::find_if(kAll.begin(), kAll.end(), [&](const auto& one) { return one.name == name; });
  require(found != kAll.end(), "no such quantity");
  return static_cast<Quantity>(found - kAll.begin());
}

std::vector<std::string> field_quantities() {
  return names_where([](Quantity quantity) { return !is_element_force(quantity); });
}

std::vector<std::string> probe_quantities() {
  return names_where([](Quantity quantity) { return quantity != Quantity::stop_state; });
}

}  // namespace butee::model
