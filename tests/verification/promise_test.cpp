// The error bound promised by every method with local error control (integrators/error-control.md): the error
// of each displacement, rotation and velocity, relative to its own scale, is at most 10 tolerance max(1,
// Gamma). The method `exact`, whose pieces have no truncation error, gives the references and Gamma, the
// growth of disturbances.
#include <algorithm>
#include <cmath>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "verification/promise_scenes.hpp"

namespace butee::test::promise_test {
namespace {

constexpr double kPromise = 10.0, kFloor = 1e-3;
constexpr int kRows = 200;

/// All components at all rows: x and v, one column for each row.
struct Motion {
  Eigen::MatrixXd x, v;
};

class Recorder final : public time::Observer {
 public:
  Recorder(Index size, double end_time) : end_time_(end_time) {
    motion.x.resize(size, kRows);
    motion.v.resize(size, kRows);
    for (Index i = 0; i < size; ++i) dofs_.push_back(i);
  }
  void start(const time::State&) override {}
  void step(const time::AcceptedStep& step) override {
    for (; row_ < kRows && instant() <= step.to.t; ++row_) {
      std::vector<double> x(dofs_.size()), v(dofs_.size());
      step.motion.interpolate(instant(), dofs_, {x, v, {}});
      motion.x.col(row_) = Eigen::Map<const Vector>(x.data(), motion.x.rows());
      motion.v.col(row_) = Eigen::Map<const Vector>(v.data(), motion.v.rows());
    }
  }
  double next_instant(double) const override {
    return row_ < kRows ? instant() : std::numeric_limits<double>::infinity();
  }

  Motion motion;

 private:
  double instant() const { return end_time_ * static_cast<double>(row_ + 1) / kRows; }

