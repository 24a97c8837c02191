#include "butee/dynamics/centre_pulls.hpp"

#include <cmath>

namespace butee::dynamics {

std::vector<CentrePull> centre_pulls(const Obstacles& obstacles) {
  std::vector<CentrePull> pulls;
  for (Index i = 0; i < obstacles.size(); ++i) {
    const model::ObstacleGroup& group = obstacles.group_of(i);
    if (group.shape == nullptr) continue;
    const model::ContactShape::Form form = group.shape->form();
    if (form.kind != model::ContactShape::Form::Kind::circle || form.sense < 0.0) continue;
    const double force = std::abs(group.law->secant(-form.distance)) * form.distance;
    if (force > 0.0) pulls.push_back({i, form.place, form.distance, force});
  }
  return pulls;
}

}  // namespace butee::dynamics
