#include "butee/model/quantity.hpp"

#include <algorithm>
#include <array>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::model {
namespace {

struct Description {
  const char *name, *unit, *summary;
  Source source;
  DofKind kind = DofKind::uy;
  int order = 0;
};

/// In the order of Quantity.
constexpr std::array<Description, 74> kAll = {{
    {"u", "m", "displacement", Source::motion, DofKind::uy, 0},
    {"v", "m/s", "velocity", Source::motion, DofKind::uy, 1},
    {"a", "m/s2", "acceleration", Source::motion, DofKind::uy, 2},
    {"theta", "rad", "rotation, du/dx on a beam", Source::motion, DofKind::rz, 0},
    {"theta_v", "rad/s", "its velocity", Source::motion, DofKind::rz, 1},
    {"theta_a", "rad/s2", "its acceleration", Source::motion, DofKind::rz, 2},
    {"contact_force", "N",
     "the force of all contacts on the node along u, or along the DOF of its first contact if none is on u", Source::stops,
     DofKind::uy, 0},
    {"stop_state", "1", "the side on which a stop on the node is closed: +1, -1, or 0", Source::stops, DofKind::uy, 0},
    {"V", "N", "shear force of a beam, exerted by the larger-x side on the smaller-x side, along u", Source::section,
     DofKind::uy, 0},
    {"M", "N m", "bending moment of a beam, E I d2u/dx2; positive: tension on the side of -u", Source::section,
     DofKind::rz, 0},
    {"bending_stress", "Pa", "M over the section modulus: of the outer fibre on the side of -u", Source::section,
     DofKind::rz, 0},
    {"von_mises", "Pa", "von Mises stress of the outer fibre", Source::section, DofKind::rz, 0},
    {"spring_force", "N", "the force of springs and their dashpots on u of the node", Source::springs, DofKind::uy, 0},
    {"spring_moment", "N m", "the moment of springs on theta and their dashpots on the node", Source::springs,
     DofKind::rz, 0},
    {"reaction", "N", "the force of a support that fixes u of the node", Source::support, DofKind::uy, 0},
    {"reaction_moment", "N m", "the moment of a support that fixes theta of the node", Source::support, DofKind::rz, 0},
    {"ux", "m", "displacement along x", Source::motion, DofKind::ux, 0},
    {"ux_v", "m/s", "its velocity", Source::motion, DofKind::ux, 1},
    {"ux_a", "m/s2", "its acceleration", Source::motion, DofKind::ux, 2},
    {"uy", "m", "displacement along y, another name of u", Source::motion, DofKind::uy, 0},
    {"uy_v", "m/s", "its velocity", Source::motion, DofKind::uy, 1},
    {"uy_a", "m/s2", "its acceleration", Source::motion, DofKind::uy, 2},
    {"uz", "m", "displacement along z", Source::motion, DofKind::uz, 0},
    {"uz_v", "m/s", "its velocity", Source::motion, DofKind::uz, 1},
    {"uz_a", "m/s2", "its acceleration", Source::motion, DofKind::uz, 2},
    {"w", "m", "displacement along z, another name of uz", Source::motion, DofKind::uz, 0},
    {"w_v", "m/s", "its velocity", Source::motion, DofKind::uz, 1},
    {"w_a", "m/s2", "its acceleration", Source::motion, DofKind::uz, 2},
    {"rx", "rad", "rotation about x", Source::motion, DofKind::rx, 0},
    {"rx_v", "rad/s", "its velocity", Source::motion, DofKind::rx, 1},
    {"rx_a", "rad/s2", "its acceleration", Source::motion, DofKind::rx, 2},
    {"ry", "rad", "rotation about y", Source::motion, DofKind::ry, 0},
    {"ry_v", "rad/s", "its velocity", Source::motion, DofKind::ry, 1},
    {"ry_a", "rad/s2", "its acceleration", Source::motion, DofKind::ry, 2},
    {"rz", "rad", "rotation about z, another name of theta", Source::motion, DofKind::rz, 0},
    {"rz_v", "rad/s", "its velocity", Source::motion, DofKind::rz, 1},
    {"rz_a", "rad/s2", "its acceleration", Source::motion, DofKind::rz, 2},
    {"u_abs", "m", "displacement in space, under base motion", Source::motion, DofKind::uy, 0},
    {"v_abs", "m/s", "its velocity", Source::motion, DofKind::uy, 1},
    {"a_abs", "m/s2", "its acceleration", Source::motion, DofKind::uy, 2},
    {"ux_abs", "m", "displacement along x in space", Source::motion, DofKind::ux, 0},
    {"ux_v_abs", "m/s", "its velocity", Source::motion, DofKind::ux, 1},
    {"ux_a_abs", "m/s2", "its acceleration", Source::motion, DofKind::ux, 2},
    {"uz_abs", "m", "displacement along z in space", Source::motion, DofKind::uz, 0},
    {"uz_v_abs", "m/s", "its velocity", Source::motion, DofKind::uz, 1},
    {"uz_a_abs", "m/s2", "its acceleration", Source::motion, DofKind::uz, 2},
    {"N", "N", "normal force of a beam, with its preload: tension is positive", Source::section, DofKind::ux, 0},
    {"Vy", "N", "shear force along the beam's own axis y; V of a beam along x", Source::section, DofKind::uy, 0},
    {"Vz", "N", "shear force along the beam's own axis z", Source::section, DofKind::uz, 0},
    {"T", "N m", "torque about the beam's own axis x", Source::section, DofKind::rx, 0},
    {"My", "N m", "bending moment about the beam's own axis y, -E I d2w/dx2", Source::section, DofKind::ry, 0},
    {"Mz", "N m", "bending moment about the beam's own axis z; M of a beam along x", Source::section, DofKind::rz, 0},
    {"spring_ux", "N", "force of springs on ux, bearings and their dashpots on the node", Source::springs, DofKind::ux,
     0},
    {"spring_uy", "N", "force of springs on uy, bearings and their dashpots on the node", Source::springs, DofKind::uy,
     0},
    {"spring_uz", "N", "force of springs on uz, bearings and their dashpots on the node", Source::springs, DofKind::uz,
     0},
    {"spring_rx", "N m", "moment of springs on rx, bearings and their dashpots on the node", Source::springs,
     DofKind::rx, 0},
    {"spring_ry", "N m", "moment of springs on ry, bearings and their dashpots on the node", Source::springs,
     DofKind::ry, 0},
    {"spring_rz", "N m", "moment of springs on rz, bearings and their dashpots on the node", Source::springs,
     DofKind::rz, 0},
    {"reaction_ux", "N", "force of a support that fixes ux of the node", Source::support, DofKind::ux, 0},
    {"reaction_uy", "N", "force of a support that fixes uy of the node", Source::support, DofKind::uy, 0},
    {"reaction_uz", "N", "force of a support that fixes uz of the node", Source::support, DofKind::uz, 0},
    {"reaction_rx", "N m", "moment of a support that fixes rx of the node", Source::support, DofKind::rx, 0},
    {"reaction_ry", "N m", "moment of a support that fixes ry of the node", Source::support, DofKind::ry, 0},
    {"reaction_rz", "N m", "moment of a support that fixes rz of the node", Source::support, DofKind::rz, 0},
    {"normal_force", "N", "normal force of the contacts on the node, with dissipation", Source::contacts, DofKind::uy,
     0},
    {"friction_force", "N", "their friction force, positive against a positive slip", Source::contacts, DofKind::uy, 0},
    {"slip", "m/s", "the slip speed of the closed ones; 0 without friction", Source::contacts, DofKind::uy, 0},
    {"wear_power", "W", "normal force times slip speed (Archard), of the closed contacts", Source::contacts,
     DofKind::uy, 0},
    {"contact_ux", "N", "force of all contacts on the node along ux", Source::stops, DofKind::ux, 0},
    {"contact_uy", "N", "force of all contacts on the node along uy", Source::stops, DofKind::uy, 0},
    {"contact_uz", "N", "force of all contacts on the node along uz", Source::stops, DofKind::uz, 0},
    {"contact_rx", "N m", "moment of all contacts on the node about x", Source::stops, DofKind::rx, 0},
    {"contact_ry", "N m", "moment of all contacts on the node about y", Source::stops, DofKind::ry, 0},
    {"contact_rz", "N m", "moment of all contacts on the node about z", Source::stops, DofKind::rz, 0},
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
  if (found == kAll.end()) {
    const std::vector<std::string> known = probe_quantities();
    throw InputError("there is no quantity \"" + name + "\"" + suggestion(name, known) + "; known: " + join(known));
  }
  return static_cast<Quantity>(found - kAll.begin());
}

DofKind kind_of(Quantity quantity) {
  return description_of(quantity).kind;
}

bool is_absolute(Quantity quantity) {
  return quantity >= Quantity::u_abs && quantity <= Quantity::uz_a_abs;
}

int order_of(Quantity quantity) {
  return description_of(quantity).order;
}

std::vector<std::string> field_quantities() {
  return names_where([](Quantity quantity) {
    return quantity <= Quantity::stop_state || (source_of(quantity) == Source::motion && !is_absolute(quantity));
  });
}

std::vector<std::string> probe_quantities() {
  return names_where([](Quantity quantity) { return quantity != Quantity::stop_state; });
}

}  // namespace butee::model
