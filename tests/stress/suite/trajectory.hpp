#pragma once

#include <vector>

#include <butee/time/simulation.hpp>

namespace butee::stress {

/// The motion of all DOFs at given instants, a column for each; as far as the run came.
struct Trajectory {
  Eigen::MatrixXd x, v;  ///< m or rad, and a second
  Index rows = 0;        ///< columns that are filled
  bool is_finite = true;

  Trajectory() = default;
  Trajectory(Index size, std::size_t instants) : x(Eigen::MatrixXd::Zero(size, static_cast<Index>(instants))), v(x) {}
};

/// Fills a Trajectory from the dense output of a run, and looks at the ends of all steps.
class Follower final : public time::Observer {
 public:
  /// `instants` are ascending and must outlive it.
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
