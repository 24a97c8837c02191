#pragma once

#include <optional>
#include <vector>

#include "integrators/contact_branches.hpp"
#include "integrators/obstacle_series.hpp"

namespace butee::integrators {

/// The motion from an instant on as polynomials in s = (t - begin)/length: x(t) = sum over k of x_k
/// s^k.
struct TaylorExpansion {
  double begin = 0.0;   ///< start time, in seconds
  double length = 0.0;  ///< duration that corresponds to s = 1, in seconds
  double reach = 0.0;   ///< the largest s at which the truncation error is below the tolerance
  double end = 0.0;     ///< the s up to which the expansion is used
  Eigen::MatrixXd x;    ///< n x (order + 1)

  double value(Index dof, double s) const;
  double velocity(Index dof, double s) const;      ///< dx/dt
  double acceleration(Index dof, double s) const;  ///< d2x/dt2
};

/// Computes the Taylor series of the equations of motion on given branches of the stops:
///
///     x_{k+2} = length^2/((k+1)(k+2)) M^-1 (F_k + F_c,k - C x_{k+1} (k+1)/length - K x_k)
class TaylorExpander {
 public:
  /// Throws InputError for loads without a series. `dynamics` must outlive it. `tolerance` bounds
  /// the last terms relative to the largest.
  TaylorExpander(dynamics::Dynamics& dynamics, int order, double tolerance);

  /// Fills `to` from (t, x, v) for the length in it; decides undecided branches. False if
  /// coefficients overflow at that length.
  bool expand(double t, const Vector& x, const Vector& v, ContactBranches& branches, TaylorExpansion& to);

  /// The displacements of the stops from the last expand(), (number of stops) x (order + 1).
  const Eigen::MatrixXd& stop_displacement() const { return w_; }

 private:
  void expand_loads(double t, double length);
  void recur(ContactBranches& branches, TaylorExpansion& to);
  double find_reach(const Eigen::MatrixXd& x);

  dynamics::Dynamics& dynamics_;
  std::optional<ObstacleSeries> obstacles_;
  Index order_;
  double tolerance_;
  Eigen::MatrixXd loads_;  ///< row j: coefficients of load j
  std::vector<double> load_;
  Eigen::MatrixXd w_;
  Vector force_, stop_force_, stops_, velocity_, terms_;
  Vector held_;  ///< terms of the velocity without rigid sticks, if there are any; otherwise 0
};

}  // namespace butee::integrators
