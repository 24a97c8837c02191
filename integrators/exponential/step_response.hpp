#pragma once

#include <vector>

#include "integrators/exponential/lanes.hpp"
#include "integrators/exponential/modal_response.hpp"

namespace butee::integrators {

/// The responses at all nodes of a step. In the columns of Lanes, one for each node, the last one is unused and 0.
class StepResponse {
 public:
  /// Both must outlive it. Begins without a step length.
  StepResponse(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads)
      : modes_(modes), loads_(loads), count_(modes.count()) {}
  StepResponse(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads, double h)
      : StepResponse(modes, loads) {
    set(h);
  }

  /// Sets the length of the step, s.
  void set(double h);
  double h() const { return h_; }
  /// nodes := z at the nodes, 2p rows; arguments as for PlaceResponse::move().
  void move(double t, const double* z, const double* g, Lanes& nodes) const;
  /// Adds the response to the force to `nodes`; column r of `g` (2p rows) is the coefficient of s^r.
  void add_force(const Lanes& g, Lanes& nodes) const;

 private:
  using Moments =
      Eigen::Matrix<double, Eigen::Dynamic, 2 * StepNodes::kCount * Lanes::ColsAtCompileTime, Eigen::RowMajor>;

  struct Harmonic {
    double angular_frequency;
    Lanes cosine, sine;
  };

  void find_moments(Index mode);
  void find(const HarmonicLoad& load, Harmonic& harmonic) const;
  /// The number for row k and power r is g[k * of_row + r * of_power].
  void add_force(const double* g, Index of_row, Index of_power, Lanes& nodes) const;

  const dynamics::DampedModes& modes_;
  const std::vector<HarmonicLoad>& loads_;
  double h_ = 0.0;
  Index count_;
  Eigen::ArrayXXd at_place_;
  Lanes propagator_;  ///< 2p rows: real and imaginary parts
  Moments moments_;   ///< for each mode and power, the real and the imaginary parts at the nodes
  std::vector<Harmonic> harmonics_;
};

}  // namespace butee::integrators
