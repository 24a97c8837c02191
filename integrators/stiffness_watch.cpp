#include "integrators/stiffness_watch.hpp"

#include <cmath>
#include <string>

#include "butee/core/log.hpp"
#include "butee/core/text.hpp"

namespace butee::integrators {
namespace {

constexpr int kInARow = 15;
/// Steps above this fraction of the limit count as near it.
constexpr double kNear = 0.9;

}  // namespace

void StiffnessWatch::look(double t, double h, double accelerations, double displacements) {
  if (has_warned_ || !(displacements > 0.0)) return;
  near_ = h * std::sqrt(accelerations / displacements) > kNear * limit_ ? near_ + 1 : 0;
  if (near_ < kInARow) return;
  has_warned_ = true;
  log::warning(std::string(method_) + ": from t = " + to_short_text(t) +
               " s on stability and not accuracy limits the steps (h = " + to_short_text(h) +
               " s): the scene is stiff for an explicit method; exponential, rodas4 or generalized_alpha_adaptive take "
               "longer steps");
}

}  // namespace butee::integrators
