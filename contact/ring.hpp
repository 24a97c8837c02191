#pragma once

#include "butee/model/obstacle.hpp"

namespace butee::contact {

/// A circle: g = |d - centre| - gap for a body within it, gap - |d - centre| for one outside.
///
/// In one direction it is a pair of stops, g = |d| - gap.
class Ring final : public model::ContactShape {
 public:
  enum class Side { within, outside };

  /// `centre` and `gap` in m.
  Ring(const Eigen::Vector2d& centre, double gap, Side side = Side::within)
      : centre_(centre), gap_(gap), sense_(side == Side::within ? 1.0 : -1.0) {}

  model::Approach at(const Eigen::Vector2d& d) const override {
    const Eigen::Vector2d arm = d - centre_;
    const double r = arm.norm();
    // At the centre every direction is normal to the circle.
    if (r == 0.0) return {-sense_ * gap_, {sense_, 0.0}, 0.0};
    return {sense_ * (r - gap_), sense_ / r * arm, r < kLeaving * gap_ ? 0.0 : sense_ / r};
  }
  Form form() const override { return {Form::Kind::circle, centre_, gap_, sense_}; }

 private:
  /// A body this near to the centre, in gaps, is about to leave it along the normal (time/departure.hpp): the direction
  /// of its force does not turn.
  static constexpr double kLeaving = 1e-90;

  Eigen::Vector2d centre_;
  double gap_, sense_;
};

}  // namespace butee::contact
