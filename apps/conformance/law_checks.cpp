#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"

namespace butee::conformance {
namespace {

/// The law of a stop with the subject's keys.
std::unique_ptr<model::ContactLaw> make_law(const Subject& subject) {
  const config::Document document = config::parse_toml(subject.keys, "the suite's law");
  config::Diagnostics diagnostics(document);
  const auto* type = model::find_type(subject.catalogue.types().laws, subject.name);
  const auto parameters = config::read_parameters(document.root, "contact[0]", type->parameters, diagnostics);
  diagnostics.throw_if_any();
  auto law = type->make(*parameters, diagnostics);
  diagnostics.throw_if_any();
  require(law != nullptr, "the maker of a law returns one");
  return law;
}

/// Penetrations from 1 nm to 6.1 m in absolute value, of both signs (closed and open). None is a round number: laws
/// have corners there, with two slopes.
std::vector<double> penetrations() {
  std::vector<double> g;
  for (int decade = -9; decade <= 0; ++decade)
    for (const double digit : {1.0313, 2.7189, 6.0917})
      for (const double sign : {1.0, -1.0}) g.push_back(sign * digit * std::pow(10.0, decade));
  return g;
}

double force(const model::ContactLaw& law, double g) {
  return law.secant(g) * g;
}

/// Relative step of finite differences, whose error is about 1e-10 for a smooth function, and their
/// tolerance, which allows for high curvature within that step.
constexpr double kReach = 1e-5, kDifference = 1e-6;

Finding check_derivatives(const Subject& subject) {
  const auto law = make_law(subject);
  if (law->energy(0.0) != 0.0) return {false, "V(0) = " + to_text(law->energy(0.0)) + " instead of 0"};
  for (const double g : penetrations()) {
    const double d = kReach * std::abs(g),
                 scale = std::abs(force(*law, g)) + 1e-12 * law->closed_stiffness() * std::abs(g);
    const double slope = (law->energy(g + d) - law->energy(g - d)) / (2.0 * d);
    // An energy of both signs loses digits if it is much larger than F g.
    const double lost = 1e-15 * std::abs(law->energy(g)) / d;
    if (!(std::abs(slope - force(*law, g)) <= kDifference * scale + lost))
      return {false, "at g = " + to_short_text(g) + " m dV/dg = " + to_text(slope) +
                         " and F = K_c g = " + to_text(force(*law, g))};
    const double tangent = (force(*law, g + d) - force(*law, g - d)) / (2.0 * d);
    if (!(std::abs(tangent - law->tangent(g)) <=
          kDifference * (std::abs(law->tangent(g)) + 1e-6 * law->closed_stiffness())))
      return {false, "at g = " + to_short_text(g) + " m dF/dg = " + to_text(tangent) +
                         " and tangent() = " + to_text(law->tangent(g))};
  }
  return {true, "dV/dg = F and dF/dg = tangent from 1 nm to 6 m"};
}

Finding check_batches(const Subject& subject) {
  const auto law = make_law(subject);
  const auto g = penetrations();
  // A law may use another formula for many stops, accurate to the rounding of k_c.
  const double rounding = 1e-13 * law->closed_stiffness();
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{17}, g.size()}) {
    std::vector<double> secant(count), again(count), tangent(count);
    law->secants({g.data(), count}, secant);
    law->tangents({g.data(), count}, again, tangent);
    for (std::size_t i = 0; i < count; ++i)
      for (const auto& [name, got, expected] : {std::tuple("secants()", secant[i], law->secant(g[i])),
                                                std::tuple("the secants of tangents()", again[i], law->secant(g[i])),
                                                std::tuple("tangents()", tangent[i], law->tangent(g[i]))})
        if (!(std::abs(got - expected) <= 1e-12 * std::abs(expected) + rounding))
          return {false, std::string(name) + " for " + std::to_string(count) + " stops gives " + to_text(got) +
                             " at g = " + to_short_text(g[i]) + " m, one stop " + to_text(expected)};
  }
  return {true, "one stop or many, the same"};
}

Finding check_bounds(const Subject& subject) {
  const auto law = make_law(subject);
  if (!(law->closed_stiffness() > 0.0) || !std::isfinite(law->closed_stiffness()))
    return {false, "closed_stiffness() = " + to_text(law->closed_stiffness()) + " N/m"};
  for (const double g : penetrations()) {
    if (!std::isfinite(law->secant(g) + law->tangent(g) + law->energy(g)))
      return {false, "not finite at g = " + to_short_text(g) + " m"};
    if (g > 0.0 && force(*law, g) < 0.0) return {false, "pulls at a penetration of " + to_short_text(g) + " m"};
  }
  if (const double pull = std::abs(force(*law, -1.0)); pull > law->asymptotic_force() * (1.0 + 1e-6) + 1e-300)
    return {false, "acts with " + to_short_text(pull) + " N on a stop that is open by 1 m; asymptotic_force() says " +
                       to_short_text(law->asymptotic_force())};
  for (const double g : {0.0, -0.0})
    if (!std::isfinite(law->secant(g) + law->tangent(g))) return {false, "not finite at g = 0"};
  return {true,
          "finite from 1 nm to 6 m, never pulls closed, k_c = " + to_short_text(law->closed_stiffness()) + " N/m"};
}

