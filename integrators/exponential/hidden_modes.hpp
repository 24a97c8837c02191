#pragma once

#include <array>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/modal_system.hpp"

namespace butee::integrators {

/// Modes that hardly move any stop, as those of another plane or of a part without stops. Steps are as long as the
/// motion of the stops allows, and may last many periods of such modes; outputs between breakpoints then need parts.
class HiddenModes {
 public:
  /// `tolerance`: error bound of outputs, relative to the displacement scale.
  HiddenModes(const dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, double tolerance);

  bool any() const { return !modes_.empty(); }

  /// Polynomials through the motion at both ends of a part: through displacements and speeds, or accelerations as well.
  enum class Through { speeds, accelerations };
  /// The modal state at an instant.
  struct State {
    double t;
    const double *q, *v;
  };
  /// The number of equal parts of a step on which such polynomials represent the hidden modes.
  int parts(const State& from, const State& to, Through polynomial) const;

 private:
  struct Mode {
    Index index;
    double rate;  ///< 1/s: the fastest change of its motion, by itself, its decay or a harmonic load
  };
  /// The number of parts for the displacements or the rotations, whose largest value in each mode is given.
  double parts(const State& from, const State& to, Through polynomial, const Eigen::ArrayXd& sizes) const;

  std::vector<Mode> modes_;
  std::array<Eigen::ArrayXd, 2> sizes_;  ///< largest displacement and largest rotation of each mode
  double allowed_;                       ///< error between breakpoints, relative to the motion of all modes
};

}  // namespace butee::integrators