  double end_time_;
  std::vector<Index> dofs_;
  Index row_ = 0;
};

/// A complete run; at one of ten instants, `disturbed`, x and v change by `change` times their scales (-1: no
/// disturbance).
Motion motion_of(const Scene& scene, const std::string& keys, int disturbed = -1, double change = 0.0,
                 const Motion* scales = nullptr) {
  SceneRun run("schema = 1\n" + std::string(scene.text) + "[integrator]\nend_time = " + to_text(scene.end_time) + "\n" +
               keys);
  const Index size = run.dynamics().size();
  Recorder recorder(size, scene.end_time);
  run.simulation().add(recorder);
  if (disturbed >= 0) {
    const Index row = disturbed * kRows / 10;
    const double t = scene.end_time * static_cast<double>(row) / kRows;
    if (t > 0.0) {
      run.simulation().set_end_time(t);
      EXPECT_TRUE(run.run().completed);
      run.simulation().set_end_time(scene.end_time);
    }
    run.simulation().start();
    Vector x = run.simulation().state().x, v = run.simulation().state().v;
    for (Index i = 0; i < size; ++i) {
      x[i] += (i % 2 == 0 ? change : -change) * scales->x(i, row);
      v[i] += (i % 3 == 0 ? change : -change) * scales->v(i, row);
    }
    run.simulation().set_motion(x, v);
  }
  EXPECT_TRUE(run.run().completed) << scene.name << " " << keys;
  return recorder.motion;
}

/// The scales S of each component at each row.
Motion scales_of(const Motion& motion, const std::vector<bool>& is_rotation) {
  Motion scales = motion;
  for (Eigen::MatrixXd* all : {&scales.x, &scales.v}) {
    double largest[2] = {};
    for (Index i = 0; i < all->rows(); ++i) {
      double& of_kind = largest[is_rotation[static_cast<std::size_t>(i)] ? 1 : 0];
      of_kind = std::max(of_kind, all->row(i).cwiseAbs().maxCoeff());
    }
    for (Index i = 0; i < all->rows(); ++i) {
      double so_far = kFloor * largest[is_rotation[static_cast<std::size_t>(i)] ? 1 : 0];
      for (Index row = 0; row < all->cols(); ++row)
        (*all)(i, row) = so_far = std::max(so_far, std::abs((*all)(i, row)));
    }
  }
  return scales;
}

/// e at each row. Velocities are ignored if a stop is about to close or open.
Vector error_of(const Motion& motion, const Motion& reference, const Motion& scales, const Vector& is_near) {
  Vector e = Vector::Zero(kRows);
  for (Index row = 0; row < kRows; ++row) {
    e[row] = ((motion.x.col(row) - reference.x.col(row)).array().abs() / scales.x.col(row).array()).maxCoeff();
    if (is_near[row] == 0.0)
      e[row] = std::max(
          e[row], ((motion.v.col(row) - reference.v.col(row)).array().abs() / scales.v.col(row).array()).maxCoeff());
  }
  return e;
}

class Promise : public testing::TestWithParam<std::string> {};

TEST_P(Promise, IsKeptForEveryComponent) {
  for (const Scene& scene : kScenes)
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      SceneRun run("schema = 1\n" + std::string(scene.text) + "[integrator]\nend_time = 1.0\ntype = \"exact\"\n");
      // exponential refuses dashpots between parts.
      if (GetParam() == "exponential" && run.dynamics().size() > 1 && run.system().dashpots.size() > 0) continue;
      std::vector<bool> is_rotation;
      for (const model::NodalDof& dof : run.system().dofs.free()) is_rotation.push_back(dof.kind == DofKind::theta);
      const Motion reference = motion_of(scene, "type = \"exact\"\n");
      const Motion scales = scales_of(reference, is_rotation);
      // Twice the compared bound, for the errors of both solutions.
      const double margin = 2.0 * kPromise * tolerance;
      Vector is_near = Vector::Zero(kRows), w(run.dynamics().stop_count()), size(run.dynamics().stop_count());
      for (Index row = 0; row < kRows; ++row) {
        run.dynamics().stops().displacement(reference.x.col(row), w);
        for (Index i = 0; i < w.size(); ++i)
          if (std::abs(std::abs(w[i]) - run.dynamics().stops().play_of(i).gap) <= margin * scales.x.col(row).maxCoeff())
            is_near[row] = 1.0;
      }
      Vector gamma = Vector::Ones(kRows);
      for (int disturbed = 0; disturbed < 10; disturbed += 3) {
        const Motion moved = motion_of(scene, "type = \"exact\"\n", disturbed, tolerance, &scales);
        Vector growth = error_of(moved, reference, scales, is_near) / tolerance;
        growth.head(disturbed * kRows / 10).setZero();
        for (Index row = 0; row < kRows; ++row)
          gamma[row] = std::max({gamma[row], growth[row], row > 0 ? gamma[row - 1] : 1.0});
      }
      const Motion motion = motion_of(scene, "type = \"" + GetParam() + "\"\ntolerance = " + to_text(tolerance) + "\n");
      const Vector e = error_of(motion, reference, scales, is_near);
      const double worst = (e.array() / gamma.array()).maxCoeff() / tolerance;
      EXPECT_LE(worst, kPromise) << scene.name << " at " << tolerance;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Promise,
                         testing::Values("auto", "exponential", "rodas4", "dopri5", "extrapolation8", "bathe_adaptive",
                                         "generalized_alpha_adaptive", "hht_alpha_adaptive",
                                         "discrete_gradient_adaptive", "central_differences_adaptive"),
                         [](const auto& one) { return one.param; });

TEST(PromiseTest, SeesWhatIsBroken) {
  // The error of this method in one light part is a tenth of its motion, at a tolerance of 1e-4.
  const Scene& scene = kScenes[1];
  const Motion reference = motion_of(scene, "type = \"exact\"\n");
  const Motion scales = scales_of(reference, {false, false});
  const Motion coarse = motion_of(scene, "type = \"newmark\"\ntime_step = 5e-4\n");
  EXPECT_GT(error_of(coarse, reference, scales, Vector::Zero(kRows)).maxCoeff(), 0.05);
}

TEST(PromiseTest, MethodsOfOrderTwoRefuseTolerancesThatTheyCannotKeep) {
  EXPECT_THROW(SceneRun("schema = 1\n" + std::string(kHardStop) +
                        "[integrator]\nend_time = 1.0\ntype = \"bathe_adaptive\"\ntolerance = 1e-7\n"),
               InputError);
}

}  // namespace
}  // namespace butee::test::promise_test
