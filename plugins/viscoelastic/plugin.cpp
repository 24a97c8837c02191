#include <butee/plugin/entry.hpp>

#include "viscoelastic.hpp"

namespace {

using butee::config::Diagnostics;
using butee::config::number;
using butee::config::Parameters;

butee::model::LawType viscoelastic_type() {
  return {"viscoelastic",
          "Kuwabara and Kono's contact of viscoelastic spheres, k (g^(3/2) + 3/2 A sqrt(g) g')",
          {number("stiffness", "N/m^(3/2)", "k of Hertz's law").above(0),
           number("relaxation", "s", "A, the relaxation time of the material").at_least(0),
           number("reference", "m", "the penetration whose stiffness bounds steps").above(0).or_else(1e-4)},
          [](const Parameters& p, Diagnostics&) -> std::unique_ptr<butee::model::ContactLaw> {
            return std::make_unique<butee::plugins::Viscoelastic>(p.number("stiffness"), p.number("relaxation"),
                                                                  p.number("reference"));
          }};
}

}  // namespace

BUTEE_PLUGIN(registrar) {
  registrar.add(viscoelastic_type());
}
