#pragma once

#include <vector>

#include <butee/time/simulation.hpp>

namespace butee::app::trust {

/// Finds the smallest and the largest value of displacements over whole steps, including the interior: each
/// step is sampled, and at a sign change of a velocity its zero is located on the dense output.
class TurningPoints final : public time::Observer {
 public:
  /// A relative displacement x[a] - x[b]; an index below 0 is ground.
  struct Path {
    Index a, b;
    double least = 0.0, greatest = 0.0;  ///< m or rad
  };

  /// `omega`: the highest natural frequency, rad/s; it sets the number of samples of a long step.
  TurningPoints(std::vector<Path> paths, double omega);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;

  const std::vector<Path>& paths() const { return paths_; }

 private:
  struct Motion {
    double x, v;
  };

  void sample(const time::AcceptedStep& step, double begin, double end);
  void turn(Path& path, const time::AcceptedStep& step, double begin, double end, Motion from, Motion to) const;
  Motion motion(const Path& path, const time::AcceptedStep& step, double t) const;
  Motion at(const Path& path, std::size_t instant) const;

  std::vector<Path> paths_;
  double omega_;
  std::vector<Index> dofs_;
  std::vector<Index> slots_;  ///< index of each DOF's value, by DOF
  std::vector<double> times_, x_, v_;
};

}  // namespace butee::app::trust
