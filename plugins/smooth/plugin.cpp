#include <butee/plugin/entry.hpp>

#include "smooth.hpp"

namespace {

using butee::config::Diagnostics;
using butee::config::number;
using butee::config::Parameters;

butee::model::LawType smooth_type() {
  return {"smooth",
          "no force while open, a smooth transition of given width, linear beyond",
          {number("stiffness", "N/m", "k_c of the closed stop").above(0),
           number("width", "m", "width of the transition, from g = 0").above(0)},
          [](const Parameters& p, Diagnostics&) -> std::unique_ptr<butee::model::ContactLaw> {
            return std::make_unique<butee::plugins::Smooth>(p.number("stiffness"), p.number("width"));
          }};
}

}  // namespace

BUTEE_PLUGIN(registrar) {
  registrar.add(smooth_type());
}
