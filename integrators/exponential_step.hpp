#pragma once

#include <array>
#include <vector>

#include "butee/solve/modal_system.hpp"
#include "integrators/stop_path.hpp"

namespace butee::integrators {

/// The arithmetic of one step of the method `exponential`: the flow of the modes, and the forces and paths of the stops
/// within reach, found together by sweeps.
class ExponentialStep {
 public:
  /// `order` 2, 4 or 6. `tolerance` bounds the displacement in the middle of a step that the cubic through its ends
  /// does not explain, relative to the largest displacement of a stop so far.
  ExponentialStep(solve::Dynamics& dynamics, solve::ModalSystem& modal, int order, double tolerance);

  enum class Trial { accepted, too_long, not_finite };

  /// Takes the state at t, and the largest displacement so far.
  void begin(const double* q, const double* v, double scale);
  /// Tries a step from there; accept() makes its end the state.
  Trial attempt(solve::StepFlow& flow, double t);
  void accept();

  /// Without stops: takes the state along a flow.
  void follow(const solve::ModalFlow& flow, double t);

  const Eigen::ArrayXd& q() const { return q_; }
  const Eigen::ArrayXd& v() const { return v_; }
  double scale() const { return scale_; }
  /// No stop was within reach in the last attempt.
  bool is_quiet() const { return active_.empty(); }
  /// It would do with a longer step.
  bool is_easy() const;
  bool has_stops() const { return !stops_.empty(); }

 private:
  /// A stop within reach during a step.
  struct Active {
    Index stop;
    double w0, hv0;          ///< at the start
    double w1, hv1, middle;  ///< at the end and in the middle, with all forces found so far
    double bulge;            ///< by which the middle departs from the cubic through the ends
    ForceMoments force;
    StopForce::Course course;
  };
  struct Phase {
    double cosine, sine;
  };

  /// cos and sin of the harmonic loads at the start of a step.
  void note_phases(double t);
  void propagate(const solve::ModalFlow& flow, double t, bool with_speed, Eigen::ArrayXd& q, Eigen::ArrayXd& v) const;
  void find_stops();
  void find_active(const solve::StepFlow& flow, double t);
  void add_far_forces(const solve::StepFlow& flow);
  Trial iterate(solve::StepFlow& flow);
  /// Takes the active stops in turn, each with the forces of all others as they are; the largest change of a path.
  double sweep(solve::StepFlow& flow);
  void find_error(solve::StepFlow& flow);
  void apply_forces(const solve::StepFlow& flow);

  solve::ModalSystem& modal_;
  std::size_t orders_;  ///< polynomials that the force is projected onto
  double tolerance_;
  std::vector<StopForce> stops_;
  Eigen::ArrayXd gaps_, borders_;  ///< the latter: up to where the force of an open stop hardly changes
  bool has_far_forces_ = false;

  Eigen::ArrayXd q_, v_;
  Eigen::ArrayXd w_, wv_;  ///< displacements and speeds of the stops
  double scale_ = 0.0;
  std::vector<Phase> phases_;

  Eigen::ArrayXd q_new_, v_new_, q_half_, w_new_, wv_new_, reach_;
  std::vector<Active> active_;
  std::vector<Index> far_;
  Vector far_forces_;
  std::array<Eigen::ArrayXd, 3> sums_;
  double error_ = 0.0;
};

}  // namespace butee::integrators
