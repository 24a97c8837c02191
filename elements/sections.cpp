#include <algorithm>
#include <cmath>
#include <numbers>

#include "elements/elements.hpp"

namespace butee::elements {
namespace {

using config::Diagnostics;
using config::number;
using config::Parameters;
using model::Section;
using model::SectionType;
using model::ShearFactor;
using std::numbers::pi;

/// A = pi (ro^2 - ri^2), I = pi/4 (ro^4 - ri^4), J = 2 I and, with m = ri/ro, the shear factor
/// 6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2) of G. R. Cowper, J. Appl. Mech. 33 (1966) 335.
Section annulus(double ro, double ri) {
  const double second_moment = pi / 4.0 * (std::pow(ro, 4) - std::pow(ri, 4)), m2 = ri * ri / (ro * ro);
  const double n = (1.0 + m2) * (1.0 + m2);
  const ShearFactor shear{6.0 * n, 6.0 * n, 7.0 * n + 20.0 * m2, 6.0 * n + 12.0 * m2};
  Section section{pi * (ro * ro - ri * ri), second_moment, ro};
  section.second_moment_y = second_moment;
  section.outer_fibre_z = ro;
  section.torsion_constant = 2.0 * second_moment;
  section.torsion_modulus = section.torsion_constant / ro;
  section.shear_factor_y = section.shear_factor_z = shear;
  return section;
}

/// J = a^3 b (1/3 - 0.21 a/b (1 - a^4/(12 b^4))) with a the shorter side, W. C. Young, Roark's Formulas, table 10.1.
double torsion_constant_of_rectangle(double one, double other) {
  const double a = std::min(one, other), b = std::max(one, other), r = a / b;
  return a * a * a * b * (1.0 / 3.0 - 0.21 * r * (1.0 - r * r * r * r / 12.0));
}

SectionType tube() {
  return {"tube",
          "hollow circle",
          {number("outer_radius", "m", "the outer radius").above(0),
           number("inner_radius", "m", "the inner radius").at_least(0)},
          [](const Parameters& p, Diagnostics& diagnostics) -> std::optional<Section> {
            const double ro = p.number("outer_radius"), ri = p.number("inner_radius");
            if (ri < ro) return annulus(ro, ri);
            p.complain(diagnostics, "inner_radius", "must be smaller than outer_radius");
            return std::nullopt;
          }};
}

SectionType circle() {
  return {"circle",
          "solid circle",
          {number("radius", "m", "the radius").above(0)},
          [](const Parameters& p, Diagnostics&) -> std::optional<Section> { return annulus(p.number("radius"), 0.0); }};
}

SectionType rectangle() {
  return {"rectangle",
          "solid rectangle, bending in the plane about its width",
          {number("width", "m", "the width, along z: the axis of bending in the plane").above(0),
           number("height", "m", "the height, along y").above(0)},
          [](const Parameters& p, Diagnostics&) -> std::optional<Section> {
            const double b = p.number("width"), h = p.number("height");
            constexpr ShearFactor kShear{5.0 / 6.0};
            Section section{b * h, b * h * h * h / 12.0, 0.5 * h};
            section.second_moment_y = h * b * b * b / 12.0;
            section.outer_fibre_z = 0.5 * b;
            section.torsion_constant = torsion_constant_of_rectangle(b, h);
            section.shear_factor_y = section.shear_factor_z = kShear;
            return section;
          }};
}

/// The value of an optional key, 0 if it is absent.
double number_or_zero(const Parameters& p, const char* key) {
  return p.has(key) ? p.number(key) : 0.0;
}

std::optional<Section> make_general(const Parameters& p, Diagnostics& diagnostics) {
  if (p.has("second_moment") == p.has("second_moment_z")) {
    p.complain(diagnostics, "second_moment",
               p.has("second_moment") ? "and second_moment_z are two names of one number; give one of them"
                                      : "missing; give second_moment (number, m4), of bending along u");
    return std::nullopt;
  }
  Section section{p.number("area"), p.number(p.has("second_moment") ? "second_moment" : "second_moment_z"),
                  number_or_zero(p, "outer_fibre")};
  section.second_moment_y = number_or_zero(p, "second_moment_y");
  section.outer_fibre_z = number_or_zero(p, "outer_fibre_z");
  section.torsion_constant = number_or_zero(p, "torsion_constant");
  section.shear_factor_y = {number_or_zero(p, "shear_factor_y")};
  section.shear_factor_z = {number_or_zero(p, "shear_factor_z")};
  return section;
}

SectionType general() {
  const auto optional = [](const char* name, const char* unit, const char* help) {
    return number(name, unit, help).above(0).optional();
  };
  return {"general",
          "area and moments given directly",
          {number("area", "m2", "the area").above(0),
           optional("second_moment", "m4", "the second moment of area about z, of bending along u"),
           optional("second_moment_z", "m4", "another name of second_moment"),
           optional("second_moment_y", "m4", "the second moment of area about y, of bending along w"),
           optional("torsion_constant", "m4", "the torsion constant J"),
           optional("shear_factor_y", "1", "the shear factor of shear along y"),
           optional("shear_factor_z", "1", "the shear factor of shear along z"),
           optional("outer_fibre", "m", "the distance of the outer fibre from the neutral axis along y, for stresses"),
           optional("outer_fibre_z", "m", "the same along z")},
          make_general};
}

}  // namespace

std::vector<SectionType> section_types() {
  return {tube(), circle(), rectangle(), general()};
}

}  // namespace butee::elements
