#include "butee/study/lyapunov.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/scene/assembly.hpp"

namespace butee::study {
namespace {

/// The size of a disturbance: a multiple of the relative noise of a step, with lower and upper
/// limits.
constexpr double kAboveNoise = 1e4, kSmallest = 1e-8, kLargest = 1e-3;
/// Below this fraction of its initial size a difference is lost in rounding.
constexpr double kLost = 1e-6;

class Size {
 public:
  Size(const SparseMatrix& mass, double omega) : mass_(mass), omega_(omega) {}
  double of(const Vector& x, const Vector& v) const {
    return std::sqrt(std::max(0.0, v.dot(mass_ * v) + omega_ * omega_ * x.dot(mass_ * x)));
  }

 private:
  const SparseMatrix& mass_;
  double omega_;
};

/// A run that is set to given motions and continued for given durations.
class Piece {
 public:
  Piece(scene::Scene& scene, dynamics::Dynamics& dynamics, const Motion& start)
      : integrator_(make_integrator(scene, dynamics)), simulation_(dynamics, *integrator_, scene.integrator.options) {
    simulation_.begin_with(start.x, start.v, start.contact);
  }
  bool go(const Vector& x, const Vector& v, double until, const std::function<bool()>& goes_on) {
    simulation_.set_motion(x, v);
    simulation_.set_end_time(until);
    return simulation_.run(goes_on).completed;
  }
  const time::State& state() const { return simulation_.state(); }

 private:
  std::unique_ptr<time::Integrator> integrator_;
  time::Simulation simulation_;
};

}  // namespace

std::optional<double> lyapunov_exponent(scene::Scene& scene, dynamics::Dynamics& dynamics, const Motion& start,
                                        const Counted& counted, const std::function<bool()>& goes_on) {
  // Time restarts at the start of the collected motion, which is a whole number of periods of the
  // loads later.
  Piece run(scene, dynamics, start), disturbed(scene, dynamics, start);
  const SparseMatrix& mass = dynamics.system().mass;
  const double omega = 2.0 * std::numbers::pi / counted.period;
  const Size size(mass, omega);
  Vector x = start.x, v = start.v;
  const double wanted =
      std::clamp(kAboveNoise * scene::tolerance_of(scene.integrator, scene.integrator.name).value_or(0.0), kSmallest,
                 kLargest) *
      size.of(x, v);
  if (!(wanted > 0.0)) return std::nullopt;
  Vector dx = Vector::Zero(x.size()), dv = dx;
  for (Index i = 0; i < dv.size(); ++i) dv[i] = 1.0 / std::sqrt(mass.coeff(i, i));
  double now = size.of(dx, dv), sum = 0.0;
  const std::int64_t first = counted.periods / 4;
  for (std::int64_t i = 0; i < counted.periods; ++i) {
    const double until = static_cast<double>(i + 1) * counted.period;
    dx *= wanted / now;
    dv *= wanted / now;
    if (!disturbed.go(x + dx, v + dv, until, goes_on) || !run.go(x, v, until, goes_on)) return std::nullopt;
    x = run.state().x;
    v = run.state().v;
    dx = disturbed.state().x - x;
    dv = disturbed.state().v - v;
    now = std::max(size.of(dx, dv), kLost * wanted);
    if (i >= first) sum += std::log(now / wanted);
  }
  return sum / (static_cast<double>(counted.periods - first) * counted.period);
}

}  // namespace butee::study
