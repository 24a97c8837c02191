#include <algorithm>

#include <butee/core/error.hpp>

#include "solver.hpp"

namespace {

using namespace butee;
using config::number;

/// The length that absolute tolerances refer to: the largest gap of a stop, or distance of an obstacle at rest, or 1
/// mm.
double length_of(dynamics::Dynamics& dynamics) {
  double length = 0.0;
  for (Index i = 0; i < dynamics.stop_count(); ++i) length = std::max(length, dynamics.stops().play_of(i).gap);
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i)
      if (const auto& shape = obstacles->group_of(i).shape)
        length = std::max(length, -shape->at({0.0, 0.0}).penetration);
  return length > 0.0 ? length : 1e-3;
}

/// The highest order of SUNDIALS 6 (its user guides: CVODE 2.1, ARKODE 2.7).
std::int64_t highest_order(plugins::Family family) {
  switch (family) {
    case plugins::Family::cvode_bdf:
      return 5;
    case plugins::Family::cvode_adams:
      return 12;
    case plugins::Family::arkode_erk:
      return 8;
    case plugins::Family::arkode_dirk:
      return 5;
  }
  throw LogicError("no such family of SUNDIALS");
}

time::IntegratorType type_of(std::string name, std::string summary, plugins::Family family) {
  return {
      .name = std::move(name),
      .summary = std::move(summary),
      .parameters = {number("tolerance", "1", "relative tolerance of each component")
                         .above(0)
                         .at_most(0.1)
                         .or_else(1e-4)
                         .sweep(1e-1, 1e-9),
                     number("absolute_tolerance", "m, rad, m/s, rad/s",
                            "of each component; 0: tolerance times the largest gap of a contact, or times 1 mm")
                         .at_least(0)
                         .or_else(0.0),
                     config::integer("order", "the order, the highest of cvode; 0: the solver's choice")
                         .at_least(0)
                         .at_most(highest_order(family))
                         .or_else(std::int64_t{0})},
      .finds_first_step = true,
      .restarts_exactly = false,
      .contacts = time::ContactSupport::without_memory,
      .make = [family](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        const bool is_implicit = family != plugins::Family::arkode_erk;
        if (is_implicit && dynamics.obstacles() != nullptr && dynamics::has_infinite_slope(*dynamics.obstacles()))
          throw InputError(
              "integrator.type: the implicit methods of SUNDIALS take derivatives of forces, and that of the contact's "
              "dissipation is infinite where the contact closes");
        const double given = p.number("absolute_tolerance");
        return std::make_unique<plugins::SundialsIntegrator>(
            dynamics, family, p.number("tolerance"), given > 0.0 ? given : p.number("tolerance") * length_of(dynamics),
            static_cast<int>(p.integer("order")));
      }};
}

}  // namespace

BUTEE_PLUGIN(registrar) {
  using plugins::Family;
  registrar.add(type_of("cvode_bdf", "SUNDIALS CVODE, backward differences of variable order", Family::cvode_bdf));
  registrar.add(
      type_of("cvode_adams", "SUNDIALS CVODE, Adams methods of variable order with Newton", Family::cvode_adams));
  registrar.add(type_of("arkode_erk", "SUNDIALS ARKODE, explicit Runge-Kutta", Family::arkode_erk));
  registrar.add(type_of("arkode_dirk", "SUNDIALS ARKODE, diagonally implicit Runge-Kutta", Family::arkode_dirk));
}
