#pragma once

#include <vector>

#include "butee/dynamics/elastic_stops.hpp"
#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The highest frequency, rad/s, at which the modes move against one closed stop: (k phi_j^T phi_j)^(1/2).
double contact_frequency(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact);

/// The scales to which errors of stops are relative: the largest displacement and speed of each
/// stop so far, at least a thousandth of the largest of all stops. A stop between two bodies takes
/// the scales of the body whose motion by the stop's force is largest relative to its own scale.
/// The scales are a part of the state. Checked in tests/unit/contact_scales_test.cpp.
class ContactScales {
 public:
  /// The scale of a stop is at least this fraction of the largest one (integrators/error-control.md).
  static constexpr double kFloor = 1e-3;
  /// Speeds below this part of contact_frequency() times a displacement are rounding, as in a static position on closed
  /// stops.
  static constexpr double kLeastSpeed = 1e-8;

  /// `modal` must outlive it.
  ContactScales(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact);

  /// Number of entries in a state: the largest |w| and |w'| of each stop, then |x_a|, |x_b|, |v_a|,
  /// |v_b| of each pair.
  Index memory_size() const { return 2 * modal_.stop_count() + 4 * static_cast<Index>(pairs_.size()); }
  /// Fills these entries for the initial modal coordinates q and speeds v; `w` holds the
  /// displacements and speeds of the stops.
  void start(const double* q, const double* v, const double* w, double* memory) const;
  void load(const double* memory, ContactScale largest);
  void save(double* memory) const;

  /// The least speed per displacement, 1/s.
  double rounding_rate() const { return rounding_rate_; }
  /// The largest displacement and speed of any stop so far.
  const ContactScale& largest() const { return largest_; }
  void raise_largest(const ModalState& to) {
    largest_.displacement = std::max(largest_.displacement, to.largest_w());
    largest_.speed = std::max(largest_.speed, to.largest_wv());
  }
  /// Raises the scales of the individual stops and pairs.
  void raise(const ModalState& to);
  /// The displacement scale of each stop, including its displacement at the end of a step, as a
  /// fraction of `displacement`, the largest one, m.
  void find_shares(const Eigen::ArrayXd& w_end, double displacement, Eigen::ArrayXd& shares) const;

  /// The scale of a stop; `reached` is its motion in the step under trial, `displacement` the
  /// largest of all stops, m.
  ContactScale of(Index stop, ContactScale reached, double displacement) const;

 private:
  /// A stop between bodies a and b. If its force moves the stop by 1, body a moves by share_a and
  /// body b by share_b.
  struct Pair {
    Index stop;
    Vector shape_a;
    double share_a, share_b;
  };
  struct PairScale {
    double x_a = 0.0, x_b = 0.0, v_a = 0.0, v_b = 0.0;
  };

  const dynamics::ModalSystem& modal_;
  double rounding_rate_;
  ContactScale largest_;
  Eigen::ArrayXd w_, wv_;
  std::vector<Pair> pairs_;
  std::vector<PairScale> pair_scales_;
  std::vector<Index> pair_of_;  ///< index in pairs_ for each stop; -1: none
};

}  // namespace butee::integrators
