#include "butee/dynamics/frequencies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/SparseCholesky>

#include "butee/core/error.hpp"
#include "butee/core/memory.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/elastic_stops.hpp"
#include "butee/dynamics/slow_modes.hpp"
#include "butee/linalg/dense_pairs.hpp"
#include "butee/linalg/lanczos.hpp"

namespace butee::dynamics {
namespace {

/// Number of vectors of system size that a mode needs during its computation, including all copies.
constexpr double kVectorsOfMode = 6.0;
/// Tolerance of the eigenvectors; a Ritz value is accurate to its square. The highest eigenvalues
/// of a long beam are too close together for a tighter one.
constexpr double kLanczosTolerance = 1e-4;
constexpr int kLanczosVectors = 30;
constexpr int kLanczosRestarts = 200;
/// Tolerance of mode shapes, which enter the damping matrix directly.
constexpr double kShapeTolerance = 1e-12;
/// Eigenvalues below this fraction of the highest are not counted: they may be rounding.
constexpr double kCountable = 1e-13;
/// A stiffness is not negative if its eigenvalue is above minus this part of the sum of the magnitudes in phi^T K phi.
constexpr double kNotNegative = 16.0 * std::numeric_limits<double>::epsilon();
/// The position between two eigenvalues at which they are counted, relative to the larger.
constexpr double kCountedBelow = 1e-6;

double frequency(double eigenvalue) {
  return std::sqrt(std::max(eigenvalue, 0.0));
}

/// A^-1 of a sparse matrix.
class Inverse final : public linalg::SymmetricMap {
 public:
  explicit Inverse(const SparseMatrix& matrix) : factor_(matrix) {}

  bool is_regular() const { return factor_.info() == Eigen::Success; }
  void apply(const double* x, double* y) const override {
    Eigen::Map<Vector>(y, factor_.rows()) = factor_.solve(Eigen::Map<const Vector>(x, factor_.rows()));
  }

 private:
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

std::optional<double> highest_eigenvalue(const SparseMatrix& stiffness, const SparseMatrix& mass) {
  const Inverse map(mass);
  if (!map.is_regular()) return std::nullopt;
  const auto pairs = linalg::largest_pairs(map, stiffness, 1, {kLanczosVectors, kLanczosRestarts, kLanczosTolerance});
  if (!pairs) return std::nullopt;
  return pairs->values[0];
}

/// A shift a little below zero keeps the matrix regular if the structure can move as a rigid body.
std::optional<linalg::Pairs> lowest_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass, double highest,
                                          Index count, double tolerance) {
  const double shift = -1e-12 * highest;
  const Inverse map(stiffness - shift * mass);
  if (!map.is_regular()) return std::nullopt;
  const Index vectors = std::min(stiffness.rows(), std::max<Index>(2 * count + 1, kLanczosVectors));
  const auto pairs = linalg::largest_pairs(map, mass, count, {vectors, kLanczosRestarts, tolerance});
  if (!pairs) return std::nullopt;
  const Vector values = pairs->values.cwiseInverse().array() + shift;
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return values[a] < values[b]; });
  return linalg::Pairs{values(order), pairs->vectors(Eigen::all, order)};
}

/// Sylvester's law of inertia: the number of eigenvalues below `limit` is the number of negative
/// pivots of K - limit M.
Index count_below(const SparseMatrix& stiffness, const SparseMatrix& mass, double limit) {
  const Eigen::SimplicialLDLT<SparseMatrix> factor(SparseMatrix(stiffness - limit * mass));
  return (factor.vectorD().array() < 0.0).count();
}

/// Lanczos may miss one of several equal eigenvalues; counts them to check.
bool is_complete(const SparseMatrix& stiffness, const SparseMatrix& mass, const Vector& values, double highest) {
  const double last = values[values.size() - 1];
  if (last <= kCountable * highest) return true;
  const double limit = (1.0 - kCountedBelow) * last;
  return count_below(stiffness, mass, limit) == (values.array() < limit).count();
}

