#pragma once

#include "butee/model/obstacle.hpp"

namespace butee::contact {

/// A straight wall: g = normal . d - gap. In one direction it is a one-sided stop.
class Plane final : public model::ContactShape {
 public:
  /// `normal` of length 1 points into the wall; `gap` in m.
  Plane(const Eigen::Vector2d& normal, double gap) : normal_(normal), gap_(gap) {}

  model::Approach at(const Eigen::Vector2d& d) const override { return {normal_.dot(d) - gap_, normal_, 0.0}; }
  Form form() const override { return {Form::Kind::line, normal_, gap_, 1.0}; }

 private:
  Eigen::Vector2d normal_;
  double gap_;
};

}  // namespace butee::contact
