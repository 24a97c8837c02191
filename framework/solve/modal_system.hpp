#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "butee/solve/contact.hpp"
#include "butee/solve/dense_product.hpp"
#include "butee/solve/modal_flow.hpp"

namespace butee::solve {

class Dynamics;

/// The flow over a step and over its first half, and with them how stops act on each other.
class BUTEE_EXPORT StepFlow {
 public:
  /// `stop_shapes` (p x m) must outlive it.
  StepFlow(ModalFlow whole_flow, ModalFlow half_flow, const Eigen::MatrixXd& stop_shapes,
           const Eigen::ArrayXd& frequencies, const std::vector<ModalHarmonic>& harmonics);

  double h() const { return whole.h(); }

  /// What a force P_k at stop j does to stop i: displacement and speed at the end, displacement in the middle.
  struct Coupling {
    std::array<double, 3> end, speed, middle;
  };
  /// Computed at its first use.
  const Coupling& coupling(Index i, Index j) {
    const std::int32_t place = places_[static_cast<std::size_t>(i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i)];
    return place >= 0 ? couplings_[static_cast<std::size_t>(place)] : compute_coupling(std::max(i, j), std::min(i, j));
  }

  ModalFlow whole, half;
  /// How far a mode with q and v at the start can carry any stop away from the cubic through both ends of its path.
  Eigen::ArrayXd swing_q, swing_v;
  /// The same of a modal force that does not change over the step, and of all harmonic loads together, m.
  Eigen::ArrayXd swing_force;
  double swing_harmonics = 0.0;

 private:
  const Coupling& compute_coupling(Index i, Index j);

  const Eigen::MatrixXd& stop_shapes_;
  std::vector<std::int32_t> places_;  ///< in couplings_, of i >= j by rows; -1: not computed yet
  std::vector<Coupling> couplings_;
};

/// A system in the modes of its linear part, its stops open: x = Phi q, Phi^T M Phi = 1.
///
/// Each mode is an oscillator of its own, q_i'' + 2 delta_i q_i' + omega_i^2 q_i = phi_i^T (F(t) + F_c), with the flow
/// over a step known exactly. Flows are kept on a ladder of steps, h = 2^(level/2) s, of which two neighbouring ones
/// differ by sqrt(2), and for a few other lengths.
class BUTEE_EXPORT ModalSystem {
 public:
  /// Systems up to this size take all their modes.
  static constexpr Index kAllModes = 600;

  /// `count` modes, the lowest; 0: all of them up to kAllModes, else kAllModes/2. Throws InputError where dashpots or
  /// other damping couple the modes, or they could not be computed. `dynamics` must outlive it.
  ModalSystem(Dynamics& dynamics, Index count);

  Index size() const { return frequencies_.size(); }
  Index stop_count() const { return stop_shapes_.cols(); }
  bool is_complete() const { return size() == shapes_.rows(); }

  const Eigen::ArrayXd& frequencies() const { return frequencies_; }   ///< omega, rad/s
  const Eigen::ArrayXd& decay() const { return decay_; }               ///< delta, 1/s
  const Eigen::MatrixXd& shapes() const { return shapes_; }            ///< Phi, n x p
  const Eigen::MatrixXd& shape_rows() const { return rows_; }          ///< Phi^T, p x n: a column for each DOF
  const Eigen::MatrixXd& stop_shapes() const { return stop_shapes_; }  ///< Phi^T S^T, p x m: a column for each stop
  /// The largest share of a static displacement of a stop under its own force that the modes left out would carry; 0
  /// with all modes.
  double truncation() const { return truncation_; }

  void to_modal(ConstVectorRef x, Eigen::Ref<Eigen::VectorXd> q) const;
  void to_physical(const double* q, VectorRef x) const;
  /// w := S Phi q
  void stop_displacement(const double* q, double* w) const;

  /// Loads that are no harmonics: modal shape times a course in time.
  struct OtherLoad {
    const model::TimeFunction* in_time;
    Eigen::ArrayXd shape;
  };
  const std::vector<ModalHarmonic>& harmonics() const { return harmonics_; }
  const std::vector<OtherLoad>& other_loads() const { return other_loads_; }
  /// r += Phi^T F(t)
  void add_load(double t, Eigen::Ref<Eigen::ArrayXd> r) const;

  static double ladder_step(int level);
  /// The flow over ladder_step(level).
  StepFlow& ladder(int level);
  /// The flow over any other length. Kept until several others have been asked for.
  StepFlow& odd(double h);

 private:
  void find_decay(Dynamics& dynamics);
  void project_loads(const Dynamics& dynamics);
  void project_stops(Dynamics& dynamics);
  ModalFlow refined_ladder(int level);
  const ModalFlow& raw_ladder(int level);

  Eigen::ArrayXd frequencies_, decay_;
  Eigen::MatrixXd shapes_, rows_, weighted_, stop_shapes_;
  DenseProduct fast_shapes_, fast_stops_;
  std::vector<ModalHarmonic> harmonics_;
  std::vector<OtherLoad> other_loads_;
  double truncation_ = 0.0;

  struct Rung {
    std::unique_ptr<ModalFlow> raw;
    std::unique_ptr<StepFlow> step;
  };
  std::map<int, Rung> rungs_;
  std::vector<std::unique_ptr<StepFlow>> odd_;
  std::size_t oldest_ = 0;
};

}  // namespace butee::solve
