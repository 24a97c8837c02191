#include "disturbance.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/scene/assembly.hpp>

#include "../interruption.hpp"
#include "../perturb.hpp"

namespace butee::app::trust {
namespace {

/// A decaying disturbance below this fraction of its first size is lost in rounding.
constexpr double kLost = 1e-6;

/// The norm of a motion, similar to the square root of an energy.
class Size {
 public:
  Size(const dynamics::Dynamics& dynamics, const FollowedRun& run) : dynamics_(dynamics), work_(dynamics.size()) {
    double x = 0.0, v = 0.0, elastic = 0.0;
    for (Index i = 0; i < run.x.cols(); ++i) {
      elastic = std::max(elastic, elastic_square(run.x.col(i)));
      x = std::max(x, mass_square(run.x.col(i)));
      v = std::max(v, mass_square(run.v.col(i)));
    }
    omega_square_ = x > 0.0 ? v / x : 0.0;
    elastic_square_ = elastic > 0.0 ? elastic / x : omega_square_;
    for (Index i = 0; i < run.x.cols(); ++i) largest_ = std::max(largest_, of(run.x.col(i), run.v.col(i)));
  }

  double of(ConstVectorRef x, ConstVectorRef v) {
    return std::sqrt(mass_square(v) + std::max(elastic_square(x), omega_square_ * mass_square(x)));
  }
  /// The norm of a displacement, relative to the displacement that a velocity causes without stops.
  double of_displacement(ConstVectorRef x) { return std::sqrt(elastic_square_ * mass_square(x)); }
  double largest() const { return largest_; }
  double omega() const { return std::sqrt(omega_square_); }

 private:
  double elastic_square(ConstVectorRef x) {
    dynamics_.elastic_force(x, work_);
    return std::max(0.0, x.dot(work_));
  }
  double mass_square(ConstVectorRef y) {
    dynamics_.inertia_force(y, work_);
    return std::max(0.0, y.dot(work_));
  }

  const dynamics::Dynamics& dynamics_;
  Vector work_;
  double omega_square_ = 0.0, elastic_square_ = 0.0, largest_ = 0.0;
};

/// Moves (x, v) from the present instant of a simulation to `end`; false if the run fails.
bool advance(time::Simulation& simulation, Vector& x, Vector& v, double end) {
  simulation.set_motion(x, v);
  simulation.set_end_time(end);
  const time::RunReport& report = simulation.run([] { return interruption() == nullptr; });
  if (interruption() != nullptr) throw RunError("interrupted during the accuracy estimate");
  x = simulation.state().x;
  v = simulation.state().v;
  return report.completed;
}

}  // namespace

record::Growth follow_disturbance(scene::Scene& session, const FollowedRun& run, double size, bool repeats) {
  const log::WithoutWarnings quiet;
  scene::Assembly assembly(session);
  time::Simulation& simulation = assembly.simulation;
  std::optional<scene::Assembly> repeated;
  if (repeats) repeated.emplace(session);
  Size measure(assembly.dynamics, run);
  record::Growth growth;
  growth.omega = measure.omega();
  const double wanted = size * measure.largest();
  if (!(wanted > 0.0)) return growth;
  Vector x = Vector::Zero(run.x.rows()), v = x;
  perturb(v, 1.0);
  v = v.cwiseQuotient(assembly.system.mass.diagonal().cwiseSqrt());
  double log_size = 0.0, now = measure.of(x, v);
  growth.times.push_back(run.state_times.front());
  growth.logs.push_back(0.0);
  for (Index i = 0; i + 1 < run.x.cols(); ++i) {
    const auto next = static_cast<std::size_t>(i + 1);
    x = run.x.col(i) + (wanted / now) * x;
    v = run.v.col(i) + (wanted / now) * v;
    if (!advance(simulation, x, v, run.state_times[next])) return {{}, {}, {}, 1.0, measure.omega()};
    if (repeats) {
      Vector same_x = run.x.col(i), same_v = run.v.col(i);
      if (!advance(repeated->simulation, same_x, same_v, run.state_times[next]))
        return {{}, {}, {}, 1.0, measure.omega()};
      x -= same_x;
      v -= same_v;
    } else {
      x -= run.x.col(i + 1);
      v -= run.v.col(i + 1);
    }
    now = std::max(measure.of(x, v), kLost * wanted);
    const double before = log_size;
    log_size += std::log(now / wanted);
    growth.times.push_back(run.state_times[next]);
    growth.logs.push_back(log_size);
    growth.displacement_logs.push_back(before + std::log(measure.of_displacement(x) / wanted));
  }
  return growth;
}

}  // namespace butee::app::trust
