// Two beams, each a separate Structure, coupled at their middles by a spring that neither scene contains. They are
// solved alternately in time windows (partitioned iteration) and compared with one scene that contains both beams and
// the spring.
#include <cmath>
#include <cstdio>
#include <exception>

#include <butee/embed/structure.hpp>

using butee::Index;
using butee::embed::Structure;

namespace {

constexpr double kStiffness = 2.0e4;  // N/m, of the spring
constexpr double kEnd = 0.2;          // s

/// The largest difference between the first beam's middle and that of the single model, over its peak.
double difference(double window) {
  Structure drill = Structure::from_file("beam.toml", {.forced = {"string:middle"}});
  Structure casing = Structure::from_file("casing.toml", {.forced = {"casing:middle"}});
  Structure both = Structure::from_file("two-beams.toml");
  const Index a = drill.dof("string:middle"), b = casing.dof("casing:middle"), together = both.dof("string:middle");
  double force = 0.0, largest = 0.0, peak = 0.0;
  int turns = 0;
  const int windows = static_cast<int>(std::round(kEnd / window));
  for (int i = 1; i <= windows; ++i) {
    const double t = i * window;
    const auto drill_before = drill.snapshot(), casing_before = casing.snapshot();
    double next = force;
    for (int turn = 0;; ++turn) {
      const double guess = next;
      drill.set_force(a, -force, -guess, t);
      casing.set_force(b, force, guess, t);
      drill.advance_to(t);
      casing.advance_to(t);
      next = kStiffness * (drill.displacement(a) - casing.displacement(b));
      ++turns;
      if (std::abs(next - guess) <= 1e-10 * (1.0 + std::abs(next)) || turn == 30) break;
      drill.restore(drill_before);
      casing.restore(casing_before);
    }
    force = next;
    both.advance_to(t);
    largest = std::fmax(largest, std::abs(both.displacement(together) - drill.displacement(a)));
    peak = std::fmax(peak, std::abs(both.displacement(together)));
  }
  std::printf("windows of %g s: %.1e of the peak, %.2f turns a window\n", window, largest / peak,
              static_cast<double>(turns) / windows);
  return largest / peak;
}

}  // namespace

int main() {
  try {
    const double coarse = difference(4e-4), fine = difference(1e-4);
    // Forces are linear in each window, which gives second order; impacts on a stop reduce it somewhat.
    return fine < 1e-3 && fine < 0.25 * coarse ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
