#include "butee/dynamics/modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/linalg/dense_pairs.hpp"
#include "butee/linalg/lanczos.hpp"

namespace butee::dynamics {
namespace {

/// Systems up to kSmall, and those up to kLargestDense if more than half of the modes are
/// requested, are solved densely.
constexpr Index kSmall = 120, kLargestDense = 1200;
/// For all others: the largest number of modes, and bytes for the vectors that Lanczos keeps.
constexpr Index kMostModes = 1000;
constexpr double kMostMemory = 4e9;
/// Up to this number of vectors the small Rayleigh-Ritz eigenvalue problem is solved in extended
/// precision.
constexpr Index kExtendedRitz = 150;
/// The shift lies this fraction of an eigenvalue bound below zero: far enough from rigid motion for
/// the factorization, near enough to separate the lowest modes.
constexpr double kShiftPart = 1e-2;
/// The relative position between two eigenvalues at which they are counted.
constexpr double kMarginOfCount = 1e-6;
/// Eigenvalues below this fraction of the shift are rounding of the iteration.
constexpr double kZeroBesideShift = 1e-18;
/// An eigenvalue is zero if it is within this multiple of the rounding of its elements.
constexpr double kZeroInRounding = 4.0;
constexpr int kMostBisections = 200;
/// Relative residuals of Lanczos' vectors; looser if the rounding of the factor, in extended
/// precision, is larger.
constexpr double kTolerance = 1e-12, kLoosest = 1e-4, kBesideRounding = 1e-1;
/// Corrections of a solution with the factor by its residual; each removes as many digits of the
/// error as the factor has correct. They end at a correction below this fraction of the solution,
/// or above half of the previous one.
constexpr int kCorrections = 12;
constexpr double kCorrected = 1e-15;
/// Steps of inverse iteration after Lanczos, which used the factor without corrections.
constexpr int kInverseSteps = 2;
/// Searches for more and more modes, twice as many each time.
constexpr int kSearches = 5;

/// Diagonal entries bound the highest eigenvalue from below, within a factor of some tens for
/// beams.
double scale_of(const Structure& structure) {
  const auto k = structure.stiffness().diagonal(), m = structure.mass().diagonal();
  long double scale = 0.0L;
  for (Index i = 0; i < structure.size(); ++i) scale = std::max(scale, k.coeff(i) / m.coeff(i));
  return static_cast<double>(scale);
}

/// The number of eigenvalues below `limit`, which is moved slightly if it equals one.
Index count_below(linalg::ShiftedFactor& factor, long double limit) {
  for (int i = 0; i < 10; ++i, limit *= 1.0L - 1e-9L)
    if (factor.factorize(limit)) return factor.negative_pivots();
  return -1;
}

/// A bound below which at least `count` eigenvalues lie, and hardly more than twice as many.
double bound_of(linalg::ShiftedFactor& factor, double scale, Index count) {
  double low = 0.0, high = scale;
  for (int i = 0; i < kMostBisections && count_below(factor, high) < count; ++i) {
    low = high;
    high *= 10.0;
  }
  if (low == 0.0) low = high * std::numeric_limits<double>::epsilon() * 1e-8;
  for (int i = 0; i < kMostBisections && high > 1.2 * low; ++i) {
    const double middle = std::sqrt(low) * std::sqrt(high);
    const Index below = count_below(factor, middle);
    if (below < count) {
      low = middle;
      continue;
    }
    high = middle;
    if (below <= 2 * count + 4) break;
  }
  return high;
}

struct RitzPairs {
  Eigen::MatrixXd shapes;
  Vector values;    ///< lambda
  Vector rounding;  ///< of lambda
};

/// Coefficients C with C^T M C = 1 and C^T K C diagonal, ascending; empty if the computation
/// failed.
linalg::ExtendedColumns ritz(const linalg::ExtendedColumns& stiffness, const linalg::ExtendedColumns& mass) {
  const linalg::ExtendedColumns k = (stiffness + stiffness.transpose()) / 2.0L, m = (mass + mass.transpose()) / 2.0L;
  if (k.cols() <= kExtendedRitz) {
    const auto pairs = linalg::extended_pairs(k, m);
    return pairs ? pairs->vectors : linalg::ExtendedColumns();
  }
  const auto pairs = linalg::dense_pairs(k.cast<double>(), m.cast<double>());
  return pairs ? linalg::ExtendedColumns(pairs->vectors.cast<long double>()) : linalg::ExtendedColumns();
}

/// Rayleigh-Ritz: the best approximations in the span of `shapes`, ascending.
RitzPairs refine(const Structure& structure, const Eigen::MatrixXd& shapes) {
  const linalg::ExtendedColumns x = shapes.cast<long double>();
  const linalg::ExtendedColumns stiffness = x.transpose() * structure.elastic(shapes).forces;
  const linalg::ExtendedColumns mass = x.transpose() * (structure.mass() * x);
  const linalg::ExtendedColumns coefficients = ritz(stiffness, mass);
  if (coefficients.size() == 0) return {};
  RitzPairs pairs;
  pairs.shapes = (x * coefficients).cast<double>();
  const Structure::Elastic elastic = structure.elastic(pairs.shapes, true);
  pairs.values.resize(shapes.cols());
  for (Index i = 0; i < shapes.cols(); ++i)
    pairs.values[i] = static_cast<double>(pairs.shapes.col(i).cast<long double>().dot(elastic.forces.col(i)));
  pairs.rounding = elastic.rounding;
  return pairs;
}

/// (K - s M)^-1 M x, corrected by residuals whose elastic forces are summed element by element.
Eigen::MatrixXd image_of(const Structure& structure, const linalg::ShiftedFactor& factor, double shift,
                         const Eigen::MatrixXd& x) {
  const linalg::ExtendedColumns inertia = structure.mass() * x.cast<long double>();
  Eigen::MatrixXd image = factor.solve(inertia).cast<double>();
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kCorrections; ++i) {
    const linalg::ExtendedColumns moved = structure.mass() * image.cast<long double>();
    const linalg::ExtendedColumns residual =
        inertia - structure.elastic(image).forces + static_cast<long double>(shift) * moved;
    const Eigen::MatrixXd correction = factor.solve(residual).cast<double>();
    const double size = correction.norm() / image.norm();
    if (!(size < 0.5 * before)) break;
    image += correction;
    if (size < kCorrected) break;
    before = size;
  }
  return image;
}

double tolerance_of(double scale, double shift) {
  constexpr double kUnit = std::numeric_limits<long double>::epsilon();
  return std::clamp(kBesideRounding * kUnit * scale / -shift, kTolerance, kLoosest);
}

RitzPairs first_of(const RitzPairs& pairs, Index count) {
  return {pairs.shapes.leftCols(count), pairs.values.head(count), pairs.rounding.head(count)};
}

/// The complete pairs by Lanczos' method; empty on failure.
RitzPairs iterate(const Structure& structure, linalg::ShiftedFactor& factor, double bound, double shift, Index count,
                  double tolerance) {
  const SparseMatrix mass = structure.mass().cast<double>();
  Eigen::MatrixXd found(structure.size(), 0);
  Index wanted = count;
  for (Index pass = 0; pass <= count; ++pass) {
    if (!factor.factorize(shift)) return {};
    const auto more = linalg::lanczos(factor, mass, bound, wanted, tolerance, found);
    if (!more) return {};
    Eigen::MatrixXd all(structure.size(), found.cols() + more->cols());
    all << found, *more;
    for (int i = 0; i < kInverseSteps; ++i) all = -shift * image_of(structure, factor, shift, all);
    const RitzPairs pairs = refine(structure, all);
    if (pairs.shapes.size() == 0) return {};
    found = pairs.shapes;
    const double last = pairs.values[count - 1], limit = (1.0 - kMarginOfCount) * last;
    if (last <= kZeroInRounding * pairs.rounding[count - 1] - kZeroBesideShift * shift) return first_of(pairs, count);
    const Index below = count_below(factor, limit);
    const Index known = (pairs.values.array() < limit).count();
    if (below <= known) return first_of(pairs, count);
    wanted = std::min({below - known, count, structure.size() - found.cols()});
    if (wanted <= 0) return {};
  }
  return {};
}

RitzPairs solve_densely(const Structure& structure, Index count) {
  const auto pairs = linalg::dense_pairs(Eigen::MatrixXd(structure.stiffness().cast<double>()),
                                         Eigen::MatrixXd(structure.mass().cast<double>()));
  if (!pairs) return {};
  return refine(structure, pairs->vectors.leftCols(count));
}

Index most_modes(Index size) {
  const auto fitting = static_cast<Index>(kMostMemory / (16.0 * static_cast<double>(size)));
  return std::min({kMostModes, fitting, (size - linalg::lanczos_vectors(0, size)) / 2});
}

/// Beside the shift for few modes of a fine mesh the rounding of the factor may be too large; more modes have a larger
/// shift.
RitzPairs solve_iteratively(const Structure& structure, linalg::ShiftedFactor& factor, double scale, Index count,
                            double& shift) {
  Index wanted = count;
  for (int i = 0; i < kSearches && wanted <= most_modes(structure.size()); ++i, wanted *= 2) {
    const double bound = scale > 0.0 ? bound_of(factor, scale, wanted) : 1.0;
    shift = -kShiftPart * bound;
    const RitzPairs pairs = iterate(structure, factor, bound, shift, wanted, tolerance_of(scale, shift));
    if (pairs.shapes.size() > 0 && pairs.values.allFinite()) return first_of(pairs, count);
  }
  return {};
}

Vector residuals_of(const Structure& structure, const linalg::ShiftedFactor& factor, const RitzPairs& pairs,
                    double shift) {
  const SparseMatrix mass = structure.mass().cast<double>();
  const Eigen::MatrixXd images = image_of(structure, factor, shift, pairs.shapes);
  Vector residuals(pairs.values.size());
  for (Index i = 0; i < residuals.size(); ++i) {
    const Vector miss = (pairs.values[i] - shift) * images.col(i) - pairs.shapes.col(i);
    residuals[i] = std::sqrt(std::max(0.0, miss.dot(mass * miss)));
  }
  return residuals;
}

/// Sets the frequency of rigid motion to 0 and the sign of every shape.
void finish(NaturalModes& modes, RitzPairs pairs, double shift) {
  const Index count = pairs.values.size();
  modes.frequencies.resize(count);
  modes.rounding.setZero(count);
  for (Index i = 0; i < count; ++i) {
    const double value = pairs.values[i];
    const bool rigid = value <= kZeroInRounding * pairs.rounding[i] - kZeroBesideShift * shift;
    modes.rigid += rigid ? 1 : 0;
    modes.frequencies[i] = rigid ? 0.0 : std::sqrt(value);
    if (!rigid) modes.rounding[i] = 0.5 * pairs.rounding[i] / value;
    Index place = 0;
    pairs.shapes.col(i).cwiseAbs().maxCoeff(&place);
    if (pairs.shapes(place, i) < 0.0) pairs.shapes.col(i) *= -1.0;
  }
  modes.shapes = std::move(pairs.shapes);
}

void check_size(Index count, Index size) {
  const Index most = most_modes(size);
  if (count > most)
    throw InputError(std::to_string(count) + " of " + std::to_string(size) +
                     " modes are more than can be found in reasonable time and memory; ask for at most " +
                     std::to_string(most));
}

}  // namespace

