#include "integrators/exponential/contact_force.hpp"

#include <cmath>
#include <random>

#include <butee/core/text.hpp>
#include <butee/dynamics/elastic_stops.hpp>
#include <gtest/gtest.h>

#include "contact/arctan.hpp"
#include "contact/linear.hpp"
#include "integrators/exponential/residual_force.hpp"
#include "support/scene_run.hpp"

namespace butee::test::contact_force_test {
namespace {

using integrators::ContactForce;
using integrators::ContactPath;
using integrators::ContactStatus;
using integrators::ForceMoments;

std::string scene(const std::string& law, const std::string& sides) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\nstiffness = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.5\nstiffness = 3.0\nsides = \"" +
         sides + "\"\n" + law + "\n[integrator]\ntype = \"rk4\"\ntime_step = 0.1\nend_time = 1.0\n";
}

/// The moments by Simpson's rule with very many intervals.
ForceMoments by_simpson(dynamics::ElasticStops& contact, const ContactPath& path) {
  constexpr int kIntervals = 200000;
  ForceMoments sum{};
  for (int i = 0; i <= kIntervals; ++i) {
    const double s = static_cast<double>(i) / kIntervals;
    const double weight = (i == 0 || i == kIntervals ? 1.0 : i % 2 == 0 ? 2.0 : 4.0) / (3.0 * kIntervals);
    const double force = weight * contact.force_of(0, path.value(s));
    sum[0] += force;
    sum[1] += 3.0 * force * (2.0 * s - 1.0);
    sum[2] += 5.0 * force * (6.0 * s * s - 6.0 * s + 1.0);
  }
  return sum;
}

/// Compares random paths (end values and quartic terms) around a gap of 0.5. Returns the number of paths
/// along which the stop acts as a spring.
int compare(const std::string& law, double tolerance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  std::array<int, 4> seen{};
  int springs = 0;
  for (const std::string sides : {"both", "positive", "negative"}) {
    SceneRun run(scene(law, sides));
    dynamics::ElasticStops& contact = run.dynamics().stops();
    ContactForce force(contact, 0);
    for (int i = 0; i < 60; ++i) {
      const double w0 = number(random), w1 = i % 3 == 0 ? w0 + 0.1 * number(random) : number(random);
      const ContactPath path(w0, number(random), w1, number(random), 0.2 * number(random));
      const ContactStatus status = force.status(path);
      ++seen[static_cast<std::size_t>(status)];
      const ForceMoments computed = force.project(path, status).force, expected = by_simpson(contact, path);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(computed[k], expected[k], tolerance) << sides << " " << i;
      if (!force.is_spring(path, status)) continue;
      ++springs;
      const ForceMoments of_spring = force.of_spring(path);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(of_spring[k], expected[k], tolerance) << sides << " " << i;
    }
  }
  EXPECT_GT(seen[static_cast<std::size_t>(ContactStatus::changing)], 20);
  return springs;
}

TEST(ContactPath, MeetsItsEndsAndItsMiddle) {
  const ContactPath path(1.0, 2.0, -3.0, 4.0, 0.7);
  EXPECT_NEAR(path.value(0.0), 1.0, 1e-15);
  EXPECT_NEAR(path.value(1.0), -3.0, 1e-14);
  EXPECT_NEAR(path.value(0.5), 0.5 * (1.0 - 3.0) + 0.125 * (2.0 - 4.0) + 0.7, 1e-15);
  EXPECT_NEAR((path.value(1e-6) - path.value(0.0)) / 1e-6, 2.0, 1e-4);
  EXPECT_NEAR((path.value(1.0) - path.value(1.0 - 1e-6)) / 1e-6, 4.0, 1e-4);
  for (double s = 0.0; s <= 1.0; s += 0.01) {
    EXPECT_LE(path.lowest(), path.value(s));
    EXPECT_GE(path.highest(), path.value(s));
  }
}

// At each slope discontinuity Simpson's rule has an error of (slope of F)(1/200000)^2.
TEST(ContactForce, OfALinearLawIsExact) {
  EXPECT_GT(compare("law = \"linear\"", 1e-9), 5);
}

// With panels of three Gauss points the error is 1e-4 of the force for the worst random path, if the law's
// transition is 1 % of the gap wide; it is much smaller for a transition as narrow as in the paper.
TEST(ContactForce, OfASmoothLawIsCloseToItsIntegral) {
  EXPECT_GT(compare("law = \"arctan\"\nregularization = 1e5", 1e-5), 5);
  compare("law = \"arctan\"\nregularization = 1e2", 1e-4);
}

TEST(ContactForce, OfASmoothLawIsCloseBesideABendThatThePathEndsAt) {
  for (const double lambda : {1e2, 1e3}) {
    SceneRun run(scene("law = \"arctan\"\nregularization = " + to_text(lambda), "both"));
    dynamics::ElasticStops& contact = run.dynamics().stops();
    ContactForce force(contact, 0);
    for (const double beside : {-1e-2, -1e-3, -1e-4, 1e-4, 1e-3, 1e-2})
      for (const double from : {0.3, 0.7})
        for (const bool at_end : {true, false}) {
          const double to = 0.5 + beside, slope = 1.2 * (to - from);
          const ContactPath path =
              at_end ? ContactPath(from, slope, to, slope, 0.0) : ContactPath(to, -slope, from, -slope, 0.0);
          const ForceMoments computed = force.project(path, force.status(path)).force,
                             expected = by_simpson(contact, path);
          for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(computed[k], expected[k], 2e-6) << lambda << " " << beside << " " << from << " " << at_end;
        }
  }
}

TEST(ResidualForce, IsConstantUpToTheNextTermOfItsSeriesAndItsJump) {
  constexpr double kCompliance = 0.01, kSteps = 5.0;
  SceneRun linear(scene("law = \"linear\"", "both"));
  EXPECT_EQ(
      integrators::ResidualForce(linear.dynamics().stops(), 0).constant_error(0.1, -0.1, 0.2, kCompliance, kSteps),
      0.0);
  SceneRun run(scene("law = \"arctan\"\nregularization = 1e2", "both"));
  dynamics::ElasticStops& contact = run.dynamics().stops();
  const integrators::ResidualForce pull(contact, 0);
  // Error of the constant approximation times the square of the number of steps.
  const double off = std::abs(std::abs(contact.force_of(0, 0.25)) - pull.largest());
  const double bound = pull.constant_error(0.1, 0.2, 0.25, kCompliance, kSteps);
  EXPECT_NEAR(bound, off * kCompliance * kSteps * kSteps, 0.01 * bound);
  // Through the middle of the gap: twice the residual force, over the fraction of the path that the residual
  // force's own displacement represents.
  const double shift = pull.largest() * kCompliance;
  EXPECT_NEAR(pull.constant_error(0.1, -0.1, 0.2, kCompliance, kSteps) -
                  pull.constant_error(0.05, 0.15, 0.2, kCompliance, kSteps),
              2.0 * shift * (shift / 0.2) * kSteps, 1e-12);
  SceneRun one_sided(scene("law = \"arctan\"\nregularization = 1e2", "positive"));
  EXPECT_EQ(
      integrators::ResidualForce(one_sided.dynamics().stops(), 0).constant_error(0.1, -0.1, 0.25, kCompliance, kSteps),
      bound);
}

}  // namespace
}  // namespace butee::test::contact_force_test
