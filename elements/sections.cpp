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
using std::numbers::pi;

/// A = pi (ro^2 - ri^2), I = pi/4 (ro^4 - ri^4)
Section annulus(double ro, double ri) {
  return {pi * (ro * ro - ri * ri), pi / 4.0 * (std::pow(ro, 4) - std::pow(ri, 4)), ro};
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
          "solid rectangle, bending about its width",
          {number("width", "m", "the width, along the axis of bending").above(0),
           number("height", "m", "the height, in the plane of bending").above(0)},
          [](const Parameters& p, Diagnostics&) -> std::optional<Section> {
            const double b = p.number("width"), h = p.number("height");
            return Section{b * h, b * h * h * h / 12.0, 0.5 * h};
          }};
}

SectionType general() {
  return {
      "general",
      "area and second moment given directly",
      {number("area", "m2", "the area").above(0), number("second_moment", "m4", "the second moment of area").above(0),
       number("outer_fibre", "m", "the distance of the outer fibre from the neutral axis, for stresses")
           .above(0)
           .optional()},
      [](const Parameters& p, Diagnostics&) -> std::optional<Section> {
        return Section{p.number("area"), p.number("second_moment"),
                       p.has("outer_fibre") ? p.number("outer_fibre") : 0.0};
      }};
}

}  // namespace

std::vector<SectionType> section_types() {
  return {tube(), circle(), rectangle(), general()};
}

}  // namespace butee::elements
