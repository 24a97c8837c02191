#include "butee/dynamics/damped_modes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include <Eigen/LU>

#include "butee/core/error.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/kernel/modal_motion.hpp"
#include "butee/dynamics/natural_matrices.hpp"
#include "butee/linalg/general_pairs.hpp"

namespace butee::dynamics {
namespace {

using Complex = std::complex<double>;

/// Entries below this fraction of the geometric mean of the largest in their row and column are
/// rounding.
constexpr double kUncoupled = 1e-12;
/// |V| |V^-1| of a set of vectors above which it is not accepted as a basis.
constexpr double kDefective = 1e6, kHopeless = 1e8;
/// The same as DampedModes::kNudge for undamped rigid motion, whose speed it changes by half of this over the run. Its
/// position and speed are separate parts of its own scale, so that no rounding limits it.
constexpr double kRigidNudge = 1e-15;

/// Connected parts of the numbers 0 ... n - 1, joined by entries (i, j).
class Parts {
 public:
  explicit Parts(Index n) : parent_(static_cast<std::size_t>(n)) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  void join(Index i, Index j) { parent_[static_cast<std::size_t>(root(i))] = root(j); }
  std::vector<std::vector<Index>> lists() {
    std::vector<std::vector<Index>> lists(parent_.size());
    for (Index i = 0; i < static_cast<Index>(parent_.size()); ++i)
      lists[static_cast<std::size_t>(root(i))].push_back(i);
    std::erase_if(lists, [](const auto& list) { return list.empty(); });
    return lists;
  }

 private:
  Index root(Index i) {
    Index& parent = parent_[static_cast<std::size_t>(i)];
    return parent == i ? i : parent = root(parent);
  }
  std::vector<Index> parent_;
};

/// Joins by the entries of a full matrix that are not negligible relative to the largest ones of
/// their row and column.
void join_entries(const Eigen::MatrixXd& matrix, Parts& parts) {
  const Eigen::ArrayXd rows = matrix.cwiseAbs().rowwise().maxCoeff(), columns = matrix.cwiseAbs().colwise().maxCoeff();
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Index i = 0; i < matrix.rows(); ++i)
      if (i != j && std::abs(matrix(i, j)) > kUncoupled * std::sqrt(rows[i] * columns[j])) parts.join(i, j);
}

/// A matrix whose rows combine the rows of another one. Blocks of few modes leave most of it empty.
class Coefficients {
 public:
  /// Sets the entries of two rows to the real and the imaginary part.
  void add(Index real_row, Index imaginary_row, Index column, Complex value) {
    entries_.emplace_back(real_row, column, value.real());
    entries_.emplace_back(imaginary_row, column, value.imag());
  }
  SparseMatrix matrix(Index rows, Index columns) const {
    SparseMatrix matrix(rows, columns);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
};

Eigen::MatrixXd product(const SparseMatrix& coefficients, const Eigen::MatrixXd& other) {
  constexpr double kFull = 0.1;  // chosen
  if (static_cast<double>(coefficients.nonZeros()) < kFull * static_cast<double>(coefficients.size()))
    return coefficients * other;
  return Eigen::MatrixXd(coefficients) * other;
}

/// The parts of the DOFs (rows) that columns of `shapes` move.
std::vector<DampedModes::Natural::Part> parts_of(const Eigen::MatrixXd& shapes) {
  const Index n = shapes.rows();
  Parts joined(n + shapes.cols());
  for (Index j = 0; j < shapes.cols(); ++j)
    for (Index i = 0; i < n; ++i)
      if (shapes(i, j) != 0.0) joined.join(i, n + j);
  std::vector<DampedModes::Natural::Part> parts;
  for (const std::vector<Index>& list : joined.lists()) {
    DampedModes::Natural::Part& part = parts.emplace_back();
    for (const Index i : list)
      if (i < n)
        part.dofs.push_back(i);
      else
        part.modes.push_back(i - n);
  }
  return parts;
}

}  // namespace

bool DampedModes::solve(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping, Block& block) {
  const Index b = stiffness.rows();
  if (b == 1) {
    const double delta = 0.5 * damping(0, 0), scale = block.scale[0];
    const Complex root = std::sqrt(Complex(delta * delta - stiffness(0, 0)));
    // The larger of two real roots is computed from the sum, the smaller from the product of both,
    // to avoid cancellation.
    Complex first = -delta + root, second = -delta - root;
    if (root.imag() == 0.0 && std::abs(first) < std::abs(second)) first = stiffness(0, 0) / second;
    if (root.imag() == 0.0 && std::abs(second) < std::abs(first)) second = stiffness(0, 0) / first;
    block.values.resize(2);
    block.values << first, second;
    block.vectors.resize(2, 2);
    block.vectors << 1.0, 1.0, first / scale, second / scale;
    const Complex determinant = (second - first) / scale;
    block.inverse.resize(2, 2);
    block.inverse << second / scale, -1.0, -first / scale, 1.0;
    block.inverse /= determinant;
    return std::abs(determinant) * kDefective > 1.0;
  }
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * b, 2 * b);
  motion.topRightCorner(b, b) = block.scale.matrix().asDiagonal();
  motion.bottomLeftCorner(b, b) = -stiffness * block.scale.inverse().matrix().asDiagonal();
  motion.bottomRightCorner(b, b) = -damping;
  auto pairs = linalg::general_pairs(motion);
  if (!pairs) return false;
  block.values = pairs->values;
  block.vectors = std::move(pairs->vectors);
  // q' of a mode is lambda q. The eigenvectors satisfy this to rounding of the highest frequency only, with which slow
  // displacements would drift away from the integral of their velocities.
  for (Index k = 0; k < 2 * b; ++k)
    for (Index i = 0; i < b; ++i) {
      const Complex lambda = block.values[k] / block.scale[i];
      Complex &displacement = block.vectors(i, k), &velocity = block.vectors(b + i, k);
      if (std::abs(lambda) >= 1.0)
        displacement = velocity / lambda;
      else
        velocity = lambda * displacement;
    }
  block.inverse = block.vectors.inverse();
  block.error =
      ((block.vectors * block.values.asDiagonal() * block.inverse).real() - motion).bottomRows(b).cwiseAbs().maxCoeff();
  return block.inverse.allFinite() && block.vectors.norm() * block.inverse.norm() < kDefective * static_cast<double>(b);
}

