#include <butee/record/contact_recorder.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_recorder_test {
namespace {

/// A uniform motion that counts how often it is asked for.
class UniformMotion final : public time::Interpolant {
 public:
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override {
    ++count;
    for (std::size_t k = 0; k < dofs.size(); ++k) {
      const Index dof = dofs[k];
      if (!out.x.empty()) out.x[k] = from.x[dof] + from.v[dof] * (t - from.t);
      if (!out.v.empty()) out.v[k] = to.v[dof];
    }
  }
  int count = 0;
};

/// The normal force of a friction support is constant, so that no largest one is sought between the 10 instants of
/// Gauss' rule and the ends of the two parts of a step. The work is mu N times the way.
TEST(ContactRecorder, SeeksNoMaximumOfAConstantForce) {
  SceneRun run(mass_on_spring("1.0",
                              "[[contact]]\ntype = \"friction\"\nnodes = \"m\"\ndof = \"u\"\nnormal_force = 50.0\n"
                              "friction = { coefficient = 0.3, slip_speed = 1e-6 }\n"));
  record::ContactRecorder recorder(run.dynamics());
  run.dynamics().obstacles()->follow_live();
  const Vector speed = Vector::Constant(1, 2.0);
  const auto at = [&](double t) { return time::State{t, t * speed, speed, Vector::Zero(1), {}, {}}; };
  constexpr int kSteps = 5;
  UniformMotion motion;
  recorder.start(at(0.0));
  for (int i = 0; i < kSteps; ++i) {
    const time::State from = at(i), to = at(i + 1.0);
    recorder.step({from, to, 1.0, {motion, from, to}, 0.0});
  }
  EXPECT_LE(motion.count, kSteps * 12);
  EXPECT_DOUBLE_EQ(recorder.wear()[0].peak_force, 50.0);
  EXPECT_NEAR(recorder.wear()[0].work, 50.0 * 2.0 * kSteps, 1e-9);
  EXPECT_NEAR(recorder.wear()[0].dissipated, 0.3 * 50.0 * 2.0 * kSteps, 1e-9);
}

}  // namespace
}  // namespace butee::test::contact_recorder_test
