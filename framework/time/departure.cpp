#include "butee/time/departure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace butee::time {
namespace {

/// The distance from the middle in gaps: too small for any effect but the sign of w.
constexpr double kOffMiddle = 1e-100;
/// The length of a step in 1/omega, short beside the periods of all loads.
constexpr double kProbePart = 1e-6;
/// Length of a step without any stiffness, s.
constexpr double kShortProbe = 1e-9;
/// The largest number of steps; displacements after more of them would be below 1e-200.
constexpr int kMostProbes = 20;

/// The stops that are in the middle of their gap and have a residual force there. Allocates nothing if there are none.
std::vector<Index> stops_in_the_middle(const dynamics::ElasticStops& stops, const Vector& x) {
  std::vector<Index> found;
  const auto at = [&](Index dof) { return dof >= 0 ? x[dof] : 0.0; };
  for (Index i = 0; i < stops.size(); ++i) {
    const model::FreePlay& play = stops.play_of(i);
    if (at(stops.dof_a(i)) == at(stops.dof_b(i)) && play.has_both() && play.gap > 0.0 &&
        stops.law_of(i).secant(-play.gap) != 0.0)
      found.push_back(i);
  }
  return found;
}

double step_length(const model::System& system) {
  const double square = (system.stiffness.diagonal().array() / system.mass.diagonal().array()).maxCoeff();
  return square > 0.0 ? kProbePart / std::sqrt(square) : kShortProbe;
}

/// Moves a DOF of stop i until its displacement has the sign of `direction`.
void move(const dynamics::ElasticStops& stops, Index i, double direction, VectorRef x) {
  const bool by_a = stops.dof_a(i) >= 0;
  double& moved = x[by_a ? stops.dof_a(i) : stops.dof_b(i)];
  const double towards = by_a ? direction : -direction;
  const double next = moved + towards * kOffMiddle * stops.play_of(i).gap;
  moved = next != moved ? next : std::nextafter(moved, towards * std::numeric_limits<double>::infinity());
}

/// Steps of the classical Runge-Kutta method.
class Probe {
 public:
  Probe(dynamics::Dynamics& dynamics, const State& state)
      : dynamics_(dynamics), h_(step_length(dynamics.system())), t_(state.t), x_(state.x), v_(state.v) {
    for (auto& stage : v_of_) stage.resize(x_.size());
    for (auto& stage : a_of_) stage.resize(x_.size());
  }

  void advance() {
    constexpr double kTimes[] = {0.0, 0.5, 0.5, 1.0}, kWeights[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    Vector next_x = x_, next_v = v_, at = x_;
    for (std::size_t i = 0; i < 4; ++i) {
      const double part = kTimes[i] * h_;
      v_of_[i] = v_;
      at = x_;
      if (i > 0) {
        v_of_[i] += part * a_of_[i - 1];
        at += part * v_of_[i - 1];
      }
      dynamics_.acceleration(t_, part, at, v_of_[i], a_of_[i]);
      next_x += (kWeights[i] * h_) * v_of_[i];
      next_v += (kWeights[i] * h_) * a_of_[i];
    }
    x_ = next_x;
    v_ = next_v;
    t_ += h_;
  }

  const Vector& x() const { return x_; }
  /// The number of displacements and velocities that are not zero.
  Index reached() const { return (x_.array() != 0.0).count() + (v_.array() != 0.0).count(); }

 private:
  dynamics::Dynamics& dynamics_;
  double h_, t_;
  Vector x_, v_, v_of_[4], a_of_[4];
};

}  // namespace

bool leave_middle(dynamics::Dynamics& dynamics, State& state) {
  const dynamics::ElasticStops& stops = dynamics.stops();
  std::vector<Index> waiting = stops_in_the_middle(stops, state.x);
  if (waiting.empty()) return false;
  const std::size_t before = waiting.size();
  const auto leave = [&](const Vector& direction) {
    for (const Index i : waiting)
      if (direction[i] != 0.0) move(stops, i, direction[i] > 0.0 ? 1.0 : -1.0, state.x);
    std::erase_if(waiting, [&](Index i) { return direction[i] != 0.0; });
  };
  Vector direction(stops.size());
  stops.displacement(state.v, direction);
  leave(direction);
  if (waiting.empty()) return true;
  Probe probe(dynamics, state);
  for (int step = 0; step < kMostProbes && !waiting.empty(); ++step) {
    const Index reached = probe.reached();
    probe.advance();
    if (!probe.x().allFinite()) break;
    stops.displacement(probe.x(), direction);
    leave(direction);
    if (probe.reached() <= reached) break;
  }
  return waiting.size() < before;
}

}  // namespace butee::time
