#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"
#include "apps/conformance/integrator_checks.hpp"

namespace butee::conformance {
namespace {

constexpr int kSteps = 10000;
/// Just inside a declared limit, and well outside; the limit itself is measured by `butee stability`.
constexpr double kInside = 0.98, kOutside = 1.5;
/// The step that is tested where no limit is declared, in h omega or h c/m.
constexpr double kLong = 1e3;
/// The largest motion of the last half of the steps over that of the first, if motion is bounded.
constexpr double kBounded = 1.5;

/// A mass of 1 kg with one of the two: its rate, omega or c/m, is 1 per s.
constexpr const char* kSpring = "stiffness = 1.0\n";
constexpr const char* kDashpot = "stiffness = 0.0\ndamping = 1.0\n";

/// The largest |x| or |v| in the last half of kSteps steps of length h from x = 1 m, v = 1 m/s, over that in the first;
/// infinite if a step fails, and empty if the method takes shorter steps of its own choice.
std::optional<double> growth_of(const Subject& subject, const char* part, double h) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\n" +
      std::string(part) +
      "[initial]\ndisplacement = [{nodes = \"m\", value = 1.0}]\nvelocity = [{nodes = \"m\", value = 1.0}]\n";
  Bench bench(subject.catalogue, scene + integrator_table(subject, h, kSteps * h), accept_all(subject));
  time::State from = bench.initial_state(), to;
  std::array<double, 2> largest{};
  for (int i = 1; i <= kSteps; ++i) {
    const time::StepReport report = bench.integrator().step(from, {h, i * h, true}, to);
    if (report.status != time::StepStatus::ok) return INFINITY;
    if (to.t < i * h) return std::nullopt;
    // A step that error control would reject may come without its acceleration.
    if (const auto* controller = bench.integrator().controller();
        controller != nullptr && !controller->decide(h, report).accept)
      bench.dynamics().acceleration(to.t, to.x, to.v, to.a);
    const double motion = std::max(std::abs(to.x[0]), std::abs(to.v[0]));
    if (!(motion < 1e100)) return INFINITY;
    double& of_half = largest[2 * i > kSteps ? 1 : 0];
    of_half = std::max(of_half, motion);
    std::swap(from, to);
  }
  return largest[1] / largest[0];
}

/// Compares one limit with its declaration.
Finding check_limit(const Subject& subject, const char* part, double declared, const std::string& name) {
  const bool has_limit = std::isfinite(declared);
  const double inside = has_limit ? kInside * declared : kLong;
  const auto stable = growth_of(subject, part, inside);
  if (!stable) return {true, name + ": the method takes shorter steps of its own choice"};
  if (!(*stable <= kBounded))
    return {false, "grows without bound at " + name + " = " + to_short_text(inside) + "; declared " +
                       (has_limit ? to_short_text(declared) : "stable at every step")};
  if (!has_limit) return {true, name + ": no limit"};
  const auto unstable = growth_of(subject, part, kOutside * declared);
  if (unstable && *unstable <= kBounded)
    return {false, "stays bounded at " + name + " = " + to_short_text(kOutside * declared) + "; declared " +
                       to_short_text(declared) + ", which makes runs refuse steps that are stable"};
  return {true, name + " up to " + to_short_text(declared)};
}

}  // namespace

Finding check_stability(const Subject& subject) {
  const auto& declaration = subject.catalogue.find(subject.name)->declaration;
  const Finding undamped = check_limit(subject, kSpring, declaration.stability_limit, "h omega");
  if (!undamped.passed) return undamped;
  const Finding dashpot = check_limit(subject, kDashpot, declaration.damping_limit, "h c/m");
  return {dashpot.passed, dashpot.passed ? undamped.details + ", " + dashpot.details : dashpot.details};
}

}  // namespace butee::conformance
