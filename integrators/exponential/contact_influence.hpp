#pragma once

#include <vector>

#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/contact_newton.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// The influence of a stop's force on its own path, which depends on the step size only: the
/// coupling matrix, the inverse of Newton's matrix for a closed stop, and the impulse error of the
/// projection. Cached with the step size (ContactPropagator).
class ContactInfluence {
 public:
  /// Both must outlive it.
  ContactInfluence(const dynamics::ModalSystem& modal, const std::vector<ContactForce>& contacts)
      : modal_(modal), rates_((modal.frequencies().square() + 4.0 * modal.decay().square()).sqrt()) {
    for (const ContactForce& contact : contacts) newton_.emplace_back(contact.stiffness());
  }

  using Known = dynamics::ContactPropagator::Derived;
  const Known& of(dynamics::ContactPropagator& flow, Index stop) const {
    const Known& known = flow.derived(stop);
    return known.is_known ? known : find(flow, stop);
  }
  /// The speed errors of the modes due to the projection of a force with a jump of 1 N at a stop, s/kg^(1/2).
  void hidden_by_jump(const dynamics::ContactPropagator& flow, Index stop, Eigen::ArrayXd& speeds) const {
    speeds = flow.h() * modal_.stop_shapes().of(stop).array() *
             (flow.h() * rates_).unaryExpr([](double x) { return unresolved_jump(x); });
  }
  const ContactNewton& newton(Index stop) const { return newton_[static_cast<std::size_t>(stop)]; }

 private:
  const Known& find(dynamics::ContactPropagator& flow, Index stop) const {
    Known& known = flow.derived(stop);
    known.coupling = flow.own_coupling(stop);
    known.inverse = newton(stop).closed_inverse(known.coupling);
    const auto shape = modal_.stop_shapes().of(stop).array();
    known.unresolved =
        (shape.square() * (flow.h() * rates_).unaryExpr([](double x) { return unresolved_part(x); })).sum();
    known.is_known = true;
    return known;
  }

  const dynamics::ModalSystem& modal_;
  /// (omega^2 + 4 delta^2)^(1/2) of the modes, rad/s: damped modes count as if they turned as fast as they decay, n.
  Eigen::ArrayXd rates_;
  std::vector<ContactNewton> newton_;
};

}  // namespace butee::integrators