DampedModes::DampedModes(Dynamics& dynamics, double run_time, Index most_coupled) {
  const model::System& system = dynamics.system();
  if (system.size() > kMost)
    throw InputError("integrator.type: " + std::to_string(system.size()) +
                     " DOFs whose damping, turning parts or contacts require all modes are more than " +
                     std::to_string(kMost));
  if (system.rotation != nullptr) {
    dynamics.set_time(0.5 * run_time);
    reference_speed_ = system.rotation->speed(0.5 * run_time);
  }
  const NaturalMatrices natural = natural_matrices(dynamics, reference_speed_, run_time);
  const std::vector<Block> blocks = blocks_of(natural, run_time, most_coupled);
  for (const Block& block : blocks) {
    condition_ = std::max(condition_, block.vectors.norm() * block.inverse.norm());
    rounding_ = std::max(rounding_, run_time * block.error);
  }
  set_modes(blocks, natural.shapes, system.mass);
}

std::vector<DampedModes::Block> DampedModes::blocks_of(const NaturalMatrices& natural, double run_time,
                                                       Index most_coupled) {
  Parts parts(natural.shapes.cols());
  join_entries(natural.damping, parts);
  join_entries(natural.stiffness, parts);
  std::vector<Block> blocks;
  for (std::vector<Index>& modes : parts.lists()) {
    if (static_cast<Index>(modes.size()) > most_coupled)
      throw InputError("integrator.type: " + std::to_string(modes.size()) +
                       " modes are coupled, and computing their damped modes takes too long for this run");
    Block& block = blocks.emplace_back();
    block.modes = std::move(modes);
    find_basis(natural, run_time, block);
  }
  return blocks;
}

