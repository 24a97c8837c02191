#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/modal_propagator.hpp"
#include "butee/linalg/dense_product.hpp"

namespace butee::dynamics {

namespace kernel {
struct StopResponse;
}

/// The modal shapes of the stops, Phi^T S^T, with their products.
class BUTEE_EXPORT StopShapes {
 public:
  StopShapes() = default;
  /// p modes x m stops.
  explicit StopShapes(Eigen::MatrixXd shapes);

  Index modes() const { return shapes_.rows(); }
  Index count() const { return shapes_.cols(); }
  const Eigen::MatrixXd& matrix() const { return shapes_; }
  auto of(Index stop) const { return shapes_.col(stop); }

  /// w := S Phi q
  void displacement(const double* q, double* w) const;
  /// The same for two vectors at once.
  void displacement(const double* q, const double* v, double* w, double* wv) const;
  /// r := Phi^T S^T f, where all but these entries of f are zero.
  void force(std::span<const Index> stops, const double* f, double* r) const;

 private:
  Eigen::MatrixXd shapes_;
  linalg::DenseProduct to_stops_, to_modes_;
};

/// What the stops do at the end and in the middle of a step, their forces included: displacement, speed times h,
/// displacement in the middle; an entry a stop, padded with zeros to ContactPropagator::padded().
struct StopMotion {
  Eigen::ArrayXd end, speed, middle;
};

/// The flow over a step and over its first half, and with them how stops act on each other.
class BUTEE_EXPORT ContactPropagator {
 public:
  /// `stops` must outlive it.
  ContactPropagator(ModalPropagator whole_flow, ModalPropagator half_flow, const StopShapes& stops,
                    const Eigen::ArrayXd& frequencies, const std::vector<ModalHarmonic>& harmonics);

  double h() const { return whole.h(); }

  /// The stops, rounded up to whole vector registers.
  static Index padded(Index stops);
  /// Where the register behind the one that begins at a stop begins.
  static Index next_register(Index begin);

  /// The displacements of stops over the step by a constant force of 1 N on each alone, m. Computed at their first use.
  const Eigen::ArrayXd& mobilities();

  /// What forces P_0, P_1, P_2 at stop i do to itself: rows end, speed and middle as in StopMotion.
  using Coupling = std::array<std::array<double, 3>, 3>;
  Coupling own_coupling(Index i);
  /// Room for what a method derives from it for each stop.
  struct Derived {
    bool is_known = false;
    Coupling coupling{};
    std::array<double, 9> inverse{};
    double unresolved = 0.0;
  };
  Derived& derived(Index i) { return derived_[static_cast<std::size_t>(i)]; }

  /// Adds what a force at stop i does to the stops in these registers, named by the stop that each begins at:
  /// the largest |end| + speed_weight |speed| + |middle| of it.
  double add_force(Index i, const std::array<double, 3>& force, double speed_weight, std::span<const Index> registers,
                   StopMotion& motion);

  /// Adds what forces at these stops do, an entry of `force` for each stop.
  void add_forces(std::span<const Index> stops, const std::array<Eigen::ArrayXd, 3>& force,
                  std::span<const Index> registers, StopMotion& motion);

  ModalPropagator whole, half;
  /// How far a mode with q and v at the start can carry any stop away from the cubic through both ends of its path.
  Eigen::ArrayXd swing_q, swing_v;
  /// The same of a modal force that does not change over the step, and of all harmonic loads together, m.
  Eigen::ArrayXd swing_force;
  double swing_harmonics = 0.0;

 private:
  /// The nine columns of stop i: end, speed and middle by P_0, then by P_1 and P_2. Computed at their first use.
  const Eigen::ArrayXXd& columns(Index i) {
    const Eigen::ArrayXXd& known = columns_[static_cast<std::size_t>(i)];
    return known.size() > 0 ? known : compute_columns(i);
  }
  const Eigen::ArrayXXd& compute_columns(Index i);

  const kernel::StopResponse* kernels_;
  const StopShapes& stops_;
  std::vector<Eigen::ArrayXXd> columns_;
  std::vector<Derived> derived_;
  Eigen::ArrayXd mobilities_;
};

}  // namespace butee::dynamics
