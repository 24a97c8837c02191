#pragma once

#include <map>
#include <memory>
#include <vector>

#include "butee/dynamics/contact_propagator.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

class Dynamics;

/// A system in the modes of its linear part, its stops open: x = Phi q, Phi^T M Phi = 1.
///
/// Each mode is an oscillator of its own, q_i'' + 2 delta_i q_i' + omega_i^2 q_i = phi_i^T (F(t) + F_c), with the flow
/// over a step known exactly. Flows are kept on a ladder of steps, h = 2^(level/2) s, of which two neighbouring ones
/// differ by sqrt(2), and for a few other lengths.
class BUTEE_EXPORT ModalSystem {
 public:
  /// Systems up to this size take all their modes.
  static constexpr Index kAllModes = 600;

  /// A truncated basis is given the static shapes of so many stops and loads at most.
  static constexpr Index kMostStaticShapes = 300;

  /// `count` modes, the lowest; 0: all of them up to kAllModes, else kAllModes/2. Where those are not all, the static
  /// shapes of stops and loads are added (static_shapes.hpp). Throws InputError where dashpots or other damping couple
  /// the modes, or they could not be computed. `dynamics` must outlive it.
  ModalSystem(Dynamics& dynamics, Index count);

  Index size() const { return frequencies_.size(); }
  Index stop_count() const { return stop_shapes_.count(); }
  bool is_complete() const { return size() == shapes_.rows(); }

  const Eigen::ArrayXd& frequencies() const { return frequencies_; }  ///< omega, rad/s
  const Eigen::ArrayXd& decay() const { return decay_; }              ///< delta, 1/s
  const Eigen::MatrixXd& shapes() const { return shapes_; }           ///< Phi, n x p
  const Eigen::MatrixXd& shape_rows() const { return rows_; }         ///< Phi^T, p x n: a column for each DOF
  const StopShapes& stop_shapes() const { return stop_shapes_; }      ///< Phi^T S^T, p x m
  /// omega of the last one that is a mode, rad/s
  double highest_mode() const { return frequencies_[size() - static_count_ - 1]; }
  /// The shapes among them that are no modes, but the static response of those left out.
  Index static_count() const { return static_count_; }
  /// The largest share of the static displacement of a stop or a load under its own force that the modes left out
  /// carry as static shapes. 0 with all modes; without static shapes it is not known.
  double truncation() const { return truncation_; }

  void to_modal(ConstVectorRef x, Eigen::Ref<Eigen::VectorXd> q) const;
  void to_physical(const double* q, VectorRef x) const;

  /// Loads that are no harmonics: modal shape times a course in time.
  struct OtherLoad {
    const model::TimeFunction* in_time;
    Eigen::ArrayXd shape;
  };
  const std::vector<ModalHarmonic>& harmonics() const { return harmonics_; }
  const std::vector<OtherLoad>& other_loads() const { return other_loads_; }
  /// r += Phi^T F(t)
  void add_load(double t, Eigen::Ref<Eigen::ArrayXd> r) const;

  /// Takes the loads and laws that the system of `dynamics` has now; the modes stay.
  void replace_loads(const Dynamics& dynamics);

  static double grid_step(int level);
  /// The flow over grid_step(level).
  ContactPropagator& propagator(int level);
  /// The flow over any other length. Kept until several others have been asked for.
  ContactPropagator& odd(double h);

 private:
  void add_static(const model::System& system, Modes& modes);
  void find_decay(Dynamics& dynamics);
  void project_loads(const Dynamics& dynamics);
  void project_stops(const Contact& contact);
  ModalPropagator refined_propagator(int level);
  const ModalPropagator& raw_propagator(int level);

  Eigen::ArrayXd frequencies_, decay_;
  Eigen::MatrixXd shapes_, rows_, weighted_;
  linalg::DenseProduct fast_shapes_;
  StopShapes stop_shapes_;
  std::vector<ModalHarmonic> harmonics_;
  std::vector<OtherLoad> other_loads_;
  Index static_count_ = 0;
  double truncation_ = 0.0;

  struct GridStep {
    std::unique_ptr<ModalPropagator> raw;
    std::unique_ptr<ContactPropagator> step;
  };
  std::map<int, GridStep> grid_;
  std::vector<std::unique_ptr<ContactPropagator>> odd_;
  std::size_t oldest_ = 0;
};

}  // namespace butee::dynamics
