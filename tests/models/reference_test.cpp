// RK4 with small steps against the exact solution of the piecewise linear problem
// (tests/benchmark/plain/reference.cpp).
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::reference_test {
namespace {

struct Comparison {
  std::string scene, node, time_step;  // s
  double end_time;
  double tolerance;  // of the relative rms of u
};

// Slope discontinuities of the linear law reduce the order of RK4: the error is of second order in the step,
// times the number of impacts.
constexpr double kBeamTolerance = 1e-6;
// A period of the closed oscillator is 6e-4 s and it strikes its stops 71 times, so it needs a smaller step.
constexpr double kOscillatorTolerance = 1e-5;
// beam4 is chaotic: errors grow like e^(20 t).
constexpr double kChaoticTolerance = 1e-5;

void PrintTo(const Comparison& comparison, std::ostream* stream) {
  *stream << comparison.scene;
}  // called by GoogleTest

std::string name_of(const testing::TestParamInfo<Comparison>& info) {
  return info.param.scene;
}

class Reference : public testing::TestWithParam<Comparison> {};

TEST_P(Reference, IsMetByRk4WithSmallSteps) {
  const Comparison& c = GetParam();
  const CsvTable table(std::string(BUTEE_TEST_DATA) + "/models/reference/" + c.scene + "-linear.csv");
  std::vector<double> times = table.column("t"), u = table.column("u0");
  while (times.back() > c.end_time * (1.0 + 1e-9)) {
    times.pop_back();
    u.pop_back();
  }

  std::string text = read_file(model_path(c.scene));
  for (const auto& [start, by] :
       {std::pair{"\nlaw ", "\nlaw = \"linear\" #"}, std::pair{"\nregularization ", "\n# "}}) {
    const std::size_t at = text.find(start);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, std::string(start).size(), by);
  }
  SceneRun scene(text, {"integrator.type=RK4-1", "integrator.time_step=" + c.time_step,
                        "integrator.end_time=" + std::to_string(c.end_time)});
  Sampler sampler(scene.dof(c.node), times);
  scene.simulation().add(sampler);
  const time::RunReport& report = scene.run();
  ASSERT_TRUE(report.completed) << report.message;
  EXPECT_LT(relative_rms(sampler.x, u), c.tolerance);
}

INSTANTIATE_TEST_SUITE_P(OfThePaper, Reference,
                         testing::Values(Comparison{"oscillator", "rotor", "1e-7", 0.2, kOscillatorTolerance},
                                         Comparison{"beam1", "string:middle", "1e-5", 1.0, kBeamTolerance},
                                         Comparison{"beam2", "string:middle", "1e-5", 1.0, kBeamTolerance},
                                         Comparison{"beam3", "string:middle", "1e-5", 1.0, kBeamTolerance},
                                         Comparison{"beam4", "string:middle", "1e-5", 0.3, kChaoticTolerance}),
                         name_of);

}  // namespace
}  // namespace butee::test::reference_test
