#include "integrators/exponential/contact_newton.hpp"

#include <gtest/gtest.h>

#include "integrators/exponential/contact_force.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_newton_test {
namespace {

using integrators::ContactForce;
using integrators::ContactNewton;
using integrators::ContactPath;
using integrators::ContactStatus;
using integrators::ForceMoments;
using integrators::PathCoupling;
using integrators::Projection;

constexpr double kStiffness = 3.0;
const std::string kScene = mass_on_spring("1.0", R"(
[[contact]]
type = "stop"
nodes = "m"
gap = 0.5
stiffness = 3.0
)");
/// Coupling of a path's end, velocity and middle to the force moments P_0, P_1 and P_2, as for a mass in a
/// step of h = 0.6.
constexpr PathCoupling kCoupling = {{{0.18, -0.06, 0.0}, {0.36, 0.0, 0.0}, {0.045, -0.0375, 0.0225}}};

/// The path from w = w0 with h w' = hv0. Without the stop it ends at 0.7 with h w' = -0.4; the force
/// displaces it.
ContactPath moved_path(double w0, double hv0, const ForceMoments& f) {
  std::array<double, 3> end = {0.7, -0.4, 0.75};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t k = 0; k < 3; ++k) end[row] += kCoupling[row][k] * f[k];
  const double quartic = end[2] - 0.5 * (w0 + end[0]) - 0.125 * (hv0 - end[1]);
  return {w0, hv0, end[0], end[1], quartic};
}

TEST(ContactNewton, SolvesAClosedStopInOneStep) {
  SceneRun run(kScene);
  ContactForce force(run.dynamics().stops(), 0);
  const ContactNewton newton(kStiffness);
  const ContactPath start = moved_path(0.9, -0.1, {});
  const ForceMoments f = newton.correction(newton.closed_inverse(kCoupling), force.of_spring(start), {});
  const ContactPath path = moved_path(0.9, -0.1, f);
  ASSERT_EQ(force.status(path), ContactStatus::closed);
  const ForceMoments projected = force.of_spring(path);
  for (std::size_t k = 0; k < f.size(); ++k) EXPECT_NEAR(f[k], projected[k], 1e-14) << k;
}

/// The boundary of the closed interval moves with the path, but the force there is zero. The inverse computed
/// with a fixed interval is therefore that of the exact derivative.
TEST(ContactNewton, HasTheDerivativeOfAStopThatCloses) {
  SceneRun run(kScene);
  ContactForce force(run.dynamics().stops(), 0);
  const ContactNewton newton(kStiffness);
  const ForceMoments f = {-0.2, 0.1, 0.05};
  const auto project = [&](const ForceMoments& at) {
    const ContactPath path = moved_path(0.2, 0.9, at);
    EXPECT_EQ(force.status(path), ContactStatus::changing);
    return force.project(path, ContactStatus::changing);
  };
  const ContactNewton::Matrix inverse = newton.inverse(project(f).closed, kCoupling);
  // The closing point is found to some 1e-14, which the difference quotient divides by the step.
  constexpr double kStep = 1e-5;
  for (std::size_t column = 0; column < 3; ++column) {
    ForceMoments more = f, less = f;
    more[column] += kStep;
    less[column] -= kStep;
    const ForceMoments high = project(more).force, low = project(less).force;
    for (std::size_t row = 0; row < 3; ++row) {
      double product = 0.0;  // inverse (1 - dP/df) = 1
      for (std::size_t k = 0; k < 3; ++k)
        product += inverse[3 * row + k] * ((k == column ? 1.0 : 0.0) - (high[k] - low[k]) / (2.0 * kStep));
      EXPECT_NEAR(product, row == column ? 1.0 : 0.0, 1e-8) << row << " " << column;
    }
  }
}

}  // namespace
}  // namespace butee::test::contact_newton_test
