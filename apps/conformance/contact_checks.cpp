#include <cmath>
#include <vector>

#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

#include "apps/conformance/bench.hpp"

namespace butee::conformance {
namespace {

using Eigen::Vector2d;
using model::Approach;
using model::ContactShape;

constexpr double kFreePlay = 0.01;

/// The shape of an obstacle with the subject's keys and a gap of kFreePlay.
std::unique_ptr<ContactShape> make_shape(const Subject& subject) {
  const config::Document document = config::parse_toml(subject.keys, "the suite's contact");
  config::Diagnostics diagnostics(document);
  const auto* type = model::find_type(subject.catalogue.types().contacts, subject.name);
  const auto parameters = config::read_parameters(document.root, "contact[0]", type->parameters, diagnostics);
  diagnostics.throw_if_any();
  auto shape = type->make(*parameters, kFreePlay, diagnostics);
  diagnostics.throw_if_any();
  require(shape != nullptr, "the maker of a contact returns one");
  return shape;
}

/// Positions around the rest position, outside and inside the obstacle, along sixteen directions.
std::vector<Vector2d> places() {
  std::vector<Vector2d> all;
  for (int k = 0; k < 16; ++k)
    for (const double r : {0.001, 0.004, 0.011, 0.03}) {
      const double angle = 0.1 + k * 0.392699;
      all.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
  return all;
}

std::string text(const Vector2d& d) {
  return "(" + to_short_text(d[0]) + ", " + to_short_text(d[1]) + ")";
}

/// Step of finite differences, m, and their tolerance, for radii of curvature above a millimetre.
constexpr double kAside = 1e-7, kSlopeDifference = 1e-3;

Finding check_normal(const Subject& subject) {
  const auto shape = make_shape(subject);
  for (const Vector2d& d : places()) {
    const Approach at = shape->at(d);
    if (!std::isfinite(at.penetration + at.normal.sum() + at.curvature))
      return {false, "not finite at d = " + text(d) + " m"};
    if (!(std::abs(at.normal.norm() - 1.0) <= 1e-12))
      return {false, "at d = " + text(d) + " m the normal has the length " + to_text(at.normal.norm())};
    for (const Vector2d& direction : {Vector2d(1.0, 0.0), Vector2d(0.0, 1.0)}) {
      const Approach ahead = shape->at(d + kAside * direction), behind = shape->at(d - kAside * direction);
      // A corner lies between the two points.
      if ((ahead.normal - behind.normal).norm() > 0.1) continue;
      const double slope = (ahead.penetration - behind.penetration) / (2.0 * kAside);
      if (!(std::abs(slope - at.normal.dot(direction)) <= 1e-6))
        return {false, "at d = " + text(d) + " m the slope of g along " + text(direction) + " is " + to_text(slope) +
                           ", the normal there " + to_text(at.normal.dot(direction))};
    }
  }
  return {true, "dg/dd = normal, of length 1, at 64 places"};
}

Finding check_curvature(const Subject& subject) {
  const auto shape = make_shape(subject);
  for (const Vector2d& d : places()) {
    const Approach at = shape->at(d);
    const Vector2d tangent(-at.normal[1], at.normal[0]);
    const Vector2d ahead = shape->at(d + kAside * tangent).normal, behind = shape->at(d - kAside * tangent).normal;
    if ((ahead - behind).norm() > 0.1) continue;
    const double turned = (ahead - behind).dot(tangent) / (2.0 * kAside);
    if (!(std::abs(turned - at.curvature) <= kSlopeDifference * (1.0 + std::abs(at.curvature))))
      return {false, "at d = " + text(d) + " m the normal turns by " + to_text(turned) + " 1/m, curvature is " +
                         to_text(at.curvature)};
  }
  return {true, "the normal turns by the curvature at 64 places"};
}

/// form(), by which friction with a stick spring measures its path and which some methods expand.
Finding check_form(const Subject& subject) {
  using Kind = ContactShape::Form::Kind;
  const auto shape = make_shape(subject);
  const ContactShape::Form form = shape->form();
  if (form.kind == Kind::other) return {true, "neither a line nor a circle: no friction with a stick spring"};
  for (const Vector2d& d : places()) {
    const double expected = form.kind == Kind::line ? form.place.dot(d) - form.distance
                                                    : form.sense * ((d - form.place).norm() - form.distance);
    if (const double g = shape->at(d).penetration; !(std::abs(g - expected) <= 1e-12 * (1.0 + std::abs(g))))
      return {false, "at d = " + text(d) + " m g is " + to_text(g) + " m, form() gives " + to_text(expected)};
  }
  return {true, form.kind == Kind::line ? "a line" : "a circle"};
}

/// A mass moves inside the obstacle without dissipation: it must regain the energy that it gave to the
/// obstacle.
Finding check_energy(const Subject& subject) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\ndof = \"uy\"\nstiffness = 400.0\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"uz\"\nstiffness = "
      "300.0\n[initial]\nvelocity = [{nodes = \"m\", dof = \"uy\", value = 1.0}, {nodes = \"m\", dof = \"uz\", value = "
      "0.7}]\n[[contact]]\ntype = \"" +
      subject.name + "\"\nnodes = \"m\"\ngap = 0.01\nstiffness = 1e4\n" + subject.keys;
  Bench bench(subject.catalogue, scene + integrator_table("dopri5", "tolerance = 1e-8\n", 1e-6, 1.0));
  const time::State begin = bench.initial_state();
  const auto energy = [&](const time::State& state) {
    bench.dynamics().obstacles()->follow_live();
    return 0.5 * state.v.squaredNorm() + 200.0 * state.x[0] * state.x[0] + 150.0 * state.x[1] * state.x[1] +
           bench.dynamics().obstacles()->energy(state.t, state.x, state.v);
  };
  const double before = energy(begin);
  const auto& report = bench.simulation().run();
  if (!report.completed) return {false, report.message};
  const double after = energy(bench.simulation().state());
  return {std::abs(after - before) <= 1e-5 * (1.0 + std::abs(before)),
          "an energy of " + to_short_text(before) + " J is " + to_short_text(after) + " J after 1 s"};
}

}  // namespace

std::vector<Check> contact_checks() {
  return {{"normal", "the normal is the slope of the penetration, and has length 1", check_normal},
          {"curvature", "the curvature is the rotation of the normal along the tangent", check_curvature},
          {"form", "form(), if it is a line or a circle, gives the penetration", check_form},
          {"energy", "an elastic obstacle returns the energy it absorbed", check_energy}};
}

}  // namespace butee::conformance
