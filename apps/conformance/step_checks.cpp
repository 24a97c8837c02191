#include <cmath>

#include <butee/core/text.hpp>

#include "apps/conformance/allocation_count.hpp"
#include "apps/conformance/bench.hpp"
#include "apps/conformance/integrator_checks.hpp"

namespace butee::conformance {
namespace {

using time::State;
using time::StepStatus;

Bench beam(const Subject& subject) {
  return {subject.catalogue, rattling_beam(subject)};
}

/// Takes this number of steps, but stops at the middle of the run.
void advance(Bench& bench, int steps) {
  for (int i = 0; i < steps && bench.simulation().state().t < 0.5 * kEnd; ++i)
    if (!bench.simulation().advance()) return;
}

/// "" if two states are bitwise equal, otherwise the first difference.
std::string difference(const State& a, const State& b) {
  if (a.t != b.t) return "t " + to_text(a.t) + " and " + to_text(b.t);
  for (const auto& [name, one, other] :
       {std::tuple("x", &a.x, &b.x), std::tuple("v", &a.v, &b.v), std::tuple("a", &a.a, &b.a),
        std::tuple("memory", &a.memory, &b.memory), std::tuple("contact", &a.contact, &b.contact)}) {
    if (one->size() != other->size()) return std::string(name) + " has another length";
    if (*one != *other)
      return std::string(name) + " differs by up to " + to_short_text((*one - *other).cwiseAbs().maxCoeff());
  }
  return "";
}

/// difference() between a run in whose midst dissipative contacts are closed and one that is restored from there; ""
/// for methods that refuse such contacts.
std::string difference_after_restoring_contacts(const Subject& subject) {
  const std::string damping = "damping = { type = \"kelvin_voigt\", coefficient = 10.0 }\n",
                    scene = rattling_beam(6, kLinearLaw + damping, kRayleighDamping) +
                            integrator_table(subject, kStep, kEnd);
  if (!takes(subject, scene)) return "";
  Bench bench(subject.catalogue, scene), fresh(subject.catalogue, scene);
  advance(bench, 2000);
  fresh.simulation().restore(bench.simulation().snapshot());
  for (Bench* one : {&bench, &fresh})
    for (int i = 0; i < 20; ++i) one->simulation().advance();
  return difference(bench.simulation().state(), fresh.simulation().state());
}

}  // namespace

Finding check_purity(const Subject& subject) {
  Bench bench = beam(subject);
  advance(bench, 50);
  const State from = bench.simulation().state();
  State first, other, again;
  bench.integrator().step(from, {kStep, from.t + kStep}, first);
  for (const double h : {2e-5, 7e-6, 1e-7}) bench.integrator().step(first, {h, first.t + h}, other);
  bench.integrator().step(from, {kStep, from.t + kStep}, again);
  const std::string found = difference(first, again);
  return {found.empty(), found.empty() ? "the same bits after other steps"
                                       : "the same step from the same state, after others: " + found +
                                             ". Keep the memory of a method in State::memory"};
}

Finding check_restart(const Subject& subject) {
  Bench bench = beam(subject), fresh = beam(subject);
  advance(bench, 200);
  const State from = bench.simulation().state();
  State continued, restarted;
  bench.integrator().step(from, {3e-6, from.t + 3e-6}, continued);
  fresh.integrator().step(from, {3e-6, from.t + 3e-6}, restarted);
  std::string found = difference(continued, restarted);
  if (found.empty()) found = difference_after_restoring_contacts(subject);
  return {found.empty(), found.empty() ? "the same bits from a new integrator"
                                       : "a new integrator continues differently from the same state: " + found +
                                             ". Keep the memory of a method in State::memory"};
}

Finding check_interpolation(const Subject& subject) {
  Bench bench = beam(subject);
  advance(bench, 20);
  const State from = bench.simulation().state();
  State to;
  if (bench.integrator().step(from, {kStep, from.t + kStep}, to).status != StepStatus::ok)
    return {false, "a step of 1e-5 s failed"};
  const Index dof = bench.dof("b:middle");
  // The ends are reproduced up to the rounding of the interpolation weights.
  constexpr double kRounding = 1e-13;
  for (const State* end : {&from, static_cast<const State*>(&to)}) {
    double x = 0.0, v = 0.0, a = 0.0;
    bench.integrator().dense_output(from, to).interpolate(end->t, {&dof, 1}, {{&x, 1}, {&v, 1}, {&a, 1}});
    for (const auto& [name, got, expected] :
         {std::tuple("x", x, end->x[dof]), std::tuple("v", v, end->v[dof]), std::tuple("a", a, end->a[dof])})
      if (!(std::abs(got - expected) <= kRounding * std::abs(expected)))
        return {false, std::string("at an end of the step ") + name + " is " + to_text(got) + " instead of " +
                           to_text(expected)};
  }
  return {true, "meets both ends of a step"};
}

Finding check_allocation(const Subject& subject) {
  if (allocation_count() < 0) return {true, "not counted under the sanitizers"};
  const std::string law = contact_law(subject);
  // Modal damping of every mode gives the large system a dense matrix; that of two modes gives a sparse
  // matrix plus a low-rank one.
  for (const auto& [elements, damping] :
       {std::pair(6, "mass_proportional = 0.5\n"), std::pair(100, "mass_proportional = 0.5\n"),
        std::pair(6, "modal = 0.02\n"), std::pair(100, "modal = 0.02\n"), std::pair(100, "modal = [0.02, 0.01]\n")}) {
    const std::string scene = rattling_beam(elements, law, damping) + integrator_table(subject, 1e-6, 1.0);
    if (elements > 6 && !takes(subject, scene)) continue;
    Bench bench(subject.catalogue, scene);
    for (int i = 0; i < 20; ++i)
      if (!bench.simulation().advance() && !bench.simulation().report().completed)
        return {false, bench.simulation().report().message};
    const State begin = bench.simulation().state();
    State from, to;
    const auto take_steps = [&] {
      from = begin;
      for (int i = 0; i < 100; ++i) {
        bench.integrator().step(from, {1e-6, from.t + 1e-6}, to);
        std::swap(from, to);
      }
    };
    // Repeat the same steps: caches (for example for the parts of a step with many contact changes) grow at
    // their first use, and a warning that needs fifteen such steps in a row is issued once.
    take_steps();
    take_steps();
    const long before = allocation_count();
    take_steps();
    if (const long made = allocation_count() - before; made > 0)
      return {false, std::to_string(made) + " allocations in 100 steps of a beam of " + std::to_string(elements) +
                         " elements with " + damping};
  }
  return {true, "none in 100 steps of five scenes"};
}

}  // namespace butee::conformance
