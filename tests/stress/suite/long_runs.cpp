#include "long_runs.hpp"

#include <cmath>
#include <ctime>

#include <butee/core/text.hpp>

namespace butee::stress {
namespace {

constexpr double kPeriod = 0.0628;  ///< s, period of the load
/// Steps in a period: for fixed-step methods, and approximately for methods with error control.
constexpr double kFixedSteps = 200.0, kChosenSteps = 40.0;
/// Accepted relative difference between the second tenth of a run, after transients, and the last tenth.
constexpr double kAlike = 0.1;

std::string scene(const Method& method, double end_time) {
  std::string text =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 1e4\ndamping = 20.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1e-3\nstiffness = "
      "1e5\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 20.0\nangular_frequency = 100.05\n"
      "[integrator]\ntype = \"" +
      method.name + "\"\nend_time = " + to_text(end_time) + "\n";
  if (method.is_controlled || method.is_foreign) return text + "tolerance = 1e-4\n";
  text += "time_step = " + to_text(kPeriod / kFixedSteps) + "\n";
  if (method.name == "rk4_fixed_factors") text += "shrink = 1.3\ngrow = 1.5\ntolerance = 1e-4\n";
  if (method.name == "rk4_error_scaled") text += "safety = 0.8\ntolerance = 1e-4\n";
  if (method.name == "newmark" || method.name == "newmark_adaptive")
    text += "residual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations = 30\n";
  if (method.name == "newmark_adaptive" || method.name == "newmark_modified_adaptive") text += "target_error = 1e-4\n";
  return text;
}

class Tenths final : public time::Observer {
 public:
  explicit Tenths(double end_time) : end_time_(end_time) {}
  void step(const time::AcceptedStep& step) override {
    if (!std::isfinite(step.to.x[0] + step.to.v[0] + step.to.a[0])) is_finite = false;
    take(step.to.t, step.to.x[0]);
    // In some methods a step covers much of the run.
    const Index dof = 0;
    for (const double t : step.motion.breakpoints()) {
      double x = 0.0;
      step.motion.interpolate(t, {&dof, 1}, {{&x, 1}, {}, {}});
      take(t, x);
    }
  }
  double first = 0.0, last = 0.0;
  bool is_finite = true;

 private:
  void take(double t, double x) {
    const double part = t / end_time_;
    if (part > 0.1 && part <= 0.2) first = std::max(first, std::abs(x));
    if (part > 0.9) last = std::max(last, std::abs(x));
  }
  double end_time_;
};

}  // namespace

LongRun run_long(const Method& method, std::int64_t steps) {
  LongRun result;
  const double end_time =
      kPeriod * static_cast<double>(steps) / (method.is_controlled || method.is_foreign ? kChosenSteps : kFixedSteps);
  test::SceneRun run(scene(method, end_time));
  Tenths tenths(end_time);
  run.simulation().add(tenths);
  const std::clock_t begin = std::clock();
  const time::RunReport& report = run.run();
  result.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  result.steps = report.steps;
  result.first = tenths.first;
  result.last = tenths.last;
  result.message = report.message;
  if (report.completed)
    result.message =
        "largest displacement " + to_short_text(tenths.first) + " m, later " + to_short_text(tenths.last) + " m";
  result.is_sound = report.completed && tenths.is_finite && tenths.first > 0.0 &&
                    std::abs(tenths.last - tenths.first) <= kAlike * tenths.first;
  return result;
}

}  // namespace butee::stress
