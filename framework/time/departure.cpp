#include "butee/time/departure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "butee/dynamics/centre_pulls.hpp"

namespace butee::time {
namespace {

/// The distance from the middle in gaps: too small for any effect but the sign of w.
constexpr double kOffMiddle = 1e-100;
/// A displacement that kOffMiddle gaps do not change is moved by a rounding error if the direction has a larger
/// component along it.
constexpr double kMainPart = 0.5;
/// The length of a step in 1/omega, short beside the periods of all loads.
constexpr double kProbePart = 1e-6;
/// Length of a step without any stiffness, s.
constexpr double kShortProbe = 1e-9;
/// The largest number of steps; displacements after more of them would be below 1e-200.
constexpr int kMostProbes = 20;

/// A contact with a residual force in the middle of its gap: a stop with two sides, or a ring.
struct Middle {
  std::array<Index, 2> a, b;            ///< DOFs along its directions, or kGround
  double gap;                           ///< m
  Eigen::Vector2d centre = {0.0, 0.0};  ///< m

  Eigen::Vector2d apart(const Vector& y) const {
    const auto at = [&](Index dof) { return dof >= 0 ? y[dof] : 0.0; };
    return {at(a[0]) - at(b[0]), at(a[1]) - at(b[1])};
  }
};

/// The contacts that are in the middle of their gap and have a residual force there. Allocates nothing if there are
/// none.
std::vector<Middle> contacts_in_the_middle(dynamics::Dynamics& dynamics, const Vector& x) {
  constexpr Index kGround = model::FreeStops::kGround;
  std::vector<Middle> found;
  const auto add = [&](const Middle& middle) {
    if (middle.apart(x) == middle.centre) found.push_back(middle);
  };
  const dynamics::ElasticStops& stops = dynamics.stops();
  for (Index i = 0; i < stops.size(); ++i) {
    const model::FreePlay& play = stops.play_of(i);
    if (play.has_both() && play.gap > 0.0 && stops.law_of(i).secant(-play.gap) != 0.0)
      add({{stops.dof_a(i), kGround}, {stops.dof_b(i), kGround}, play.gap});
  }
  if (dynamics.obstacles() == nullptr) return found;
  for (const dynamics::CentrePull& pull : dynamics::centre_pulls(*dynamics.obstacles())) {
    const model::FreeObstacles::Ends& ends = dynamics.obstacles()->ends_of(pull.contact);
    add({{ends.a[0], ends.a[1]}, {ends.b[0], ends.b[1]}, pull.gap, pull.centre});
  }
  return found;
}

double step_length(const model::System& system) {
  const double square = (system.stiffness.diagonal().array() / system.mass.diagonal().array()).maxCoeff();
  return square > 0.0 ? kProbePart / std::sqrt(square) : kShortProbe;
}

/// Moves the DOFs of a contact in this direction, of length 1; by a rounding error of a displacement if that is more.
void move(const Middle& middle, const Eigen::Vector2d& direction, VectorRef x) {
  for (std::size_t k = 0; k < 2; ++k) {
    const bool by_a = middle.a[k] >= 0;
    const double towards = (by_a ? 1.0 : -1.0) * direction[static_cast<Index>(k)];
    if (towards == 0.0) continue;
    double& moved = x[by_a ? middle.a[k] : middle.b[k]];
    const double next = moved + towards * kOffMiddle * middle.gap;
    if (next != moved || std::abs(towards) < kMainPart)
      moved = next;
    else
      moved = std::nextafter(moved, towards * std::numeric_limits<double>::infinity());
  }
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
  std::vector<Middle> waiting = contacts_in_the_middle(dynamics, state.x);
  if (waiting.empty()) return false;
  const std::size_t before = waiting.size();
  const auto leave = [&](const Vector& by) {
    std::erase_if(waiting, [&](const Middle& middle) {
      const Eigen::Vector2d direction = middle.apart(by).stableNormalized();
      if (direction.isZero(0.0)) return false;
      move(middle, direction, state.x);
      return true;
    });
  };
  leave(state.v);
  if (waiting.empty()) return true;
  Probe probe(dynamics, state);
  for (int step = 0; step < kMostProbes && !waiting.empty(); ++step) {
    const Index reached = probe.reached();
    probe.advance();
    if (!probe.x().allFinite()) break;
    leave(probe.x() - state.x);
    if (probe.reached() <= reached) break;
  }
  return waiting.size() < before;
}

}  // namespace butee::time
