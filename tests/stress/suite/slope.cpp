#include "slope.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>

#include "work.hpp"

namespace butee::stress {
namespace {

constexpr double kAboveFloor = 10.0, kMost = 0.1;
/// Errors below this fraction of the tolerance are ignored, because other criteria then limit the steps.
constexpr double kSurplus = 0.01;
/// Gamma at this tolerance in the middle of the range sets the compared rows.
constexpr double kMiddle = 1e-5;
/// If Gamma grows by this factor for disturbances a thousand times smaller, the motion is not smooth
/// (grazing).
constexpr double kRougher = 3.0;

/// True if Gamma depends on the size of the disturbances.
bool grazes(const Scene& scene, double coarse, double fine, std::int64_t work) {
  Index rows = Reference::kRows;
  std::array<double, 2> growth{};
  std::vector<std::unique_ptr<Reference>> references;
  for (const double tolerance : {coarse, fine}) {
    Scene other = scene;
    other.tolerance = tolerance;
    references.push_back(std::make_unique<Reference>(other, work));
    Reference& reference = *references.back();
    while (reference.can_refine()) reference.refine(reference.promise().rows() - 1);
    rows = std::min(rows, reference.exists() ? reference.promise().rows() : 0);
  }
  if (rows == 0) return true;
  for (std::size_t i = 0; i < 2; ++i) growth[i] = std::max(1.0, references[i]->promise().growth(rows - 1));
  return growth[1] > kRougher * growth[0];
}

double largest_error(const Promise& promise, const Trajectory& of) {
  double error = 0.0;
  for (Index row = 0; row < promise.rows(); ++row) error = std::max(error, promise.error_in_place(of, row));
  return error;
}

}  // namespace

double fitted_slope(const std::vector<double>& tolerances, const std::vector<double>& errors) {
  const auto count = static_cast<double>(errors.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double a = std::log10(tolerances[i]), b = std::log10(errors[i]);
    x += a / count;
    y += b / count;
    xx += a * a / count;
    xy += a * b / count;
  }
  return (xy - x * y) / (xx - x * x);
}

std::vector<Slope> slopes(Scene scene, const std::vector<Method>& methods, std::int64_t work) {
  const log::WithoutWarnings quiet;
  std::vector<Slope> found;
  scene.tolerance = kMiddle;
  const Reference reference(scene, work);
  if (!reference.exists()) return found;
  const Promise& promise = reference.promise();
  const double floor = kAboveFloor * largest_error(promise, reference.other());
  for (const Method& method : methods) {
    if (!method.is_controlled) continue;
    Slope slope{scene.name, method.name, {}, {}, 0.0, false};
    for (int half_decades = 4; half_decades <= 20; ++half_decades) {
      scene.tolerance = std::pow(10.0, -0.5 * half_decades);
      try {
        test::SceneRun run(scene.toml + integrator(scene, method, reference));
        Follower follower(run.dynamics().size(), reference.instants());
        run.simulation().add(follower);
        while (work_of(run.dynamics().counters()) < work && run.simulation().advance()) continue;
        if (follower.trajectory.rows < promise.rows()) break;
        const double error = largest_error(promise, follower.trajectory);
        if (error <= floor) break;
        if (error >= kMost || error < kSurplus * scene.tolerance) continue;
        // The tolerance has no effect on methods without truncation error, nor on auto if it chooses one.
        if (!slope.errors.empty() && error == slope.errors.back()) continue;
        slope.tolerances.push_back(scene.tolerance);
        slope.errors.push_back(error);
      } catch (const InputError&) {
        break;
      }
    }
    if (slope.is_fitted()) slope.value = fitted_slope(slope.tolerances, slope.errors);
    if (!slope.is_kept()) slope.grazes = grazes(scene, slope.tolerances.front(), slope.tolerances.back(), work);
    found.push_back(std::move(slope));
  }
  return found;
}

}  // namespace butee::stress
