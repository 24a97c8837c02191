#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "butee/model/output_request.hpp"
#include "butee/record/tracks.hpp"

namespace butee::record {

/// Follows the largest |value| of probes over the whole motion, on the method's dense output: t = 0, stationary points,
/// ends and breakpoints of steps.
///
/// Displacements, speeds and accelerations are followed as ranges (StepPath). The force of a single stop on a node is
/// the largest where its displacement is. The sum of several is bounded over an interval by the sum of their largest;
/// where that exceeds the peak by more than kGoodSum of it, the interval is halved.
class BUTEE_EXPORT Peaks final : public time::Observer {
 public:
  static constexpr double kGoodSum = 1e-6;

  /// `dynamics` must outlive it.
  Peaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  /// By column, "mid.u".
  std::map<std::string, double> largest() const;

 private:
  /// A displacement, and which of it and its derivatives are followed.
  struct Followed {
    std::array<bool, 3> is_followed{};
    std::array<Range, 3> ranges{};
  };
  /// A stop on a probed node, and the sign with which it acts there.
  struct Stop {
    Index index;
    std::size_t track;
    double sign;
  };
  /// Derivative `order` of a track, or the sum of `stops`; 0 where there is neither.
  struct Column {
    std::string name;
    std::size_t track, order;
    std::vector<Stop> stops;
    double largest;  ///< so far, of the sum of several stops
  };

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::size_t follow(Index a, Index b, std::size_t order);
  std::vector<Stop> stops_on(Index dof);
  /// Takes what several stops together exert between two instants, a point of each, into the column.
  void follow_sum(const time::AcceptedStep& step, Column& column, const std::vector<Point>& from,
                  const std::vector<Point>& to, int& halvings);
  double sum_at(const Column& column, const std::vector<Point>& points) const;
  double value_of(const Column& column) const;

  dynamics::Dynamics& dynamics_;
  Tracks tracks_;
  std::vector<Followed> followed_;  ///< an entry a track
  std::vector<Column> columns_;
  std::vector<Point> begin_, end_;  ///< of the stops of a column
};

}  // namespace butee::record
