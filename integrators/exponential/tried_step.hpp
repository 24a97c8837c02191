#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "butee/dynamics/modal_system.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// Modal coordinates q and speeds v, and displacements w and speeds wv of the stops, padded to
/// whole vector registers.
struct ModalState {
  Eigen::ArrayXd q, v, w, wv;

  void resize(const dynamics::ModalSystem& modal) {
    for (Eigen::ArrayXd* array : {&q, &v}) array->setZero(modal.size());
    for (Eigen::ArrayXd* array : {&w, &wv}) array->setZero(dynamics::ContactPropagator::padded(modal.stop_count()));
  }
  /// Computes w and wv from q and v.
  void find_stops(const dynamics::StopShapes& shapes) { shapes.displacement(q.data(), v.data(), w.data(), wv.data()); }
  double largest_w() const { return w.abs().maxCoeff(); }
  double largest_wv() const { return wv.abs().maxCoeff(); }
};

/// The data of a step under trial, shared by the parts of ExponentialStep.
struct TriedStep {
  double t = 0.0, t_end = 0.0, h = 0.0;  ///< s
  ModalState from, to;                   ///< `to` includes the forces found so far
  ModalState middle;                     ///< speeds only if needed
  double breakpoint = 0.0;               ///< time of a breakpoint in the middle for outputs, s; 0: none
  bool is_near = false;                  ///< a stop comes near its gap
  ContactScale reached;  ///< largest of all stops so far, including the end of this step without contact

  /// The stops whose forces are found by iteration: stops near their gap or with a varying residual
  /// force.
  std::vector<Index> iterated;
  /// The stops among `iterated` that reach their gaps only by the forces of other stops.
  std::vector<Index> carried;
  /// The stops among `iterated` whose residual force jumps at another time, or only, because of the
  /// forces of other stops.
  std::vector<Index> crossing;
  /// If there are residual forces: all other stops, whose residual forces are constant.
  std::vector<Index> constant;

  bool is_crossing(Index stop) const { return std::find(crossing.begin(), crossing.end(), stop) != crossing.end(); }

  /// True if a stop is on one side of its gap at the start of the step and on the other at its end. One that starts in
  /// the middle to rounding does not cross it.
  bool crosses_middle(Index stop, double end) const {
    constexpr double kRounding = 1e-13;
    return from.w[stop] * end < 0.0 && std::abs(from.w[stop]) > kRounding * std::abs(end);
  }

  /// Adds the response to a modal force with time function P_k to the end of the step.
  void add_to_end(const dynamics::ModalPropagator& whole, int k, const Eigen::ArrayXd& force) {
    to.q += force * whole.force_q(k);
    to.v += force * whole.force_v(k);
  }
  /// Adds it to the middle; P_k of the step is written in the polynomials of its first half.
  void add_to_middle(const dynamics::ModalPropagator& half, std::size_t k, const Eigen::ArrayXd& force) {
    const auto add = [&](Eigen::ArrayXd& sum, const auto& by) {
      if (k == 0) sum += force * by(0);
      if (k == 1) sum += 0.5 * force * (by(1) - by(0));
      if (k == 2) sum += force * (0.25 * by(2) - 0.75 * by(1));
    };
    add(middle.q, [&](int j) { return half.force_q(j); });
    if (breakpoint > 0.0) add(middle.v, [&](int j) { return half.force_v(j); });
  }
};

}  // namespace butee::integrators
