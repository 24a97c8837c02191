#pragma once

#include "integrators/exponential/contact_gaps.hpp"
#include "integrators/exponential/contact_path.hpp"

namespace butee::integrators {

/// The paths of all stops over the step under trial, with the forces found so far, as arrays with
/// one entry per stop.
class ContactPaths {
 public:
  /// `step` and `gaps` must outlive it.
  ContactPaths(const TriedStep& step, const ContactGaps& gaps) : step_(step), gaps_(gaps) {
    for (Eigen::ArrayXd* array : {&hv_, &motion_.end, &motion_.speed, &motion_.middle, &quartic_, &excess_})
      array->setZero(gaps.gaps().size());
  }

  /// Sets the paths without contact forces in the step.
  void begin(const dynamics::StopShapes& shapes) {
    hv_ = step_.h * step_.from.wv;
    motion_.end = step_.to.w;
    motion_.speed = step_.h * step_.to.wv;
    shapes.displacement(step_.middle.q.data(), motion_.middle.data());
  }
  /// Fills quartic() and excess().
  void find_bounds() {
    const Eigen::ArrayXd& w = step_.from.w;
    quartic_ = motion_.middle - (0.5 * (w + motion_.end) + 0.125 * (hv_ - motion_.speed));
    // The Bernstein coefficients of ContactPath
    constexpr double kPart = 16.0 / 6.0;
    const auto b1 = w + 0.25 * hv_;
    const auto b2 = 0.5 * (w + motion_.end) + (hv_ - motion_.speed) * (1.0 / 6.0) + kPart * quartic_;
    const auto b3 = motion_.end - 0.25 * motion_.speed;
    excess_ = (w.max(motion_.end).max(b1).max(b2).max(b3) - gaps_.upper())
                  .max(gaps_.lower() - w.min(motion_.end).min(b1).min(b2).min(b3));
  }

  /// Displacement at the end, h times the speed there, and displacement in the middle, all in m.
  dynamics::StopMotion& motion() { return motion_; }
  const dynamics::StopMotion& motion() const { return motion_; }
  /// h times the speed at the start, m.
  const Eigen::ArrayXd& start_speed() const { return hv_; }
  /// Displacement in the middle minus that of the cubic through the ends, m.
  const Eigen::ArrayXd& quartic() const { return quartic_; }
  /// The bound of the path minus the gap, m; negative if the path stays within the gap.
  const Eigen::ArrayXd& excess() const { return excess_; }

  ContactPath of(Index stop) const {
    const double w = step_.from.w[stop], end = motion_.end[stop], speed = motion_.speed[stop];
    const double quartic = motion_.middle[stop] - (0.5 * (w + end) + 0.125 * (hv_[stop] - speed));
    return {w, hv_[stop], end, speed, quartic};
  }
  double largest_speed(Index stop) const { return std::max(std::abs(hv_[stop]), std::abs(motion_.speed[stop])); }
  /// Displacement at the end and largest speed at the ends.
  ContactScale reached(Index stop) const { return {std::abs(motion_.end[stop]), largest_speed(stop) / step_.h}; }
  /// The stop closes or opens in the step, or both.
  bool changes(Index stop) const { return gaps_.changes(stop, step_.from.w[stop], motion_.end[stop], excess_[stop]); }
  bool passes_inner_border(Index stop) const {
    return gaps_.passes_inner_border(stop, step_.from.w[stop], motion_.end[stop]);
  }
  bool stays_closed(Index stop) const { return gaps_.stays_closed(stop, step_.from.w[stop], motion_.end[stop]); }

 private:
  const TriedStep& step_;
  const ContactGaps& gaps_;
  Eigen::ArrayXd hv_;
  dynamics::StopMotion motion_;
  Eigen::ArrayXd quartic_, excess_;
};

}  // namespace butee::integrators
