#pragma once

#include <utility>
#include <vector>

#include "butee/model/free_play.hpp"
#include "butee/record/extremes.hpp"

namespace butee::record {

/// The displacements that an observer evaluates from breakpoint to breakpoint: of a DOF, or of one
/// relative to another.
class BUTEE_EXPORT Tracks {
 public:
  /// Returns the index of the displacement u_a - u_b; a negative DOF is fixed. `order`: the highest
  /// derivative whose extremes are wanted. To be called before the first step.
  std::size_t add(Index a, Index b, std::size_t order);
  /// Has extremes of a displacement found to a small part of their distance from the ends of a stop's free play.
  void resolve(std::size_t track, const model::FreePlay& play);
  std::size_t size() const { return pairs_.size(); }

  Point at(const time::State& state, std::size_t track) const {
    return StepPath::point(state, pairs_[track].first, pairs_[track].second);
  }
  StepPath path(const time::AcceptedStep& step, std::size_t track) const {
    return {step, kind_, pairs_[track].first, pairs_[track].second, borders_[track], rounding_};
  }

  /// Calls `look()` for every piece of the step between two neighbouring breakpoints; from() and
  /// to() are its ends.
  template <class Look>
  void visit(const time::AcceptedStep& step, Look look) {
    kind_ = step.motion.interpolation();
    if (kind_ == time::Interpolation::other) rounding_ = StepPath::rounding_of_sums(step);
    for (std::size_t i = 0; i < size(); ++i) from_[i] = at(step.from, i);
    const std::span<const double> breakpoints = step.motion.breakpoints(detail_);
    if (!breakpoints.empty()) sample(step, breakpoints);
    for (std::size_t k = 0; k < breakpoints.size(); ++k) {
      load(k, breakpoints[k]);
      look();
      std::swap(from_, to_);
    }
    for (std::size_t i = 0; i < size(); ++i) to_[i] = at(step.to, i);
    look();
  }
  const Point& from(std::size_t track) const { return from_[track]; }
  const Point& to(std::size_t track) const { return to_[track]; }

 private:
  void sample(const time::AcceptedStep& step, std::span<const double> breakpoints);
  void load(std::size_t breakpoint, double t);

  std::vector<std::pair<Index, Index>> pairs_;
  std::vector<std::pair<std::size_t, std::size_t>> places_;  ///< their indices in dofs_
  std::vector<std::vector<double>> borders_;                 ///< by track: displacements at which stops close
  std::vector<Point> from_, to_;
  time::Detail detail_ = time::Detail::displacements;
  time::Interpolation kind_ = time::Interpolation::cubic;  ///< of the last visited step
  std::array<double, 3> rounding_{};                       ///< of x, v and a there
  std::vector<Index> dofs_;
  std::vector<double> x_, v_, a_;  ///< of dofs_ at the breakpoints
};

}  // namespace butee::record
