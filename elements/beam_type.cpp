#include <algorithm>
#include <functional>
#include <numeric>

#include "elements/beam.hpp"

namespace butee::elements {
namespace {

using config::Diagnostics;
using config::Parameters;
using model::NodeId;
using Motion = BeamOptions::Motion;

constexpr double kMostElements = 5e6;
/// Tolerance for parallel directions: rounding of coordinates written by hand.
constexpr double kParallel = 1e-9;

std::vector<double> even_coordinates(double length, Index elements) {
  std::vector<double> x(static_cast<std::size_t>(elements) + 1);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = length * static_cast<double>(i) / static_cast<double>(elements);
  return x;
}

Eigen::Vector3d along(const Parameters& p) {
  const Eigen::MatrixXd points = p.matrix("points");
  return (points.row(1) - points.row(0)).transpose();
}

model::ElementType::Nodes read_coordinates(const Parameters& p, Diagnostics& diagnostics) {
  if (p.has("coordinates")) {
    for (const char* key : {"length", "elements", "points"})
      if (p.has(key)) {
        p.complain(diagnostics, "coordinates",
                   std::string("replaces length and elements, or points; remove it or ") + key);
        break;
      }
    auto x = p.numbers("coordinates");
    if (x.size() < 2) p.complain(diagnostics, "coordinates", "must hold at least two coordinates");
    if (std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end())
      p.complain(diagnostics, "coordinates", "must ascend: every coordinate larger than the one before");
    return x;
  }
  if (p.has("points")) {
    if (p.has("length")) p.complain(diagnostics, "points", "replaces length; remove one of the two");
    if (!p.has("elements"))
      p.complain(diagnostics, "elements", "missing; give the number of elements between the points");
    if (!(along(p).norm() > 0.0)) p.complain(diagnostics, "points", "are one point; a beam has two ends");
    return p.has("elements") ? even_coordinates(along(p).norm(), p.integer("elements")) : std::vector<double>{};
  }
  for (const char* key : {"length", "elements"})
    if (!p.has(key)) p.complain(diagnostics, key, "missing; give length and elements, or coordinates");
  if (!p.has("length") || !p.has("elements")) return std::vector<double>{};
  return even_coordinates(p.number("length"), p.integer("elements"));
}

/// The axes of a beam between two points: x along it, y in the plane of x and `up`.
std::optional<Eigen::Matrix3d> read_axes(const Parameters& p, Diagnostics& diagnostics) {
  if (!p.has("points")) {
    if (p.given("up")) p.complain(diagnostics, "up", "belongs to points, which are not given");
    return Eigen::Matrix3d::Identity();
  }
  const auto given = p.numbers("up");
  const Eigen::Vector3d x = along(p).normalized(), up = Eigen::Vector3d(given[0], given[1], given[2]);
  const Eigen::Vector3d z = x.cross(up);
  if (!(z.norm() > kParallel * up.norm())) {
    p.complain(diagnostics, p.given("up") ? "up" : "points",
               p.given("up") ? "is parallel to the beam, so it does not orient the section; give another direction"
                             : "lie along y, the default of up, which orients the section; give up, such as [0, 0, 1]");
    return std::nullopt;
  }
  Eigen::Matrix3d axes;
  axes.col(0) = x;
  axes.col(2) = z.normalized();
  axes.col(1) = axes.col(2).cross(x);
  return axes;
}

/// Reports section or material data that are missing for the motion and the theory.
bool is_complete(const Parameters& p, const model::Section& section, const model::Material& material,
                 const BeamOptions& options, Diagnostics& diagnostics) {
  const auto errors = diagnostics.error_count();
  const std::string motion = "motion = \"" + p.text("motion") + "\"";
  if (options.motion != Motion::planar && section.second_moment_y == 0.0)
    p.complain(diagnostics, "section", "has no second_moment_y, which " + motion + " needs");
  if (options.motion == Motion::spatial && section.torsion_constant == 0.0)
    p.complain(diagnostics, "section", "has no torsion_constant, which " + motion + " needs");
  const bool has_shear = options.theory == BeamTheory::timoshenko;
  if ((options.motion == Motion::spatial || has_shear) && material.shear_modulus == 0.0)
    p.complain(diagnostics, "material",
               "has neither poisson_ratio nor shear_modulus; " +
                   (has_shear ? std::string("theory = \"timoshenko\"") : motion) + " needs one of them");
  for (const auto& [factor, name] :
       {std::pair(section.shear_factor_y, "shear_factor_y"), std::pair(section.shear_factor_z, "shear_factor_z")}) {
    const bool is_asked = name == std::string("shear_factor_y") || options.motion != Motion::planar;
    if (has_shear && is_asked && factor.a == 0.0)
      p.complain(diagnostics, "section", std::string("has no ") + name + ", which theory = \"timoshenko\" needs");
  }
  return diagnostics.error_count() == errors;
}

std::unique_ptr<model::Element> make_beam(const Parameters& p, model::ElementContext& context) {
  const auto material = context.material(p, "material");
  const auto section = context.section(p, "section");
  const std::vector<double> x = read_coordinates(p, context.diagnostics()).value();
  BeamOptions options;
  const std::string &motion = p.text("motion"), &theory = p.text("theory");
  options.motion = motion == "planar" ? Motion::planar : motion == "lateral" ? Motion::lateral : Motion::spatial;
  options.theory = theory == "euler"      ? BeamTheory::euler
                   : theory == "rayleigh" ? BeamTheory::rayleigh
                                          : BeamTheory::timoshenko;
  options.preload_of_gravity = p.value("preload").text() != nullptr;
  if (options.preload_of_gravity && options.motion != Motion::spatial) {
    p.complain(context.diagnostics(), "preload",
               "needs the axial displacement of the static position: write motion = \"spatial\", or give the axial "
               "force in N");
    return nullptr;
  }
  if (!options.preload_of_gravity) options.preload = p.number("preload");
  const auto axes = read_axes(p, context.diagnostics());
  if (axes) options.axes = *axes;
  if (axes && options.motion != Motion::spatial && !axes->isIdentity(kParallel)) {
    p.complain(context.diagnostics(), "points",
               "do not lie along x with up = [0, 1, 0], so a beam between them moves in all directions: write "
               "motion = \"spatial\"");
    return nullptr;
  }
  if (axes && axes->isIdentity(kParallel)) options.axes.setIdentity();
  std::vector<NodeId> nodes(x.size());
  std::iota(nodes.begin(), nodes.end(), context.own_node());
  if (p.has("points") && axes) context.place(nodes.front(), p.matrix("points").row(0).transpose(), options.axes.col(0));
  for (const auto& [key, own] : {std::pair("start_node", nodes.front()), std::pair("end_node", nodes.back())}) {
    if (!p.has(key)) continue;
    const auto shared = context.node(p, key);
    if (!shared) return nullptr;
    if (*shared >= nodes.front() && *shared <= nodes.back()) {
      p.complain(context.diagnostics(), key, "must be a node of another element");
      return nullptr;
    }
    context.join(*shared, own);
  }
  if (!material || !section || !axes || !is_complete(p, *section, *material, options, context.diagnostics()))
    return nullptr;
  return std::make_unique<Beam>(*material, *section, std::move(nodes), x, options);
}

}  // namespace

model::ElementType beam_type() {
  using config::integer, config::matrix, config::number, config::numbers, config::text;
  return {"beam",
          "straight beam: cubic shape functions, consistent mass; in the plane (DOFs u and theta), in two planes or in "
          "space",
          {text("material", "the [material.NAME]"), text("section", "the [section.NAME]"),
           text("motion", "planar: uy rz; lateral: both planes; spatial: all six DOFs")
               .one_of({"planar", "lateral", "spatial"})
               .or_else("planar"),
           text("theory", "euler: Euler-Bernoulli; rayleigh: with rotary inertia; timoshenko: with shear too")
               .one_of({"euler", "rayleigh", "timoshenko"})
               .or_else("euler"),
           number("length", "m", "the length along x, divided evenly").above(0).optional(),
           integer("elements", "the number of elements").at_least(1).at_most(kMostElements).optional(),
           numbers("coordinates", "m", "the nodes of an uneven mesh along x, ascending").optional(),
           matrix("points", "m", "instead of length, both ends in space", 2, 3).optional(),
           numbers("up", "1", "with points, a direction in the plane of the beam's own axes x and y")
               .of_length(3)
               .or_else(config::Array{config::Value(0.0), config::Value(1.0), config::Value(0.0)}),
           number("preload", "N",
                  "the constant axial force, tension positive; gravity: that of the static position under [gravity]")
               .one_of({"gravity"})
               .or_else(0.0),
           text("start_node", "a node of another element that is this beam's first").optional(),
           text("end_node", "a node of another element that is this beam's last").optional()},
          read_coordinates,
          make_beam};
}

}  // namespace butee::elements
