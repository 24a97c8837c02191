#pragma once

#include <vector>

namespace butee::app::plot {

/// The motion of a probe between the rows of its history.
///
/// Displacement: the Hermite cubic of u and v at both rows. Velocity: likewise from v and a, or without a the
/// derivative of the displacement cubic.
class Motion {
 public:
  struct Point {
    double u, v;
  };

  /// All arguments must outlive this object; `a` may be nullptr. Times ascend.
  Motion(const std::vector<double>& times, const std::vector<double>& u, const std::vector<double>& v,
         const std::vector<double>* a)
      : times_(times), u_(u), v_(v), a_(a) {}

  /// Points at multiples of `period`, s: 0, period, 2 period ...
  std::vector<Point> once_per(double period) const;
  /// All rows, with interpolated points in between if the rows are few.
  std::vector<Point> smooth() const;

 private:
  /// The point at the fraction s of the interval from row i to the next.
  Point at(std::size_t i, double s) const;

  const std::vector<double>&times_, &u_, &v_;
  const std::vector<double>* a_;
};

}  // namespace butee::app::plot
