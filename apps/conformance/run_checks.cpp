#include <cmath>

#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"
#include "apps/conformance/integrator_checks.hpp"

namespace butee::conformance {
namespace {

/// Accepted difference relative to the peak; it allows for loose tolerances of adaptive methods and first
/// order across contact.
constexpr double kAgreement = 2e-3;

}  // namespace

Finding check_end_time(const Subject& subject) {
  Bench bench(subject.catalogue, rattling_beam(subject));
  const auto& report = bench.simulation().run();
  if (!report.completed) return {false, report.message};
  const bool holds = report.t_end == kEnd && bench.simulation().state().t == kEnd;
  return {holds, "ends at " + to_text(bench.simulation().state().t) + " s" + (holds ? "" : " instead of 0.02 s")};
}

Finding check_agreement(const Subject& subject) {
  Bench bench(subject.catalogue, rattling_beam(subject));
  Bench exact(subject.catalogue,
              rattling_beam(6, contact_law(subject), kRayleighDamping) + integrator_table("exact", "", kStep, kEnd));
  if (!bench.simulation().run().completed) return {false, bench.simulation().report().message};
  if (!exact.simulation().run().completed)
    return {false, "the reference failed: " + exact.simulation().report().message};
  const auto &x = bench.simulation().state().x, &reference = exact.simulation().state().x;
  const double error = (x - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
  return {error <= kAgreement, "differs by " + to_short_text(error) + " of the largest displacement, allowed 0.002"};
}

Finding check_overflow(const Subject& subject) {
  std::string scene = rattling_beam(6, kLinearLaw, kRayleighDamping);
  scene += "[[load]]\ntype = \"table\"\nnode = \"b:2\"\ntimes = [0.0, 1e-3, 1.001e-3]\nvalues = [0.0, 0.0, 1e308]\n";
  Bench bench(subject.catalogue, scene + integrator_table(subject, kStep, kEnd));
  const auto& report = bench.simulation().run();
  if (report.completed) return {false, "a load of 1e308 N went through unnoticed"};
  if (!bench.simulation().state().x.allFinite()) return {false, "accepted a state that is not finite"};
  return {report.steps > 0 && report.t_end < kEnd, "stopped: " + report.message};
}

Finding check_independence(const Subject& subject) {
  Bench alone(subject.catalogue, rattling_beam(subject)), one(subject.catalogue, rattling_beam(subject));
  Bench other(subject.catalogue, rattling_beam(10, kLinearLaw, "") + integrator_table(subject, 2.0 * kStep, kEnd));
  while (alone.simulation().advance() && alone.simulation().state().t < 0.5 * kEnd) {
  }
  while (one.simulation().advance() && one.simulation().state().t < 0.5 * kEnd) other.simulation().advance();
  const bool holds = alone.simulation().state().x == one.simulation().state().x;
  return {holds, holds ? "two alternating simulations, the same bits as alone"
                       : "a second simulation changes the result: the simulations share state"};
}

Finding check_skipped_contact(const Subject& subject) {
  std::string scene = rattling_beam(6, kLinearLaw, kRayleighDamping);
  const std::size_t begin = scene.find("[[contact]]");
  scene.erase(begin, scene.find("[[load]]") - begin);
  Bench bench(subject.catalogue, scene + integrator_table(subject, kStep, kEnd));
  if (!bench.simulation().run().completed) return {false, bench.simulation().report().message};
  const auto evaluations = bench.dynamics().counters().contact_evaluations;
  return {evaluations == 0, std::to_string(evaluations) + " contact evaluations in a scene without stops"};
}

std::vector<Check> integrator_checks() {
  return {{"order", "equal steps of forced, damped motion converge in x and v with the declared order", check_order},
          {"stability", "undamped oscillation and a braked mass stay bounded up to the declared limits, and not beyond",
           check_stability},
          {"purity", "a step depends only on its state and length", check_purity},
          {"restart", "a new integrator continues bit for bit", check_restart},
          {"interpolation", "the interpolant meets both ends of a step", check_interpolation},
          {"end", "a run ends at end_time exactly", check_end_time},
          {"agreement", "a beam that strikes its stops moves as with the method `exact`", check_agreement},
          {"overflow", "non-finite values are never accepted, and a run that meets them ends with a message",
           check_overflow},
          {"allocation", "a step allocates no memory after the first use of its length", check_allocation},
          {"independence", "simulations share no state", check_independence},
          {"no stops", "a scene without stops evaluates no contact", check_skipped_contact}};
}

}  // namespace butee::conformance
