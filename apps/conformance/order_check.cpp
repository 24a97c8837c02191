#include <cmath>

#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"
#include "apps/conformance/integrator_checks.hpp"

namespace butee::conformance {
namespace {

/// Largest difference between the measured and the declared order.
constexpr double kOrderTolerance = 0.05;
/// Errors below this fraction of the motion are rounding errors.
constexpr double kRounding = 1e-13;

/// m x'' + c x' + k x = F cos(w t + phi) from (x0, v0): damped and forced; samples do not coincide with
/// periods.
struct ForcedOscillator {
  double m = 2.0, c = 1.5, k = 110.0, F = 7.0, w = 4.1, phi = 0.4, x0 = 0.3, v0 = -1.2, end = 1.71;

  std::string scene() const {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
           "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 110.0\ndamping = 1.5\n"
           "[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 7.0\nangular_frequency = 4.1\nphase = 0.4\n"
           "[initial]\ndisplacement = [{nodes = \"m\", value = 0.3}]\nvelocity = [{nodes = \"m\", value = -1.2}]\n";
  }

  /// x and v at t: the steady-state part plus the decaying free part.
  std::pair<double, double> exact(double t) const {
    const double a = k - m * w * w, b = c * w, size = F / (a * a + b * b);
    const auto steady = [&](double s) { return size * (a * std::cos(w * s + phi) + b * std::sin(w * s + phi)); };
    const auto steady_v = [&](double s) { return size * w * (-a * std::sin(w * s + phi) + b * std::cos(w * s + phi)); };
    const double d = c / (2.0 * m), wd = std::sqrt(k / m - d * d);
    const double p = x0 - steady(0.0), q = (v0 - steady_v(0.0) + d * p) / wd;
    const double e = std::exp(-d * t), cs = std::cos(wd * t), sn = std::sin(wd * t);
    return {steady(t) + e * (p * cs + q * sn), steady_v(t) + e * ((-d * p + wd * q) * cs + (-d * q - wd * p) * sn)};
  }
};

struct Errors {
  double x = 0.0, v = 0.0;
};

/// Root sum of squares over ten samples, so that a zero of the error at one instant does not matter.
Errors errors_of(const Subject& subject, int steps) {
  const ForcedOscillator problem;
  const double h = problem.end / steps;
  Bench bench(subject.catalogue, problem.scene() + integrator_table(subject, h, problem.end), accept_all(subject));
  time::State from = bench.initial_state(), to;
  Errors errors;
  for (int i = 1; i <= steps; ++i) {
    const auto report = bench.integrator().step(from, {h, i * h, true}, to);
    if (report.status != time::StepStatus::ok || to.t != i * h) return {NAN, NAN};
    std::swap(from, to);
    if (i % (steps / 10) != 0) continue;
    const auto [x, v] = problem.exact(from.t);
    errors.x += std::pow(from.x[0] - x, 2);
    errors.v += std::pow(from.v[0] - v, 2);
  }
  return {std::sqrt(errors.x), std::sqrt(errors.v)};
}

}  // namespace

Finding check_order(const Subject& subject) {
  const auto& declaration = subject.catalogue.find(subject.name)->declaration;
  if (declaration.order == 0.0 && !declaration.fixed_step) return {true, "not declared"};
  // A method of high order reaches rounding with more steps.
  const int steps = declaration.order > 6.0 ? 30 : 200;
  const Errors coarse = errors_of(subject, steps), fine = errors_of(subject, 2 * steps);
  if (!std::isfinite(coarse.x + fine.x + coarse.v + fine.v))
    return {false, "one of " + std::to_string(2 * steps) + " equal steps was refused or cut short"};
  if (fine.x < kRounding && fine.v < kRounding) return {true, "only rounding errors"};
  const double x = std::log2(coarse.x / fine.x), v = std::log2(coarse.v / fine.v);
  std::string measured = to_short_text(x) + " in x, " + to_short_text(v) + " in v";
  if (declaration.order == 0.0) return {true, measured + "; not declared"};
  const bool holds =
      std::abs(x - declaration.order) <= kOrderTolerance && std::abs(v - declaration.order) <= kOrderTolerance;
  return {holds, measured + "; declared " + to_short_text(declaration.order)};
}

}  // namespace butee::conformance