/// The eigenvalues have the rounding of the highest one. Those of modes far below it are found again in the span of
/// their shapes, which has the rounding of the entries of K or of the elements, and so on for modes far below the
/// highest of these. False if the eigenvalues were not found.
bool refine_soft_modes(SoftStiffness& stiffness, double highest, linalg::Pairs& pairs, Vector& rounding) {
  for (Index soft = count_soft(pairs.values, highest); soft > 0; soft = count_soft(pairs.values.head(soft), highest)) {
    const auto turned = linalg::dense_pairs(stiffness.of(soft, pairs.vectors));
    if (!turned) return false;
    pairs.values.head(soft) = turned->values;
    pairs.vectors.leftCols(soft) *= turned->vectors;
    rounding.head(soft) = turned->vectors.cwiseAbs2().transpose() * stiffness.rounding();
    highest = pairs.values[soft - 1];
    if (!(highest > 0.0)) break;
  }
  return true;
}

std::optional<Modes> modes_of(const SparseMatrix& stiffness, const model::System& system, linalg::Pairs pairs,
                              double highest) {
  const Index soft = count_soft(pairs.values, highest);
  Vector rounding = Vector::Zero(soft);
  SoftStiffness of_soft(stiffness, system, std::numeric_limits<double>::infinity());
  if (!refine_soft_modes(of_soft, highest, pairs, rounding)) return std::nullopt;
  const Eigen::MatrixXd sizes = pairs.vectors.leftCols(soft).cwiseAbs(), forces = stiffness.cwiseAbs() * sizes;
  for (Index i = 0; i < soft; ++i) {
    double& value = pairs.values[i];
    if (value < -kNotNegative * sizes.col(i).dot(forces.col(i))) require_no_growth(value, 0.0);
    if (value <= rounding[i]) value = 0.0;
  }
  return Modes{pairs.values.cwiseSqrt(), std::move(pairs.vectors)};
}

/// The solvers read only one half of a matrix.
SparseMatrix even_stiffness(const model::System& system) {
  if (system.stiffness_is_symmetric) return system.stiffness;
  return 0.5 * (system.stiffness + SparseMatrix(system.stiffness.transpose()));
}

std::optional<Modes> dense_modes(const SparseMatrix& stiffness, const model::System& system, Index count) {
  const auto pairs = linalg::dense_pairs(stiffness, system.mass);
  if (!pairs) return std::nullopt;
  auto modes = modes_of(stiffness, system, *pairs, pairs->values.maxCoeff());
  if (modes && count < stiffness.rows()) modes = Modes{modes->frequencies.head(count), modes->shapes.leftCols(count)};
  return modes;
}

/// Adds S^T block(group) S for each obstacle.
template <class Block>
void add_obstacles(const model::System& system, const Block& block_of, SparseMatrix& sum) {
  for (const model::FreeObstacles& obstacles : system.obstacles) {
    const Eigen::Matrix2d block = block_of(*obstacles.group);
    for (const auto& ends : obstacles.ends)
      for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t q = 0; q < 4; ++q) {
          const Index i = p < 2 ? ends.a[p] : ends.b[p - 2], j = q < 2 ? ends.a[q] : ends.b[q - 2];
          const double value = block(static_cast<Index>(p % 2), static_cast<Index>(q % 2));
          if (i >= 0 && j >= 0 && value != 0.0) sum.coeffRef(i, j) += (p < 2) == (q < 2) ? value : -value;
        }
  }
}

