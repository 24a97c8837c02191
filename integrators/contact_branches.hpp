#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "integrators/polynomial_root.hpp"

namespace butee::integrators {

/// The branches of the stops' force laws between two changes of contact. On a branch the force of a
/// stop is an analytic function of its displacement.
///
/// A piecewise linear stop is open or closed on one side. A smooth law changes its branch only if a
/// stop with two sides passes w = 0, where the nearer side changes. Displacements are polynomials
/// in s; 0 <= s <= 1 spans the expansion. Column k of w holds the coefficients of s^k, with one row
/// per stop.
class ContactBranches {
 public:
  /// Throws InputError for a law that is not piecewise linear and gives no series. `contact` must
  /// outlive it.
  ContactBranches(const dynamics::ElasticStops& contact, int order);

  /// Sets the branches at displacements w; a stop on a border is undecided.
  void place(ConstVectorRef w);
  bool any_undecided() const;
  /// Decides undecided stops by the first nonzero coefficient of w beyond the constant; if all are
  /// zero, the stop is open.
  void decide(const Eigen::MatrixXd& w);

  /// Coefficient k of the forces, given the coefficients 0 ... k of w. An undecided stop exerts none.
  void force(const Eigen::MatrixXd& w, Index k, VectorRef f);

  /// A change of branch at s = `at` of the expansion.
  struct Change {
    double at;
    Index stop;
    int border;  ///< -1, +1: the side of the border that is crossed; 0: w = 0
  };
  /// The first change in 0 < s <= `until`.
  std::optional<Change> first_change(const Eigen::MatrixXd& w, double until);
  void apply(const Change& change);

 private:
  enum class Status : std::int8_t { open, closed, smooth, undecided };
  struct Branch {
    Status status = Status::open;
    double side = 1.0;  ///< +1, -1: the side of a closed or smooth branch
    int crossed = 2;    ///< the border just crossed, on which w lies to rounding; 2: none
  };

  /// Looks for the sign change of offset + factor w and keeps it where it comes first.
  void watch(const Eigen::MatrixXd& w, Index stop, int border, double factor, double offset, double until,
             std::optional<Change>& first);
  /// Finds where the path of a stop with a smooth law meets g = 0. The transition there may be so
  /// narrow that the series of the asymptotic force does not resolve it, so that the expansion must
  /// end there.
  void watch_bend(const Eigen::MatrixXd& w, Index stop, double until, std::optional<Change>& first);

  const dynamics::ElasticStops& contact_;
  std::vector<Branch> branches_;
  std::vector<std::unique_ptr<model::ForceSeries>> series_;  ///< nullptr for piecewise linear laws
  PolynomialRoot root_;
  std::vector<double> gap_, polynomial_;
  std::vector<std::vector<double>> penetration_;  ///< series coefficients of g for stops with a smooth law
};

}  // namespace butee::integrators