void DampedModes::find_basis(const NaturalMatrices& natural, double run_time, Block& block) {
  const auto b = static_cast<Index>(block.modes.size());
  Eigen::MatrixXd k = natural.stiffness(block.modes, block.modes);
  const Eigen::MatrixXd c = natural.damping(block.modes, block.modes);
  k.diagonal() += natural.squares(block.modes);
  const Eigen::ArrayXd largest = k.diagonal().array().abs().max(1.0 / (run_time * run_time));
  block.scale = largest.sqrt();
  // In coordinates of its own scale the two vectors of a slow or free motion are not almost parallel.
  const auto use_own_scale = [&] {
    if (b == 1 && c(0, 0) * c(0, 0) <= k(0, 0) && k(0, 0) > 0.0) block.scale[0] = std::sqrt(k(0, 0));
  };
  use_own_scale();
  if (solve(k, c, block)) return;
  const double nudge = b == 1 && c(0, 0) == 0.0 ? kRigidNudge : kNudge;
  for (Index i = 0; i < b; ++i) k(i, i) += nudge * static_cast<double>(i + 1) * largest[i];
  use_own_scale();
  if (!solve(k, c, block) && !(block.inverse.allFinite() && block.inverse.norm() < kHopeless))
    throw InputError("integrator.type: the modes of this structure do not form a basis");
}

void DampedModes::set_modes(const std::vector<Block>& blocks, const Eigen::MatrixXd& shapes, const SparseMatrix& mass) {
  std::vector<std::pair<const Block*, Index>> kept;  ///< a block and its damped mode, one of each pair
  for (const Block& block : blocks)
    for (Index i = 0; i < block.values.size(); ++i)
      if (block.values[i].imag() >= 0.0) kept.emplace_back(&block, i);
  std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) {
    return std::abs(a.first->values[a.second]) < std::abs(b.first->values[b.second]);
  });
  const auto p = static_cast<Index>(kept.size());
  const Index n = shapes.rows();
  decay_.resize(p);
  turn_.resize(p);
  kinetic_.resize(p);
  Coefficients of_x, of_v, from_q, from_v;
  for (Index m = 0; m < p; ++m) {
    const auto& [block, k] = kept[static_cast<std::size_t>(m)];
    const Index b = block->scale.size();
    const Complex lambda = block->values[k];
    decay_[m] = lambda.real();
    turn_[m] = lambda.imag();
    const double weight = lambda.imag() > 0.0 ? 2.0 : 1.0;
    kinetic_[m] = 0.5 * weight * weight * block->vectors.col(k).tail(b).squaredNorm();
    for (Index i = 0; i < b; ++i) {
      const Index mode = block->modes[static_cast<std::size_t>(i)];
      of_x.add(m, p + m, mode, std::conj(weight / block->scale[i] * block->vectors(i, k)));
      of_v.add(m, p + m, mode, std::conj(weight * block->vectors(b + i, k)));
      from_q.add(m, p + m, mode, block->scale[i] * block->inverse(k, i));
      from_v.add(m, p + m, mode, block->inverse(k, b + i));
    }
  }
  speed_ = (decay_.square() + turn_.square()).sqrt();
  const Eigen::MatrixXd by_dof = shapes.transpose(), by_force = (mass * shapes).transpose();
  natural_ = {shapes, of_x.matrix(2 * p, n), of_v.matrix(2 * p, n), from_v.matrix(2 * p, n), parts_of(shapes)};
  displacement_ = product(natural_.displacement, by_dof);
  velocity_ = product(natural_.velocity, by_dof);
  input_ = product(natural_.input, by_dof);
  from_v_ = product(natural_.input, by_force);
  from_x_ = product(from_q.matrix(2 * p, n), by_force);
}

void DampedModes::turn_by(double t, Index first, Eigen::Ref<Eigen::ArrayXd> re, Eigen::Ref<Eigen::ArrayXd> im) const {
  const Index count = re.size();
  Index k = 0;
  while (k < count && speed_[first + k] * std::abs(t) < kernel::kLargestAngle) ++k;
  kernel::modal_motion().turn(k, decay_.data() + first, turn_.data() + first, t, re.data(), im.data());
  for (; k < count; ++k) {
    const double size = std::exp(decay_[first + k] * t), angle = turn_[first + k] * t;
    re[k] = size * std::cos(angle);
    im[k] = size * std::sin(angle);
  }
}

void DampedModes::to_modal(ConstVectorRef x, ConstVectorRef v, Eigen::Ref<Eigen::VectorXd> z) const {
  z.noalias() = from_x_ * x;
  z.noalias() += from_v_ * v;
}

}  // namespace butee::dynamics
