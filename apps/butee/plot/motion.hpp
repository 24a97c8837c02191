#pragma once

#include <vector>

namespace butee::app::plot {

/// The motion of a probe between the rows of its history.
///
/// Displacement by the cubic that meets u and v at both rows; velocity likewise by v and a, or without a by the
/// derivative of that cubic.
class Motion {
 public:
  struct Point {
    double u, v;
  };

  /// All must outlive it; `a` may be nullptr. Times ascend.
  Motion(const std::vector<double>& times, const std::vector<double>& u, const std::vector<double>& v,
         const std::vector<double>* a)
      : times_(times), u_(u), v_(v), a_(a) {}

  /// Once per `period` in s: at 0, period, 2 period ...
  std::vector<Point> once_per(double period) const;
  /// All rows, with points in between where they are few.
  std::vector<Point> smooth() const;

 private:
  /// At the fraction s of the way from row i to the next.
  Point at(std::size_t i, double s) const;

  const std::vector<double>&times_, &u_, &v_;
  const std::vector<double>* a_;
};

}  // namespace butee::app::plot
