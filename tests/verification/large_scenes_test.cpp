// Long beams and many coupled beams: counts and errors. tests/benchmark measures their cost.
#include "support/large_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::large_scenes_test {
namespace {

// The same equations solved with a band factor for one beam and with a sparse factor for sixteen: rounding
// only.
constexpr double kRounding = 1e-9;
// Newmark's error over 2 ms at 1e-4 s, including the contact change; Runge-Kutta is more accurate.
constexpr double kMethodsApart = 0.02;
constexpr int kSteps = 20;
constexpr double kGap = 1e-3, kTie = 1e5;
constexpr int kTiedNode = 10;

struct Large {
  int dofs;
  std::string method;
};

void PrintTo(const Large& large, std::ostream* stream) {
  *stream << large.dofs << " DOFs, " << large.method;
}

SceneRun make(const std::string& scene, const std::string& method) {
  return SceneRun(scene, {"integrator.type=" + method});
}

const Vector& displacement_after_steps(SceneRun& scene) {
  for (int i = 0; i < kSteps; ++i) EXPECT_TRUE(scene.simulation().advance()) << scene.simulation().report().message;
  return scene.simulation().state().x;
}

/// The number of coupling springs between different beams.
Index count_ties(const SparseMatrix& stiffness, Index dofs_of_one) {
  constexpr double kSame = 1e-12;
  Index count = 0;
  for (Index j = 0; j < stiffness.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(stiffness, j); entry; ++entry)
      if (entry.row() / dofs_of_one < j / dofs_of_one && std::abs(entry.value() + kTie) < kSame * kTie) ++count;
  return count;
}

class LargeScenes : public testing::TestWithParam<Large> {};

TEST_P(LargeScenes, HoldWhatTheyDescribe) {
  const int wanted = GetParam().dofs, elements = elements_of_tied_beams(wanted);
  SceneRun one = make(long_beam(elements_of_long_beam(wanted)), GetParam().method);
  EXPECT_EQ(one.system().size(), wanted);
  EXPECT_EQ(one.system().dofs.fixed_count(), 2);
  EXPECT_EQ(one.dynamics().stop_count(), 1);

  SceneRun tied = make(tied_beams(elements), GetParam().method);
  EXPECT_NEAR(static_cast<double>(tied.system().size()), wanted, 2.0 * kTiedBeams);
  EXPECT_EQ(tied.system().size(), kTiedBeams * dofs_of_beam(elements));
  EXPECT_EQ(tied.system().dofs.fixed_count(), 2 * kTiedBeams);
  EXPECT_EQ(tied.dynamics().stop_count(), kTiedBeams);
  EXPECT_EQ(static_cast<int>(tied.system().loads.size()), kTiedBeams);
  const Index ties = (elements - 1) / kTiedNode;
  EXPECT_EQ(count_ties(tied.system().stiffness, dofs_of_beam(elements)), (kTiedBeams - 1) * ties);
}

/// Springs between beams with equal motion carry no force, so each of the sixteen moves like a single beam.
TEST_P(LargeScenes, TiedBeamsLoadedAlikeMoveLikeOne) {
  const int elements = elements_of_tied_beams(GetParam().dofs);
  SceneRun one = make(long_beam(elements), GetParam().method), tied = make(tied_beams(elements), GetParam().method);
  const Vector expected = displacement_after_steps(one), x = displacement_after_steps(tied);
  EXPECT_GT(expected[one.dof("b0:middle")], kGap);
  const Index n = dofs_of_beam(elements);
  ASSERT_EQ(x.size(), kTiedBeams * n);
  for (Index beam = 0; beam < kTiedBeams; ++beam)
    EXPECT_LE((x.segment(beam * n, n) - expected).norm(), kRounding * expected.norm()) << "beam " << beam;
}

TEST_P(LargeScenes, TheMethodsAgree) {
  SceneRun scene = make(long_beam(elements_of_long_beam(GetParam().dofs)), GetParam().method);
  SceneRun fine(long_beam(elements_of_long_beam(GetParam().dofs)),
                {"integrator.type=RK4-1", "integrator.time_step=2e-5"});
  const Vector x = displacement_after_steps(scene);
  for (int i = 0; i < 5 * kSteps; ++i) ASSERT_TRUE(fine.simulation().advance());
  const Vector& expected = fine.simulation().state().x;
  EXPECT_LE((x - expected).norm(), kMethodsApart * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(OneAndSixteen, LargeScenes,
                         testing::Values(Large{1000, "NM1"}, Large{1000, "RK4-1"}, Large{10000, "NM1"},
                                         Large{10000, "RK4-1"}),
                         [](const auto& one) {
                           std::string name = std::to_string(one.param.dofs) + "_" + one.param.method;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace butee::test::large_scenes_test
