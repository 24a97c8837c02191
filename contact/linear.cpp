#include "contact/linear.hpp"

#include "contact/laws.hpp"

namespace butee::contact {

model::LawType linear_type() {
  return {"linear",
          "exact unilateral spring: F = k_c max(g, 0)",
          {config::number("stiffness", "N/m", "the stiffness k_c of the closed stop").above(0)},
          [](const config::Parameters& p, config::Diagnostics&) -> std::unique_ptr<model::ContactLaw> {
            return std::make_unique<Linear>(p.number("stiffness"));
          }};
}

}  // namespace butee::contact