Finding check_series(const Subject& subject) {
  const auto law = make_law(subject);
  if (law->is_piecewise_linear()) {
    for (const double g : penetrations())
      if (const double expected = law->closed_stiffness() * std::max(g, 0.0);
          !(std::abs(force(*law, g) - expected) <= 1e-12 * expected))
        return {false, "is_piecewise_linear() is true; at g = " + to_short_text(g) + " m F is " +
                           to_text(force(*law, g)) + " N, k_c max(g, 0) is " + to_text(expected)};
    return {true, "F = k_c max(g, 0)"};
  }
  const auto series = law->force_series();
  if (series == nullptr) return {true, "none, so that the method `exact` does not take it"};
  for (const double g : {1e-6, 1e-4, 1e-2}) {
    // F(g + rate s) at s = 1 from twelve terms; each term is about a twentieth of the previous one.
    std::array<double, 12> path{};
    path[0] = g;
    path[1] = 0.01 * g;
    double sum = 0.0;
    for (std::size_t n = 0; n < path.size(); ++n) sum += series->next({path.data(), n + 1});
    const double expected = force(*law, g + path[1]);
    if (!(std::abs(sum - expected) <= 1e-9 * std::abs(expected)))
      return {false,
              "at g = " + to_short_text(g) + " m the series gives " + to_text(sum) + " N, F is " + to_text(expected)};
  }
  return {true, "the Taylor series sums to the force"};
}

/// A mass hits a stop: it must regain the energy that it gave to the stop.
Finding check_rebound(const Subject& subject) {
  constexpr double kGap = 0.01;
  const auto law = make_law(subject);
  std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n"
      "[initial]\nvelocity = [{nodes = \"m\", value = 1.0}]\n"
      "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\nsides = \"positive\"\ngap = 0.01\nlaw = \"";
  scene += subject.name + "\"\n" + subject.keys;
  Bench bench(subject.catalogue, scene + integrator_table("dopri5", "tolerance = 1e-8\n", 1e-6, 0.5));
  const auto& report = bench.simulation().run();
  if (!report.completed) return {false, report.message};
  if (law->rate_dependence() != model::ContactLaw::RateDependence::none) {
    const double back = -bench.simulation().state().v[0];
    return {back >= 0.0 && back <= 1.0 + 1e-4, "thrown at 1 m/s it comes back with " + to_short_text(back) + " m/s"};
  }
  // A law with a residual force on an open stop stores a little of the energy.
  const double x = bench.simulation().state().x[0], v = bench.simulation().state().v[0];
  const double held = 2.0 * (law->energy(x - kGap) - law->energy(-kGap));
  return {std::abs(v * v + held - 1.0) <= 2e-4, "thrown at 1 m/s it comes back with " + to_short_text(-v) + " m/s"};
}

}  // namespace

/// Checks rated_force() and its derivatives in both branches, and that a dissipative law removes energy.
Finding check_rate(const Subject& subject) {
  using Dependence = model::ContactLaw::RateDependence;
  const auto law = make_law(subject);
  if (law->rate_dependence() == Dependence::none) return {true, "elastic"};
  if (law->is_piecewise_linear()) return {false, "is_piecewise_linear() belongs to elastic laws"};
  for (const double g : {1e-7, 1e-5, 1e-3, 1e-1})
    for (const double rate : {-3.0, -0.1, -1e-3, 0.0, 1e-3, 0.1, 3.0})
      for (const bool recedes : {false, true}) {
        const bool is_by_sense = law->rate_dependence() == Dependence::by_sense;
        if (is_by_sense ? recedes != (rate < 0.0) && rate != 0.0 : recedes) continue;
        const std::string where = "at g = " + to_short_text(g) + " m and g' = " + to_short_text(rate) + " m/s " +
                                  (recedes ? "receding, " : "");
        const auto at = law->rated_force(g, rate, recedes);
        if (!std::isfinite(at.force + at.by_penetration + at.by_rate))
          return {false, where + "the force is not finite"};
        const double elastic = force(*law, g), scale = std::abs(elastic) + std::abs(at.force);
        if (rate == 0.0 && !(std::abs(at.force - elastic) <= 1e-12 * scale))
          return {false, where + "F = " + to_text(at.force) + " and K_c g = " + to_text(elastic)};
        if (at.force >= 0.0 && (at.force - elastic) * rate < -1e-12 * scale * std::abs(rate))
          return {false, where + "it puts energy into the motion"};
        const double dg = kReach * g, dv = kReach * (std::abs(rate) + 1e-3);
        const double by_g =
            (law->rated_force(g + dg, rate, recedes).force - law->rated_force(g - dg, rate, recedes).force) /
            (2.0 * dg);
        const double by_v =
            (law->rated_force(g, rate + dv, recedes).force - law->rated_force(g, rate - dv, recedes).force) /
            (2.0 * dv);
        if (!(std::abs(by_g - at.by_penetration) <= kDifference * (std::abs(by_g) + scale / g)))
          return {false, where + "dF/dg = " + to_text(by_g) + " and by_penetration = " + to_text(at.by_penetration)};
        if (!(std::abs(by_v - at.by_rate) <= kDifference * (std::abs(by_v) + scale / (std::abs(rate) + 1e-3))))
          return {false, where + "dF/dg' = " + to_text(by_v) + " and by_rate = " + to_text(at.by_rate)};
      }
  return {true, "F(g, 0) = K_c g, the derivatives are those of differences, and the rate only dissipates"};
}

std::vector<Check> law_checks() {
  return {{"bounds", "force, stiffness and energy are finite, and a closed stop never pulls", check_bounds},
          {"derivatives", "the force is the slope of the energy, the tangent that of the force", check_derivatives},
          {"batches", "the loops over many stops give the values of single stops", check_batches},
          {"series", "a Taylor series, if there is one, sums to the force", check_series},
          {"rate", "the rate-dependent part dissipates, and has the stated slopes", check_rate},
          {"rebound", "a stop returns at most the energy it absorbed", check_rebound}};
}

}  // namespace butee::conformance
