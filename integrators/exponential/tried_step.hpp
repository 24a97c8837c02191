#pragma once

#include <vector>

#include "butee/dynamics/modal_system.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// Modal coordinates q and speeds v, and the displacements w and speeds wv of the stops, padded to whole registers.
struct ModalState {
  Eigen::ArrayXd q, v, w, wv;

  void resize(const dynamics::ModalSystem& modal) {
    for (Eigen::ArrayXd* array : {&q, &v}) array->setZero(modal.size());
    for (Eigen::ArrayXd* array : {&w, &wv}) array->setZero(dynamics::ContactPropagator::padded(modal.stop_count()));
  }
  /// w and wv of q and v.
  void find_stops(const dynamics::StopShapes& shapes) { shapes.displacement(q.data(), v.data(), w.data(), wv.data()); }
  double largest_w() const { return w.abs().maxCoeff(); }
  double largest_wv() const { return wv.abs().maxCoeff(); }
};

/// A step under trial, on which the parts of ExponentialStep work in turn.
struct TriedStep {
  double t = 0.0, t_end = 0.0, h = 0.0;  ///< s
  ModalState from, to;                   ///< `to` with the forces found so far
  ModalState middle;                     ///< speeds only where they are needed
  double breakpoint = 0.0;               ///< in the middle, which outputs are to know of, s; 0: none
  bool is_near = false;                  ///< any stop comes near its gap
  ContactScale reached;                  ///< the largest of all stops so far, with the end of the step without contact

  /// The stops whose forces are found by iteration: those near their gap, or with a residual force that varies.
  std::vector<Index> iterated;
  /// Those of them that the forces of others alone bring to their gaps.
  std::vector<Index> carried;
  /// All others, where there are residual forces: theirs are constant.
  std::vector<Index> constant;

  /// Adds a modal force P_k to the end of the step.
  void add_to_end(const dynamics::ModalPropagator& whole, int k, const Eigen::ArrayXd& force) {
    to.q += force * whole.force_q(k);
    to.v += force * whole.force_v(k);
  }
  /// Adds it to the middle: P_k of the step, written in the polynomials of its first half.
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
