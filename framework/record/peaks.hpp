#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "butee/model/output_request.hpp"
#include "butee/record/tracks.hpp"

namespace butee::record {

/// Records the largest |value| of probes over the whole motion, on the method's dense output: t =
/// 0, stationary points, ends and breakpoints of steps.
///
/// Displacements, velocities and accelerations are recorded as ranges (StepPath). The force of a
/// single stop on a node is largest where its displacement is. The sum of several is bounded over
/// an interval by the sum of their bounds and, for piecewise linear stops, by its values at the ends
/// and its rate; while that exceeds the peak by more than kGoodSum of it, the interval of the
/// largest bound is halved.
class BUTEE_EXPORT Peaks final : public time::Observer {
 public:
  static constexpr double kGoodSum = 1e-6;

  /// `dynamics` must outlive this object.
  Peaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;
  /// Takes a state that no step has led to, such as that after a jump of the motion or of the forces between steps.
  void take(const time::State& state);

  /// The peaks by column, "mid.u".
  std::map<std::string, double> largest() const;

 private:
  /// A displacement, and which of its derivatives 0 to 2 are recorded.
  struct Followed {
    std::array<bool, 3> is_followed{};
    std::array<Range, 3> ranges{};
  };
  /// A stop on a probed node, and the sign of its force there.
  struct Stop {
    Index index;
    std::size_t track;
    double sign;
    double stiffness;  ///< when closed, N/m
  };
  /// Derivative `order` of a track, or the sum of `stops`; 0 if there is neither.
  struct Column {
    std::string name;
    std::size_t track, order;
    std::vector<Stop> stops;
    double largest;                    ///< so far, for the sum of several stops
    bool is_piecewise_linear = false;  ///< all stops are
  };

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::size_t follow(Index a, Index b, std::size_t order);
  std::vector<Stop> stops_on(model::Quantity quantity, model::NodeId node);
  /// Updates the column with the sum of several stop forces between begin_ and end_.
  void follow_sum(const time::AcceptedStep& step, Column& column);
  /// An upper bound of the sum's magnitude between two instants, given a point of each stop.
  double bound_of_sum(const time::AcceptedStep& step, const Column& column, const std::vector<Point>& from,
                      const std::vector<Point>& to) const;
  double sum_at(const Column& column, const std::vector<Point>& points) const;
  double value_of(const Column& column) const;

  dynamics::Dynamics& dynamics_;
  Tracks tracks_;
  std::vector<Followed> followed_;  ///< one entry per track
  std::vector<Column> columns_;
  std::vector<Point> begin_, end_;  ///< for the stops of a column
};

}  // namespace butee::record
