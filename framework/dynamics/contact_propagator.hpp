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

/// The modal shapes of the stops, Phi^T S^T, and products with them.
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
  /// The same for q and v at once.
  void displacement(const double* q, const double* v, double* w, double* wv) const;
  /// r := Phi^T S^T f, with f zero outside these entries.
  void force(std::span<const Index> stops, const double* f, double* r) const;

 private:
  Eigen::MatrixXd shapes_;
  linalg::DenseProduct to_stops_, to_modes_;
};

/// Displacement w at the end of a step, h times the velocity there, and w in the middle of the
/// step, including the effect of the stop forces. One entry per stop, padded with zeros to
/// ContactPropagator::padded().
struct StopMotion {
  Eigen::ArrayXd end, speed, middle;
};

/// The modal propagators over a step and over its first half, and the compliance between the stops
/// over the step.
class BUTEE_EXPORT ContactPropagator {
 public:
  /// `stops` must outlive this object.
  ContactPropagator(ModalPropagator whole_flow, ModalPropagator half_flow, const StopShapes& stops,
                    const Eigen::ArrayXd& frequencies, const std::vector<ModalHarmonic>& harmonics);

  double h() const { return whole.h(); }

  /// The number of stops, rounded up to whole vector registers.
  static Index padded(Index stops);
  /// The first stop of the vector register after the one that begins at `begin`.
  static Index next_register(Index begin);

  /// The displacement of each stop over the step by a constant force of 1 N on that stop alone, m.
  /// Computed at the first use.
  const Eigen::ArrayXd& mobilities();

  /// The response of stop i to forces P_0, P_1, P_2 on itself: rows end, speed and middle as in
  /// StopMotion.
  using Coupling = std::array<std::array<double, 3>, 3>;
  Coupling own_coupling(Index i);
  /// Storage for the quantities that a method derives from the propagator for each stop.
  struct Derived {
    bool is_known = false;
    Coupling coupling{};
    std::array<double, 9> inverse{};
    double unresolved = 0.0;
  };
  Derived& derived(Index i) { return derived_[static_cast<std::size_t>(i)]; }

  /// Adds the response to a force at stop i for the stops in these registers; a register is named
  /// by its first stop. Returns the largest |end| + speed_weight |speed| + |middle| of that
  /// response.
  double add_force(Index i, const std::array<double, 3>& force, double speed_weight, std::span<const Index> registers,
                   StopMotion& motion);

  /// Adds the response to forces at these stops; `force` has an entry for every stop.
  void add_forces(std::span<const Index> stops, const std::array<Eigen::ArrayXd, 3>& force,
                  std::span<const Index> registers, StopMotion& motion);

  ModalPropagator whole, half;
  /// Bounds, per unit q and per unit v of a mode at the start, on the departure of any stop's path
  /// from the cubic through both of its ends.
  Eigen::ArrayXd swing_q, swing_v;
  /// The same per unit of a constant modal force, per unit of LoadParabola::bend() of one, and for all harmonic loads
  /// together, m.
  Eigen::ArrayXd swing_force, swing_bend;
  double swing_harmonics = 0.0;

 private:
  /// The nine columns of stop i: end, speed and middle by P_0, then by P_1 and P_2. Computed at the
  /// first use.
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
