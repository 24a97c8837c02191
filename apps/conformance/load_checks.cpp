#include <algorithm>
#include <array>
#include <cmath>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"

namespace butee::conformance {
namespace {

std::unique_ptr<model::TimeFunction> make_load(const Subject& subject) {
  const config::Document document = config::parse_toml(subject.keys, "the suite's load");
  config::Diagnostics diagnostics(document);
  const auto* type = model::find_type(subject.catalogue.types().loads, subject.name);
  const auto parameters = config::read_parameters(document.root, "load[0]", type->parameters, diagnostics);
  diagnostics.throw_if_any();
  auto load = type->make(*parameters, diagnostics);
  diagnostics.throw_if_any();
  require(load != nullptr, "the maker of a load returns one");
  return load;
}

/// Irregular instants from 0 to 10 s that avoid round numbers.
std::vector<double> instants() {
  std::vector<double> t;
  for (int i = 0; i < 400; ++i) t.push_back(0.025 * i + 0.0013 * std::sin(1.7 * i) + 0.0021);
  return t;
}

double largest(const model::TimeFunction& load) {
  double value = 0.0;
  for (const double t : instants()) value = std::max(value, std::abs(load.value(t)));
  return value;
}

/// True if no discontinuity lies in [t, t + h].
bool is_smooth(const model::TimeFunction& load, double t, double h) {
  const auto instants = load.discontinuities();
  return std::none_of(instants.begin(), instants.end(),
                      [&](double instant) { return instant >= t && instant <= t + h; });
}

/// A jump of the value and its place: half an interval after the other, always the one over which the value changes
/// more.
struct Jump {
  double t = 0.0, height = 0.0;
};
Jump jump_within(const model::TimeFunction& load, double begin, double end) {
  double first = load.value(begin), last = load.value(end);
  while (end - begin > 1e-12) {
    const double middle = 0.5 * (begin + end), value = load.value(middle);
    const bool is_first = std::abs(value - first) > std::abs(last - value);
    (is_first ? end : begin) = middle;
    (is_first ? last : first) = value;
  }
  return {begin, std::abs(last - first)};
}

Finding check_values(const Subject& subject) {
  const auto load = make_load(subject);
  Jump largest_jump;
  double before = 0.0;
  for (const double t : instants()) {
    if (!std::isfinite(load->value(t))) return {false, "not finite at t = " + to_short_text(t) + " s"};
    if (load->value(t) != load->value(t)) return {false, "another value at the same t = " + to_short_text(t) + " s"};
    if (load->vanishes() && load->value(t) != 0.0)
      return {false, "vanishes() is true and the value at " + to_short_text(t) + " s is not 0"};
    if (is_smooth(*load, before, t - before))
      if (const Jump jump = jump_within(*load, before, t); jump.height > largest_jump.height) largest_jump = jump;
    before = t;
  }
  if (largest_jump.height > 1e-3 * largest(*load))
    return {false, "jumps at t = " + to_short_text(largest_jump.t) + " s, which discontinuities() does not list"};
  return {true, "finite, largest value " + to_short_text(largest(*load)) + " in 10 s"};
}

Finding check_discontinuities(const Subject& subject) {
  const auto instants = make_load(subject)->discontinuities();
  for (const double instant : instants)
    if (!std::isfinite(instant)) return {false, "one of the instants is not finite"};
  if (!std::is_sorted(instants.begin(), instants.end())) return {false, "the instants do not ascend"};
  return {true, std::to_string(instants.size()) + " instants, ascending"};
}

Finding check_taylor(const Subject& subject) {
  const auto load = make_load(subject);
  std::array<double, 12> series{};
  if (!load->taylor(0.0, 1e-3, series))
    return {true, "none, so that the methods `exact` and `exponential` do not take it"};
  const double scale = largest(*load);
  for (const double t : instants()) {
    constexpr double kSpan = 1e-3;
    if (!is_smooth(*load, t, kSpan)) continue;
    if (!load->taylor(t, kSpan, series)) return {false, "a series at t = 0 and none at " + to_short_text(t) + " s"};
    double sum = 0.0;
    for (std::size_t k = series.size(); k-- > 0;) sum = 0.5 * sum + series[k];
    const double expected = load->value(t + 0.5 * kSpan);
    // Twelve terms over half a millisecond are exact to rounding for functions with time scales above some
    // tenths of a millisecond.
    if (!(std::abs(sum - expected) <= 1e-9 * scale))
      return {false, "from t = " + to_short_text(t) + " s the series gives " + to_text(sum) +
                         " half a millisecond later, value() " + to_text(expected)};
  }
  return {true, "the Taylor series sums to the value"};
}

/// Between two discontinuities the value has to be the parabola through three of its points.
Finding check_parabolas(const Subject& subject) {
  const auto load = make_load(subject);
  if (!load->is_piecewise_parabolic()) return {true, "not piecewise parabolic"};
  const double scale = largest(*load);
  double begin = 0.0;
  for (const double end : instants()) {
    const double h = end - begin, first = load->value(begin), middle = load->value(begin + 0.5 * h),
                 last = load->value(end);
    for (const double s : {0.25, 0.75}) {
      const double expected =
          first * (1.0 - s) * (1.0 - 2.0 * s) + middle * 4.0 * s * (1.0 - s) + last * s * (2.0 * s - 1.0);
      if (is_smooth(*load, begin, h) && !(std::abs(load->value(begin + s * h) - expected) <= 1e-9 * scale))
        return {false, "is_piecewise_parabolic() is true; at t = " + to_short_text(begin + s * h) + " s the value is " +
                           to_text(load->value(begin + s * h)) + ", the parabola through three points gives " +
                           to_text(expected)};
    }
    begin = end;
  }
  return {true, "parabolas between the discontinuities"};
}

Finding check_harmonic(const Subject& subject) {
  const auto load = make_load(subject);
  const auto harmonic = load->harmonic();
  if (!harmonic) return {true, "no pure harmonic"};
  for (const double t : instants()) {
    const double expected = harmonic->amplitude * std::cos(harmonic->angular_frequency * t + harmonic->phase);
    if (!(std::abs(expected - load->value(t)) <= 1e-10 * std::abs(harmonic->amplitude)))
      return {false, "harmonic() gives " + to_text(expected) + " at t = " + to_short_text(t) + " s, value() " +
                         to_text(load->value(t))};
  }
  return {true, "harmonic() is the value"};
}

/// A mass on a spring under the load, integrated by methods of which one sums the Taylor series, if there is one.
Finding check_loaded_motion(const Subject& subject) {
  std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\n"
      "stiffness = 900.0\n[initial]\ndisplacement = [{nodes = \"m\", value = 0.01}]\n[[load]]\nnode = \"m\"\ntype = \"";
  scene += subject.name + "\"\n" + subject.keys;
  Bench one(subject.catalogue, scene + integrator_table("rk4", "", 1e-4, 1.0));
  if (!one.simulation().run().completed) return {false, one.simulation().report().message};
  const double x = one.simulation().state().x[0];
  const double scale = std::abs(x) + std::abs(one.simulation().state().v[0]) / 30.0 + 0.01;
  std::string words = "a mass on a spring moves to " + to_short_text(x) + " m with rk4";
  bool is_good = true;
  std::array<double, 2> series{};
  for (const char* method : {"newmark_modified", "exact"}) {
    if (method == std::string("exact") && !make_load(subject)->taylor(0.0, 1e-3, series)) continue;
    Bench other(subject.catalogue, scene + integrator_table(method, "", 1e-4, 1.0));
    if (!other.simulation().run().completed) return {false, other.simulation().report().message};
    const double y = other.simulation().state().x[0];
    is_good = is_good && std::abs(x - y) <= 1e-3 * scale;
    words += ", " + to_short_text(y) + " m with " + method;
  }
  return {is_good, words};
}

}  // namespace

std::vector<Check> load_checks() {
  return {
      {"values", "finite, and jumps only at the instants of discontinuities()", check_values},
      {"discontinuities", "the discontinuities are ascending", check_discontinuities},
      {"series", "the Taylor series, if there is one, sums to the value", check_taylor},
      {"parabolas", "the value is a parabola between discontinuities, if is_piecewise_parabolic()", check_parabolas},
      {"harmonic", "harmonic(), if defined, equals the value", check_harmonic},
      {"motion", "the methods agree on the motion under the load", check_loaded_motion}};
}

}  // namespace butee::conformance
