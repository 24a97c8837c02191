#include "butee/scene/contact_tables.hpp"

#include <cmath>
#include <numbers>

#include "butee/core/text.hpp"

namespace butee::scene {

using config::number;
using config::Parameters;
using config::text;
using model::Friction;
using model::ImpactDamping;

namespace {

constexpr int kBisections = 200;
/// A smaller restitution is 0 to all digits that a coefficient can have.
constexpr double kSmallestRestitution = 1e-9;
/// Jankowski's coefficient is given only down to this restitution, since his formula is of no use below: at 1e-3 the
/// resulting one is 160.
constexpr double kSmallestOfJankowski = 1e-3;

/// The root of an increasing function between two arguments.
template <class Function>
double root_between(double low, double high, Function f) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (f(middle) > 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Restitution of a linear spring and dashpot whose contact ends at F = 0: exp(-z t) at the time
/// t = 2 phi / sin(phi), z = cos(phi); beyond critical damping t = 2 phi / sinh(phi), z = cosh(phi).
double restitution_without_pull(double z) {
  if (z == 1.0) return std::exp(-2.0);
  const double phi = z < 1.0 ? std::acos(z) : std::acosh(z);
  return std::exp(-2.0 * z * phi / std::sqrt(std::abs((1.0 - z) * (1.0 + z))));
}

}  // namespace

double kelvin_voigt_ratio(double restitution, bool pulls) {
  if (restitution == 1.0) return 0.0;
  const double log = std::log(restitution);
  if (pulls) return -log / std::hypot(std::numbers::pi, log);
  double high = 1.0;
  while (restitution_without_pull(high) > restitution) high *= 2.0;
  return root_between(0.0, high, [&](double z) { return restitution - restitution_without_pull(z); });
}

double hunt_crossley_product(double restitution) {
  if (restitution == 1.0) return 0.0;
  const auto miss = [&](double s) { return s * (1.0 + restitution) - std::log1p(s) + std::log1p(-s * restitution); };
  // The other root is s = 0; between the two the function is positive.
  const double limit = 1.0 / restitution;
  double low = limit;
  while (miss(low * (1.0 - 1e-15)) <= 0.0 && low > 1e-9) low *= 0.5;
  return root_between(low * (1.0 - 1e-15), std::min(2.0 * low, limit * (1.0 - 1e-15)),
                      [&](double s) { return -miss(s); });
}

double jankowski_ratio(double e) {
  const double root = std::sqrt(5.0);
  return 4.5 * root * (1.0 - e * e) / (e * (e * (9.0 * std::numbers::pi - 16.0) + 16.0));
}

double jankowski_restitution(double ratio) {
  // d'' = -d^(3/2) - 2 xi d^(1/4) d' from d = 0, d' = 1 to d' = 0, in the variable q with d = q^4,
  // by the Runge-Kutta method with the speed as the argument; the rebound from d_max is elastic.
  // The approach takes 1.47 without damping and less with it.
  constexpr int kSteps = 200000;
  constexpr double kLongest = 3.0, h = kLongest / kSteps;
  double d = 0.0, v = 1.0;
  const auto acceleration = [&](double at, double speed) {
    const double depth = std::max(at, 0.0);
    return -depth * std::sqrt(depth) - 2.0 * ratio * std::sqrt(std::sqrt(depth)) * speed;
  };
  for (int i = 0; i < kSteps; ++i) {
    const double a1 = acceleration(d, v), a2 = acceleration(d + 0.5 * h * v, v + 0.5 * h * a1);
    const double a3 = acceleration(d + 0.5 * h * (v + 0.5 * h * a1), v + 0.5 * h * a2);
    const double a4 = acceleration(d + h * (v + 0.5 * h * a2), v + h * a3);
    const double next = v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (next <= 0.0) {
      const double rest = v / (v - next);
      d += rest * h * 0.5 * v;
      break;
    }
    d += h * v + h * h / 6.0 * (a1 + a2 + a3);
    v = next;
  }
  return std::sqrt(0.8 * std::pow(d, 2.5));
}

std::optional<double> ContactTables::restitution(const Parameters& p, const char* companion) {
  if (p.has(companion)) return p.number("restitution");
  p.complain(diagnostics_, companion,
             std::string("missing; a restitution needs ") + (std::string(companion) == "mass"
                                                                 ? "the effective mass of the impact (mass, kg)"
                                                                 : "the speed of the impact (impact_speed, m/s)"));
  return std::nullopt;
}

std::optional<ImpactDamping> ContactTables::damping(const model::LawType* law) {
  if (!contact_.has("damping")) return ImpactDamping{};
  const config::Value& given = contact_.value("damping");
  if (law == nullptr) return std::nullopt;
  const auto p = read_parameters(
      given, path_ + ".damping",
      {text("type", "the kind of dissipation").one_of({"kelvin_voigt", "hunt_crossley", "jankowski"}),
       number("coefficient", "N s/m", "c of kelvin_voigt").at_least(0).optional(),
       config::boolean("pull", "of kelvin_voigt; true: the contact ends at g = 0, with tension before; false: at F = 0")
           .or_else(false),
       number("factor", "s/m", "a of hunt_crossley").at_least(0).optional(),
       number("restitution", "1", "speed after an impact over that before, instead of a coefficient")
           .at_least(kSmallestRestitution)
           .at_most(1)
           .optional(),
       number("mass", "kg", "effective mass of the impact").above(0).optional(),
       number("impact_speed", "m/s", "the impact speed at which the restitution holds").above(0).optional()},
      diagnostics_);
  if (!p) return std::nullopt;
  const std::string& type = p->text("type");
  for (const auto& [key, owner] : {std::pair("coefficient", "kelvin_voigt"), std::pair("factor", "hunt_crossley")})
    if (p->has(key) && type != owner) {
      p->complain(diagnostics_, key, std::string("belongs to ") + owner + ", not to " + type);
      return std::nullopt;
    }
  if (type == "kelvin_voigt") return kelvin_voigt(*p);
  return type == "hunt_crossley" ? hunt_crossley(*p) : jankowski(*p);
}

std::optional<ImpactDamping> ContactTables::kelvin_voigt(const Parameters& p) {
  ImpactDamping damping{ImpactDamping::Kind::kelvin_voigt, 0.0, 0.0, p.flag("pull")};
  if (p.has("coefficient") == p.has("restitution")) {
    p.complain(diagnostics_, "coefficient", "give either it or restitution, with mass");
    return std::nullopt;
  }
  if (p.has("coefficient")) {
    damping.coefficient = p.number("coefficient");
    return damping;
  }
  const auto e = restitution(p, "mass");
  if (!e) return std::nullopt;
  if (law_ != "linear") {
    p.complain(diagnostics_, "restitution",
               "determines a coefficient only with law = \"linear\"; give the coefficient");
    return std::nullopt;
  }
  damping.coefficient =
      2.0 * kelvin_voigt_ratio(*e, damping.pulls) * std::sqrt(contact_.number("stiffness") * p.number("mass"));
  return damping;
}

std::optional<ImpactDamping> ContactTables::hunt_crossley(const Parameters& p) {
  ImpactDamping damping{ImpactDamping::Kind::hunt_crossley, 0.0, 0.0, false};
  if (p.has("factor") == p.has("restitution")) {
    p.complain(diagnostics_, "factor", "give either it or restitution, with impact_speed");
    return std::nullopt;
  }
  if (p.has("factor")) {
    damping.coefficient = p.number("factor");
    return damping;
  }
  const auto e = restitution(p, "impact_speed");
  if (!e) return std::nullopt;
  damping.coefficient = hunt_crossley_product(*e) / p.number("impact_speed");
  return damping;
}

std::optional<ImpactDamping> ContactTables::jankowski(const Parameters& p) {
  if (!p.has("restitution")) {
    p.complain(diagnostics_, "restitution", "missing; jankowski takes restitution and mass");
    return std::nullopt;
  }
  const auto e = restitution(p, "mass");
  if (!e) return std::nullopt;
  if (law_ != "hertz" || contact_.number("exponent") != 1.5) {
    p.complain(diagnostics_, "type", "jankowski requires law = \"hertz\" with the exponent 1.5");
    return std::nullopt;
  }
  if (*e < kSmallestOfJankowski) {
    p.complain(diagnostics_, "restitution",
               "is too small for jankowski's formula; at least " + to_short_text(kSmallestOfJankowski) + " is allowed");
    return std::nullopt;
  }
  const double ratio = jankowski_ratio(*e);
  diagnostics_.warning(p.key("restitution"), p.value("restitution").at,
                       "jankowski's formula is approximate: the resulting restitution is " +
                           to_short_text(jankowski_restitution(ratio)));
  return ImpactDamping{ImpactDamping::Kind::jankowski, ratio, p.number("mass"), false};
}

std::optional<Friction> ContactTables::friction() {
  if (!contact_.has("friction")) return Friction{};
  const auto p = read_parameters(
      contact_.value("friction"), path_ + ".friction",
      {number("coefficient", "1", "mu of slip").at_least(0),
       number("static_coefficient", "1", "mu of stick; default: coefficient").at_least(0).optional(),
       number("slip_speed", "m/s", "the slip speed over which regularised friction changes its sign")
           .above(0)
           .optional(),
       text("smoothing", "the smoothing of regularised friction").one_of({"sqrt", "tanh", "clip"}).or_else("sqrt"),
       number("stick_stiffness", "N/m", "the stiffness of the spring that holds a sticking contact")
           .above(0)
           .optional(),
       number("stick_damping", "N s/m", "the damping of the dashpot parallel to it").at_least(0).optional(),
       text("stick", "a sticking contact does not move at all").one_of({"rigid"}).optional(),
       number("surface_speed", "m/s", "the speed of the obstacle along the tangent").or_else(0.0)},
      diagnostics_);
  if (!p) return std::nullopt;
  Friction friction;
  friction.coefficient = p->number("coefficient");
  friction.static_coefficient = p->has("static_coefficient") ? p->number("static_coefficient") : friction.coefficient;
  friction.surface_speed = p->number("surface_speed");
  const int ways = int(p->has("slip_speed")) + int(p->has("stick_stiffness")) + int(p->has("stick"));
  if (ways != 1) {
    diagnostics_.error(
        p->path(), p->at(),
        "give one of slip_speed (regularised), stick_stiffness (a spring with memory) and stick = \"rigid\"");
    return std::nullopt;
  }
  const auto refuse = [&](const char* key, const std::string& complaint) {
    p->complain(diagnostics_, key, complaint);
    return std::nullopt;
  };
  if (p->has("slip_speed")) {
    friction.slip_speed = p->number("slip_speed");
    const std::string& smoothing = p->text("smoothing");
    friction.rule = smoothing == "tanh"   ? Friction::Rule::tanh
                    : smoothing == "clip" ? Friction::Rule::clip
                                          : Friction::Rule::sqrt;
    if (p->has("static_coefficient"))
      return refuse("static_coefficient",
                    "belongs to stick_stiffness or stick = \"rigid\": regularised friction does not stick");
  } else {
    friction.rule = p->has("stick") ? Friction::Rule::rigid : Friction::Rule::spring;
    if (p->given("smoothing")) return refuse("smoothing", "belongs to slip_speed");
  }
  if (friction.rule == Friction::Rule::spring) {
    friction.stick_stiffness = p->number("stick_stiffness");
    if (p->has("stick_damping")) friction.stick_damping = p->number("stick_damping");
  } else if (p->has("stick_damping")) {
    return refuse("stick_damping", "belongs to stick_stiffness");
  }
  if (friction.static_coefficient < friction.coefficient)
    return refuse("static_coefficient", "must not be below coefficient = " + to_text(friction.coefficient));
  return friction;
}

}  // namespace butee::scene
