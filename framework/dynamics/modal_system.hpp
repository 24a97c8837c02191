#pragma once

#include <map>
#include <memory>
#include <vector>

#include "butee/dynamics/contact_propagator.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

class Dynamics;

/// A system in the modes of its linear part, with open stops: x = Phi q, Phi^T M Phi = 1.
///
/// Each mode is an independent oscillator, q_i'' + 2 delta_i q_i' + omega_i^2 q_i = phi_i^T (F(t) +
/// F_c), whose propagator over a step is exact. Propagators are kept on a geometric step-size grid,
/// h = 2^(level/2) s, where neighbouring steps differ by a factor of sqrt(2), and for a few other
/// lengths.
class BUTEE_EXPORT ModalSystem {
 public:
  /// Systems up to this size use all their modes.
  static constexpr Index kAllModes = 600;

  /// The largest number of stops and loads whose static shapes are added to a truncated basis.
  static constexpr Index kMostStaticShapes = 300;

  /// `count` is the number of lowest modes; 0: all of them up to kAllModes, else kAllModes/2. If
  /// those are not all modes, the static shapes of stops and loads are added (static_shapes.hpp).
  /// Throws InputError if dashpots or other damping couple the modes, or they could not be
  /// computed. `dynamics` must outlive this object.
  ModalSystem(Dynamics& dynamics, Index count);

  Index size() const { return frequencies_.size(); }
  Index stop_count() const { return stop_shapes_.count(); }
  bool is_complete() const { return size() == shapes_.rows(); }

  const Eigen::ArrayXd& frequencies() const { return frequencies_; }  ///< omega, rad/s
  const Eigen::ArrayXd& decay() const { return decay_; }              ///< delta, 1/s
  const Eigen::MatrixXd& shapes() const { return shapes_; }           ///< Phi, n x p
  const Eigen::MatrixXd& shape_rows() const { return rows_; }         ///< Phi^T, p x n: a column for each DOF
  const StopShapes& stop_shapes() const { return stop_shapes_; }      ///< Phi^T S^T, p x m
  /// omega of the last column that is a mode, rad/s
  double highest_mode() const { return frequencies_[size() - static_count_ - 1]; }
  /// The number of columns that are not modes but static responses of the omitted modes.
  Index static_count() const { return static_count_; }
  /// The largest fraction of the static displacement of a stop or a load under its own force that
  /// the omitted modes contribute as static shapes. 0 with all modes; not known without static
  /// shapes.
  double truncation() const { return truncation_; }

  void to_modal(ConstVectorRef x, Eigen::Ref<Eigen::VectorXd> q) const;
  void to_physical(const double* q, VectorRef x) const;

  /// Loads that are not harmonics: modal shape times a function of time.
  struct OtherLoad {
    const model::TimeFunction* in_time;
    Eigen::ArrayXd shape;
  };
  const std::vector<ModalHarmonic>& harmonics() const { return harmonics_; }
  const std::vector<OtherLoad>& other_loads() const { return other_loads_; }
  /// r += Phi^T F(t)
  void add_load(double t, Eigen::Ref<Eigen::ArrayXd> r) const;

  /// Takes the present loads and laws of the system of `dynamics`; the modes are kept.
  void replace_loads(const Dynamics& dynamics);

  static double grid_step(int level);
  /// The contact propagator over grid_step(level).
  ContactPropagator& propagator(int level);
  /// The contact propagator over any other length. Kept until several other lengths have been asked
  /// for.
  ContactPropagator& odd(double h);

 private:
  void add_static(const model::System& system, Modes& modes);
  void find_decay(Dynamics& dynamics);
  void project_loads(const Dynamics& dynamics);
  void project_stops(const ElasticStops& contact);
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
