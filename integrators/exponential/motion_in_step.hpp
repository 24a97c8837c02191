#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/modal_motion.hpp"
#include "integrators/exponential/breakpoints.hpp"
#include "integrators/exponential/contact_force.hpp"

namespace butee::integrators {

/// The motion of all modes at any instant of a step, under the loads and the projected forces of
/// the step. The force of a stop that changes its status, or whose residual force jumps, is
/// projected again over the part of the step up to that instant if outputs would show the
/// difference (plugins/exponential/THEORY.md, section 10).
class MotionInStep {
 public:
  /// All must outlive it.
  MotionInStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts,
               const Breakpoints& breakpoints);

  /// Starts a new macro step.
  void begin() {
    begun_ = kNone;
    kept_.clear();
  }
  /// Computes q and v at t in the step that begins at breakpoint `from`.
  void find(std::size_t from, double t);
  /// The same, and keeps them for further calls at t: a search for the peaks of many DOFs halves steps at the same
  /// instants.
  void find_and_keep(std::size_t from, double t);
  const double* q() const { return q_; }
  const double* v() const { return v_; }
  std::array<double, 3> products(const Vector& shape, const Vector& weight) const {
    return dynamics::ModalMotion::products(shape, weight, q_, v_);
  }

  /// cos and sin of the harmonic loads at t.
  std::span<const Phase> find_phases(double t);
  /// The forces of the stops at t, N; call find() for t before. nullptr if there are none.
  const Vector* find_forces(std::size_t from, double t);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Contact {
    Index stop;
    ContactPath path;
    ForceMoments moments;
  };
  void find_contacts(std::size_t from);

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  std::vector<ContactForce>& contacts_;
  const Breakpoints& breakpoints_;
  dynamics::ModalMotion motion_;
  const double *q_ = nullptr, *v_ = nullptr;
  std::unordered_map<double, std::size_t> kept_;  ///< instants and their places in kept_motion_
  std::size_t most_kept_;
  std::vector<double> kept_motion_;  ///< q and v, padded, of each
  std::size_t begun_ = kNone;        ///< the breakpoint at which motion_ begins
  std::vector<Contact> closed_;      ///< closed stops, whose force is given by the moments
  std::vector<Contact> changing_;    ///< stops whose force is projected again
  Vector compliances_;               ///< compliance of each stop for short times, |phi|^2, 1/kg
  Vector forces_;
  std::vector<Phase> phases_;
};

}  // namespace butee::integrators
