#include "perturb.hpp"

#include <cmath>

namespace butee::app {

void perturb(Vector& x, double size) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  for (Index i = 0; i < x.size(); ++i) {
    const double turns = kGoldenRatio * static_cast<double>(i + 1);
    x[i] += size * (2.0 * (turns - std::floor(turns)) - 1.0);
  }
}

std::function<void(model::System&)> perturbed_by(double size) {
  if (size == 0.0) return {};
  return [size](model::System& system) { perturb(system.initial_displacement, size); };
}

}  // namespace butee::app
