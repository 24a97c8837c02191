#pragma once

#include <algorithm>
#include <vector>

#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/contact_newton.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// Bound of |int_0^1 (F - P F) e^(i x s) ds| for the force F of slope 1 behind any place of the step and its projection
/// P F: the impulse of a closing stop that the projection hides from a mode of angle x per step.
inline double unresolved_part(double x) {
  return std::min({7.5e-5 * x * x * x, 0.0172, 0.174 / x});
}

/// The same of a force that jumps by 1 behind any place of the step.
inline double unresolved_jump(double x) {
  return std::min({5.21e-4 * x * x * x, 0.1433, 2.0 / x});
}

/// The influence of a stop's force on its own path, which follows from the step size alone: the coupling, the inverse
/// of Newton's method while closed, and what the projection hides from the modes. Kept with the step size
/// (ContactPropagator).
class ContactInfluence {
 public:
  /// Both must outlive it; `orders` is the number of force moments.
  ContactInfluence(const dynamics::ModalSystem& modal, const std::vector<ContactForce>& contacts, std::size_t orders)
      : modal_(modal) {
    for (const ContactForce& contact : contacts) {
      stiffness_.push_back(contact.stiffness());
      newton_.emplace_back(contact.stiffness(), orders);
    }
  }

  using Known = dynamics::ContactPropagator::Derived;
  const Known& of(dynamics::ContactPropagator& flow, Index stop) const {
    const Known& known = flow.derived(stop);
    return known.is_known ? known : find(flow, stop);
  }
  /// sigma = (h omega_c)^2 of the stop alone.
  double stiff(dynamics::ContactPropagator& flow, Index stop) const {
    return stiffness_[static_cast<std::size_t>(stop)] * of(flow, stop).coupling[1][0];
  }
  /// h times the change of the speed of a stop that the projection of a force with a jump of 1 N hides from modes whose
  /// phases are independent, m/N.
  double hidden_by_jump(const dynamics::ContactPropagator& flow, Index stop) const {
    const auto shape = modal_.stop_shapes().of(stop).array();
    const auto angles = flow.h() * (modal_.frequencies().square() + 4.0 * modal_.decay().square()).sqrt();
    const auto parts = shape.square() * angles.unaryExpr([](double x) { return unresolved_jump(x); });
    return flow.h() * flow.h() * parts.matrix().norm();
  }
  const ContactNewton& newton(Index stop) const { return newton_[static_cast<std::size_t>(stop)]; }

 private:
  const Known& find(dynamics::ContactPropagator& flow, Index stop) const {
    Known& known = flow.derived(stop);
    known.coupling = flow.own_coupling(stop);
    known.inverse = newton(stop).closed_inverse(known.coupling);
    const auto shape = modal_.stop_shapes().of(stop).array();
    known.unresolved = (shape.square() * (flow.h() * modal_.frequencies()).unaryExpr([](double x) {
                         return unresolved_part(x);
                       })).sum();
    known.is_known = true;
    return known;
  }

  const dynamics::ModalSystem& modal_;
  std::vector<double> stiffness_;
  std::vector<ContactNewton> newton_;
};

}  // namespace butee::integrators