NaturalModes find_modes(const Structure& structure, Index count) {
  const Index size = structure.size();
  require(count >= 1 && count <= size, "a structure has as many modes as DOFs");
  NaturalModes modes;
  modes.dense = size <= kSmall || (linalg::lanczos_vectors(count, size) == size && size <= kLargestDense);
  if (!modes.dense) check_size(count, size);
  const double scale = scale_of(structure);
  linalg::ShiftedFactor factor(structure.stiffness(), structure.mass());
  RitzPairs pairs =
      modes.dense ? solve_densely(structure, count) : solve_iteratively(structure, factor, scale, count, modes.shift);
  if (pairs.shapes.size() == 0 || !pairs.values.allFinite()) {
    modes.problem = "the eigenvalue solver did not converge";
    return modes;
  }
  require_no_growth(pairs.values[0], scale);
  if (modes.dense) modes.shift = -kShiftPart * std::max(pairs.values[count - 1], 1e-10 * scale);
  if (modes.shift == 0.0) modes.shift = -1.0;
  if (!factor.factorize(modes.shift)) modes.problem = "K - s M could not be factorized";
  modes.residuals = residuals_of(structure, factor, pairs, modes.shift);
  finish(modes, std::move(pairs), modes.shift);
  return modes;
}

}  // namespace butee::dynamics
