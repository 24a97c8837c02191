#include "contact/arctan.hpp"

#include "contact/laws.hpp"

namespace butee::contact {

model::LawType arctan_type() {
  return {"arctan",
          "regularised stop: F = k_c/2 [2/pi atan(pi lambda g) + 1] g",
          {config::number("stiffness", "N/m", "the stiffness k_c of the closed stop").above(0),
           config::number("regularization", "1/m", "lambda, the inverse width of the transition").above(0)},
          [](const config::Parameters& p, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
            return std::make_unique<Arctan>(p.number("stiffness"), p.number("regularization"));
          }};
}

}  // namespace butee::contact
