#include "contact/ring.hpp"

#include "contact/laws.hpp"

namespace butee::contact {

model::ContactType ring_type() {
  return {"ring",
          "circular clearance in the plane (uy, uz)",
          {config::numbers("centre", "m", "the centre of the ring, [y, z]")
               .of_length(2)
               .or_else(config::Array{config::Value(0.0), config::Value(0.0)}),
           config::text("side", "where the body is: within the ring, or outside of a circle of radius gap")
               .one_of({"within", "outside"})
               .or_else("within")},
          [](const config::Parameters& p, double gap, config::Diagnostics&) -> std::unique_ptr<model::ContactShape> {
            const std::vector<double> centre = p.numbers("centre");
            return std::make_unique<Ring>(Eigen::Vector2d(centre[0], centre[1]), gap,
                                          p.text("side") == "within" ? Ring::Side::within : Ring::Side::outside);
          }};
}

}  // namespace butee::contact
