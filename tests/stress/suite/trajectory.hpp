#pragma once

#include <vector>

#include <butee/time/simulation.hpp>

namespace butee::stress {

/// The motion of all DOFs at given instants, one column for each, as far as the run came.
struct Trajectory {
  Eigen::MatrixXd x, v;  ///< m or rad; m/s or rad/s
  Index rows = 0;        ///< number of filled columns
  bool is_finite = true;

  Trajectory() = default;
  Trajectory(Index size, std::size_t instants) : x(Eigen::MatrixXd::Zero(size, static_cast<Index>(instants))), v(x) {}
};

/// Fills a Trajectory from the dense output of a run, and records the largest displacement at step ends.
class Follower final : public time::Observer {
 public:
  /// `instants` must ascend and outlive this object.
  Follower(Index size, const std::vector<double>& instants);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  double next_instant(double t) const override;

  Trajectory trajectory;
  double largest = 0.0;  ///< |x_i| at the end of a step

 private:
  const std::vector<double>& instants_;
  std::vector<Index> all_;
};

}  // namespace butee::stress
