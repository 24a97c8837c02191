#include "contact/hertz.hpp"

#include "contact/laws.hpp"

namespace butee::contact {

model::LawType hertz_type() {
  return {"hertz",
          "F = k g^n for g > 0: bodies with curved surfaces",
          {config::number("stiffness", "N/m^n", "the factor k").above(0),
           config::number("exponent", "1", "n; 3/2 for contact of two bodies in a point").at_least(1).or_else(1.5)},
          [](const config::Parameters& p, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
            return std::make_unique<Hertz>(p.number("stiffness"), p.number("exponent"));
          }};
}

}  // namespace butee::contact
