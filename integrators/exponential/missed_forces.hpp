#pragma once

#include <vector>

#include "integrators/exponential/component_speeds.hpp"
#include "integrators/exponential/contact_force.hpp"

namespace butee::integrators {

/// Bound of |int_0^1 P_k e^(i x s) ds| for k >= 3: the part of a force P_k, which the projection leaves out, that a
/// mode would receive whose phase advances by x (rad) in the step (plugins/exponential/constants.py).
inline double unresolved_rest(double x) {
  constexpr double kOfCubic = 1.0 / 840.0, kMostOfRest = 0.25, kFastOfRest = 2.4;
  return std::min({kOfCubic * x * x * x, kMostOfRest, kFastOfRest / x});
}

/// Bound of the part of a unit impulse, constant over the step, that such a mode receives.
inline double received_impulse(double x) {
  return std::min(1.0, 2.0 / x);
}

/// The errors of the velocities of all components by the part of the stops' forces that their projections miss,
/// and by the errors of their paths (indicator 10 of plugins/exponential/THEORY.md, section 8.1).
///
/// The other indicators hold these errors below the tolerance of the stop's own speed. Other components may be slower:
/// rotations near supports, and all of them at the onset of a first contact. Checked in
/// tests/models/exponential_velocities_test.cpp.
class MissedForces {
 public:
  /// All must outlive it.
  MissedForces(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts, ComponentSpeeds& speeds);

  /// Begins a macro step.
  void begin();
  /// Begins an attempt at a step.
  void attempt();
  /// Adds the force of a stop along a path; `speed` is the largest speed of the stop so far, m/s, and `impulse` the
  /// error of its impulse by that of the path, N s.
  void add(Index stop, const ContactPath& path, double speed, double impulse);
  /// The largest velocity error in a step of length h, s, from a state with the modal speeds `v`, relative to the scale
  /// of the component; errors above `enough` are found with scales that include `v`.
  double error(double h, const Eigen::ArrayXd& v, double enough);

 private:
  struct Stop {
    double speed = 0.0;  ///< the response is that to a reflection with up to this speed, m/s
    Vector response;     ///< velocities of the components per speed of the stop
    bool counts = false;
  };

  /// Raises the least scales to a part of the velocities after a reflection of the stop.
  void expect(Index stop, double speed);
  /// The response to an impulse that changes the speed of the stop by 1, of modes that are not faster than a contact
  /// with that speed.
  void find_response(Index stop, double speed);
  void find_weights();

  const dynamics::ModalSystem& modal_;
  std::vector<ContactForce>& contacts_;
  ComponentSpeeds& speeds_;
  Eigen::ArrayXd rates_;            ///< (omega^2 + 4 delta^2)^(1/2) of the modes, rad/s
  Eigen::ArrayXd impulse_;          ///< errors of the modal impulses, kg^(1/2) m/s
  Eigen::ArrayXd cubic_, quartic_;  ///< what the projections leave out of the modal forces, N/kg^(1/2)
  std::vector<Stop> stops_;
  Vector least_;  ///< least scales of the components, m/s or rad/s
  Eigen::ArrayXd
      weights_;  ///< of each mode: the largest velocity of a component, relative to its scale, by modal speed
  bool are_known_ = false;               ///< weights_ are those of the present scales
  Eigen::ArrayXd of_impulse_, of_rest_;  ///< received_impulse() and h unresolved_rest() for steps of received_h_
  double received_h_ = 0.0;              ///< s
};

}  // namespace butee::integrators
