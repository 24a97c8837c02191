// End error of methods with error control as a function of the tolerance, from 1e-2 to 1e-7 (order 2: 1e-6),
// on a forced oscillator that strikes a stop repeatedly, compared with the method `exact`.
#include <cmath>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::tolerance_test {
namespace {

std::string scene(const std::string& integrator) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
         "\"b\"\nmass = "
         "2.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 40.0\n[[element]]\ntype = \"spring\"\nnodes = "
         "[\"a\", "
         "\"b\"]\nstiffness = 60.0\n[damping]\nmass_proportional = 0.4\nstiffness_proportional = 2e-3\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 0.05\nstiffness = 4000.0\nlaw = \"linear\"\nsides = "
         "\"positive\"\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b\"\namplitude = 9.0\nangular_frequency = 5.3\n"
         "[initial]\nvelocity = [{nodes = \"b\", value = -0.9}]\n[integrator]\nend_time = 4.0\n" +
         integrator;
}

std::vector<double> course(const std::string& integrator, Index* impacts = nullptr) {
  std::vector<double> times;
  for (int i = 1; i <= 400; ++i) times.push_back(0.01 * i);
  SceneRun run(scene(integrator));
  Sampler sampler(run.dof("a"), times);
  run.simulation().add(sampler);
  record::ImpactRecorder recorder(run.dynamics());
  if (impacts != nullptr) run.simulation().add(recorder);
  EXPECT_TRUE(run.run().completed) << integrator;
  if (impacts != nullptr) *impacts = static_cast<Index>(recorder.impacts().size());
  return sampler.x;
}

class Tolerance : public testing::TestWithParam<std::string> {};

TEST_P(Tolerance, IsWhatComesOut) {
  // Factor by which this scene amplifies an initial disturbance until its end, as measured by the last test.
  constexpr double kAmplification = 3.0, kReserve = 10.0;
  const std::vector<double> reference = course("type = \"exact\"\ntime_step = 1e-3\n");
  double slope = 0.0, squares = 0.0;
  std::string errors;
  const bool is_of_order_two = GetParam().ends_with("_adaptive");
  const int last = is_of_order_two ? 4 : 5;
  for (int i = 0; i <= last; ++i) {
    const double tolerance = std::pow(10.0, -2.0 - i);
    const double error =
        relative_rms(course("type = \"" + GetParam() + "\"\ntolerance = " + to_text(tolerance) + "\n"), reference);
    EXPECT_LE(error, kReserve * kAmplification * tolerance) << "at " << tolerance;
    errors += to_short_text(error) + " ";
    const double decades = -(i - 0.5 * last);
    slope += decades * std::log10(error);
    squares += decades * decades;
  }
  slope /= squares;
  EXPECT_GE(slope, 0.8) << errors;
  EXPECT_LE(slope, 1.2) << errors;
}

INSTANTIATE_TEST_SUITE_P(Methods, Tolerance,
                         testing::Values("exponential", "rodas4", "dopri5", "extrapolation8", "bathe_adaptive",
                                         "generalized_alpha_adaptive", "hht_alpha_adaptive",
                                         "discrete_gradient_adaptive", "central_differences_adaptive"),
                         [](const auto& one) { return one.param; });

TEST(ToleranceScene, StrikesItsStopAndMagnifiesLittle) {
  Index impacts = 0;
  const std::vector<double> first = course("type = \"exact\"\ntime_step = 1e-3\n", &impacts);
  EXPECT_GE(impacts, 4);
  SceneRun disturbed(scene("type = \"exact\"\ntime_step = 1e-3\n"), {"initial.velocity[0].value=-0.9000009"});
  std::vector<double> times;
  for (int i = 1; i <= 400; ++i) times.push_back(0.01 * i);
  Sampler sampler(disturbed.dof("a"), times);
  disturbed.simulation().add(sampler);
  ASSERT_TRUE(disturbed.run().completed);
  // A relative change of 1e-6 of the initial velocity.
  EXPECT_LT(relative_rms(sampler.x, first), 3e-6);
}

}  // namespace
}  // namespace butee::test::tolerance_test