/// `normal` along the normal of a plane and along both axes of a ring; `tangential` along the tangent of a plane, along
/// both axes of a ring and along a friction support.
Eigen::Matrix2d block_along(const model::ObstacleGroup& group, double normal, double tangential) {
  if (group.shape == nullptr) return Eigen::Vector2d(tangential, 0.0).asDiagonal();
  const model::ContactShape::Form form = group.shape->form();
  if (form.kind != model::ContactShape::Form::Kind::line)
    return std::max(normal, tangential) * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d n = form.place, t(-n[1], n[0]);
  return normal * n * n.transpose() + tangential * t * t.transpose();
}

}  // namespace

void require_no_growth(double lowest, double highest) {
  // Rounding of the eigenvalues of stiff structures stays far below.
  constexpr double kNegative = 1e-11;
  if (lowest >= -kNegative * std::abs(highest)) return;
  throw UnstableStiffness("the stiffness has the negative eigenvalue " + to_short_text(lowest) +
                          " 1/s2: the structure is unstable, its motion grows as e^(" +
                          to_short_text(std::sqrt(-lowest)) +
                          " t), and it has no natural frequency there; look for a compression by "
                          "preload, or a negative stiffness in imported matrices or in an element of a module");
}

double contact_frequency(const model::System& system, const ElasticStops& contact) {
  double square = 0.0;
  const Vector stiffness = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)})
      if (dof >= 0) square = std::max(square, stiffness[i] / system.mass.coeff(dof, dof));
  return std::sqrt(square);
}

double shortest_impact(const model::System& system) {
  constexpr std::size_t kMostSamples = 200;
  /// A unit force along `direction` from body b, or the ground, on body a.
  struct Force {
    double stiffness;
    std::array<Index, 2> a, b;
    Eigen::Vector2d direction;
  };
  constexpr Index kGround = model::FreeStops::kGround;
  std::vector<Force> forces;
  for (const model::FreeStops& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i)
      forces.push_back(
          {stops.law->closed_stiffness(), {stops.a[i], kGround}, {stops.b[i], kGround}, Eigen::Vector2d::UnitX()});
  for (const model::FreeObstacles& obstacles : system.obstacles) {
    const model::ObstacleGroup& group = *obstacles.group;
    if (group.shape == nullptr || group.law == nullptr) continue;
    const model::ContactShape::Form form = group.shape->form();
    const Eigen::Vector2d direction =
        form.kind == model::ContactShape::Form::Kind::line ? form.place : Eigen::Vector2d::UnitX();
    for (const model::FreeObstacles::Ends& ends : obstacles.ends)
      forces.push_back({group.law->closed_stiffness(), {ends.a[0], ends.a[1]}, {ends.b[0], ends.b[1]}, direction});
  }
  double shortest = std::numeric_limits<double>::infinity();
  if (forces.empty()) return shortest;
  const Inverse inverse(system.mass);
  if (!inverse.is_regular()) return shortest;
  Vector moved(system.size());
  for (std::size_t i = 0; i < forces.size(); i += std::max<std::size_t>(1, forces.size() / kMostSamples)) {
    const Force& force = forces[i];
    Vector s = Vector::Zero(system.size());
    for (std::size_t k = 0; k < 2; ++k) {
      if (force.a[k] >= 0) s[force.a[k]] += force.direction[static_cast<Index>(k)];
      if (force.b[k] >= 0) s[force.b[k]] -= force.direction[static_cast<Index>(k)];
    }
    inverse.apply(s.data(), moved.data());
    shortest = std::min(shortest, std::numbers::pi / std::sqrt(force.stiffness * s.dot(moved)));
  }
  return shortest;
}

SparseMatrix damping_of_contacts(const model::System& system) {
  SparseMatrix damping(system.size(), system.size());
  add_obstacles(
      system,
      [](const model::ObstacleGroup& group) {
        const bool has_dashpot = group.damping.kind == model::ImpactDamping::Kind::kelvin_voigt;
        return block_along(group, has_dashpot ? group.damping.coefficient : 0.0, group.friction.stick_damping);
      },
      damping);
  return damping;
}

