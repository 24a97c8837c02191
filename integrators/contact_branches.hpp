#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "integrators/polynomial_root.hpp"

namespace butee::integrators {

/// The stops of a scene between two changes: on each branch its force is an analytic function of its displacement.
///
/// A piecewise linear stop is open or closed on one side; a smooth law changes its branch only where a stop with two
/// sides passes w = 0, where the nearer side changes. Displacements are polynomials in s, 0 <= s <= 1 being the length
/// of an expansion: column k of w holds the coefficients of s^k, one row a stop.
class ContactBranches {
 public:
  /// Throws InputError for a law that is neither piecewise linear nor gives a series. `contact` must outlive it.
  ContactBranches(const dynamics::Contact& contact, int order);

  /// The branches of displacements w; where w lies on a border, undecided.
  void place(ConstVectorRef w);
  bool any_undecided() const;
  /// Decides from the first coefficient beyond the constant that is not zero; where there is none, the stop stays open.
  void decide(const Eigen::MatrixXd& w);

  /// Coefficient k of the forces, given the coefficients 0 ... k of w. An undecided stop exerts none.
  void force(const Eigen::MatrixXd& w, Index k, VectorRef f);

  /// A change of branch at s = `at` of the expansion.
  struct Change {
    double at;
    Index stop;
    int border;  ///< -1, +1: the side of the border that is crossed; 0: w = 0
  };
  /// The first change for 0 < s <= `until`.
  std::optional<Change> first_change(const Eigen::MatrixXd& w, double until);
  void apply(const Change& change);

 private:
  enum class Status : std::int8_t { open, closed, smooth, undecided };
  struct Branch {
    Status status = Status::open;
    double side = 1.0;  ///< of the closed or smooth branch
    int crossed = 2;    ///< the border just crossed, on which w lies to rounding; 2: none
  };

  /// Looks for the sign change of offset + factor w and keeps it where it comes first.
  void watch(const Eigen::MatrixXd& w, Index stop, int border, double factor, double offset, double until,
             std::optional<Change>& first);
  /// Of a smooth law: where the path meets g = 0. Its bend may be so narrow that the series of the far force does not
  /// know of it, and would carry the path across.
  void watch_bend(const Eigen::MatrixXd& w, Index stop, double until, std::optional<Change>& first);

  const dynamics::Contact& contact_;
  std::vector<Branch> branches_;
  std::vector<std::unique_ptr<model::ForceSeries>> series_;  ///< nullptr for piecewise linear laws
  PolynomialRoot root_;
  std::vector<double> gap_, polynomial_;
  std::vector<std::vector<double>> penetration_;  ///< coefficients of g, of smooth stops
};

}  // namespace butee::integrators
