#include "integrators/exponential/propagation.hpp"

#include <cmath>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::propagation_test {
namespace {

using Eigen::ArrayXd;
using integrators::Phase;

/// omega = 2 rad/s; a harmonic load of 3 N at 5 rad/s, and a ramp to 4 N in 2 s.
const std::string kScene = mass_on_spring("4.0", R"(
[[load]]
type = "harmonic"
node = "m"
amplitude = 3.0
angular_frequency = 5.0
[[load]]
type = "table"
node = "m"
times = [0.0, 2.0]
values = [0.0, 4.0]
)");

struct Motion {
  ArrayXd q, v;
};

Motion propagated(dynamics::ModalSystem& modal, const Motion& from, double t, double t_end, double force) {
  const std::vector<Phase> phases = {{std::cos(5.0 * t), std::sin(5.0 * t)}};
  const ArrayXd constant = ArrayXd::Constant(1, force);
  Motion to;
  integrators::propagate(modal, modal.odd(t_end - t).whole, {t, from.q, from.v, phases, &constant}, t_end, to.q, &to.v);
  return to;
}

TEST(Propagation, IsExactForConstantLinearAndHarmonicLoads) {
  SceneRun run(kScene);
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  // The responses from rest to 0.7, to 2 t and to c cos 5 t + s sin 5 t.
  const model::TimeFunction& load = *run.system().loads[0].in_time;
  const double weight = run.system().loads[0].weights[0], c = weight * load.value(0.0),
               s = weight * load.value(std::acos(-1.0) / 10.0);
  const double omega = 2.0, t = 0.9, hold = 1.0 / (4.0 - 25.0), sign = modal.shapes()(0, 0);
  const Motion rest = {ArrayXd::Zero(1), ArrayXd::Zero(1)};
  const Motion found = propagated(modal, rest, 0.0, t, sign * 0.7);
  const double expected = 0.7 / 4.0 * (1.0 - std::cos(omega * t)) + 2.0 / 4.0 * (t - std::sin(omega * t) / omega) +
                          hold * (c * (std::cos(5.0 * t) - std::cos(omega * t)) +
                                  s * (std::sin(5.0 * t) - 5.0 / omega * std::sin(omega * t)));
  EXPECT_NEAR(sign * found.q[0], expected, 1e-14);
}

TEST(Propagation, OverTwoHalvesIsThatOverTheWhole) {
  SceneRun run(kScene);
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  const Motion from = {ArrayXd::Constant(1, 0.3), ArrayXd::Constant(1, -1.1)};
  const Motion whole = propagated(modal, from, 0.2, 1.4, 0.5);
  const Motion halves = propagated(modal, propagated(modal, from, 0.2, 0.8, 0.5), 0.8, 1.4, 0.5);
  EXPECT_NEAR(whole.q[0], halves.q[0], 1e-14);
  EXPECT_NEAR(whole.v[0], halves.v[0], 1e-14);
}

}  // namespace
}  // namespace butee::test::propagation_test
