#include "contact/plane.hpp"

#include <cmath>

#include "contact/laws.hpp"

namespace butee::contact {

model::ContactType plane_type() {
  return {"plane",
          "a straight wall in the plane (uy, uz)",
          {config::numbers("normal", "1", "the direction [y, z] into the wall, of any length").of_length(2)},
          [](const config::Parameters& p, double gap,
             config::Diagnostics& diagnostics) -> std::unique_ptr<model::ContactShape> {
            const std::vector<double> given = p.numbers("normal");
            const double length = std::hypot(given[0], given[1]);
            if (!(length > 0.0) || !std::isfinite(length)) {
              p.complain(diagnostics, "normal", "must point somewhere, such as [0, 1]");
              return nullptr;
            }
            return std::make_unique<Plane>(Eigen::Vector2d(given[0], given[1]) / length, gap);
          }};
}

}  // namespace butee::contact