std::optional<double> fastest_decay(const SparseMatrix& damping, const SparseMatrix& mass) {
  // C has the rank of the contacts, too small for Lanczos; a few percent suffice.
  constexpr int kIterations = 50;
  const Inverse inverse(mass);
  if (!inverse.is_regular()) return std::nullopt;
  // A start that is orthogonal to no mode.
  Vector phi(mass.rows());
  for (Index i = 0; i < phi.size(); ++i) phi[i] = 1.0 + std::sin(1.7 * static_cast<double>(i * i));
  Vector force = damping * phi;
  double fastest = 0.0;
  for (int i = 0; i < kIterations && force.norm() > 0.0; ++i) {
    inverse.apply(force.data(), phi.data());
    phi /= phi.norm();
    force = damping * phi;
    fastest = std::max(fastest, phi.dot(force) / phi.dot(mass * phi));
  }
  return fastest;
}

SparseMatrix stiffness_with_stops(const model::System& system, StopState stops) {
  SparseMatrix stiffness = system.stiffness;
  if (stops == StopState::open) return stiffness;
  linalg::Counters counters;
  const ElasticStops contact(system, counters);
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a >= 0) stiffness.coeffRef(a, a) += closed[i];
    if (b >= 0) stiffness.coeffRef(b, b) += closed[i];
    if (a < 0 || b < 0) continue;
    stiffness.coeffRef(a, b) -= closed[i];
    stiffness.coeffRef(b, a) -= closed[i];
  }
  add_obstacles(
      system,
      [](const model::ObstacleGroup& group) {
        return group.shape == nullptr ? block_along(group, 0.0, group.friction.stick_stiffness)
                                      : block_along(group, group.law->closed_stiffness(), 0.0);
      },
      stiffness);
  return stiffness;
}

std::optional<FrequencyRange> frequency_range(const model::System& system, StopState stops) {
  SparseMatrix stiffness = stiffness_with_stops(system, stops);
  // The solvers read only one half of the matrix.
  if (!system.stiffness_is_symmetric) stiffness = 0.5 * (stiffness + SparseMatrix(stiffness.transpose()));
  if (system.size() <= linalg::kDense) {
    const auto values = linalg::dense_values(Eigen::MatrixXd(stiffness), Eigen::MatrixXd(system.mass));
    if (!values) return std::nullopt;
    return FrequencyRange{frequency(values->minCoeff()), frequency(values->maxCoeff())};
  }
  const auto highest = highest_eigenvalue(stiffness, system.mass);
  if (!highest) return std::nullopt;
  const auto lowest = lowest_pairs(stiffness, system.mass, *highest, 1, kLanczosTolerance);
  if (!lowest) return std::nullopt;
  return FrequencyRange{frequency(lowest->values[0]), frequency(*highest)};
}

std::optional<Modes> lowest_modes(const model::System& system, Index count) {
  require(count >= 1 && count <= system.size(), "a system has as many modes as DOFs");
  const double numbers = kVectorsOfMode * static_cast<double>(count) * static_cast<double>(system.size());
  if (const std::string complaint = memory_complaint(numbers * sizeof(double)); !complaint.empty())
    throw InputError("the " + std::to_string(count) + " lowest modes of " + std::to_string(system.size()) +
                     " degrees of freedom: that " + complaint + "; take fewer modes, or a method that needs none");
  const SparseMatrix stiffness = even_stiffness(system);
  if (system.size() <= linalg::kDense || 2 * count + 1 > system.size()) return dense_modes(stiffness, system, count);
  const auto highest = highest_eigenvalue(stiffness, system.mass);
  if (!highest) return std::nullopt;
  const auto pairs = lowest_pairs(stiffness, system.mass, *highest, count, kShapeTolerance);
  if (!pairs || !is_complete(stiffness, system.mass, pairs->values, *highest)) return std::nullopt;
  return modes_of(stiffness, system, *pairs, *highest);
}

}  // namespace butee::dynamics
