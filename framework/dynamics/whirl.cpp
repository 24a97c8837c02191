#include "butee/dynamics/whirl.hpp"

#include <Spectra/GenEigsSolver.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "butee/core/error.hpp"
#include "butee/dynamics/modal_damping.hpp"
#include "butee/dynamics/slow_modes.hpp"
#include "butee/linalg/dense_pairs.hpp"
#include "butee/linalg/general_factor.hpp"
#include "butee/linalg/general_pairs.hpp"

namespace butee::dynamics {
namespace {

using Complex = std::complex<double>;

/// Orbits flatter than this are taken for lines.
constexpr double kFlat = 1e-9;
/// Displacements with less than this part of the inertia of the rotations are a by-product or rounding.
constexpr double kOnlyTilts = 1e-6;
/// Fraction of the highest frequency below which a mode at rest counts as rigid motion: rounding of
/// dense eigenvalues.
constexpr double kRigid = 1e-7;
/// Eigenvalues that differ by less than this fraction are equal: rounding of the lowest in fine meshes.
constexpr double kEqual = 1e-9;
constexpr const char* kNotFound = "the whirling modes could not be computed";
/// Growth rates below this fraction of |lambda| are rounding.
constexpr double kGrows = 1e-9;
/// Rounding of dense eigenvalues as a fraction of the highest rate in the matrices.
constexpr double kRoundingOfEigenvalues = 1e-14;
/// Dense eigenvalues are not used where their rounding exceeds this fraction of the lowest frequency (chosen).
constexpr double kMostRounding = 1e-7;
/// With fewer DOFs Arnoldi's method would not find all modes that are asked for (chosen).
constexpr Index kFewest = 12;

/// A shift that allows rigid motion, rad/s: a thousandth of the lowest frequency of a DOF alone, above the rounding of
/// the highest. DOFs without stiffness do not count.
double shift_of(const model::System& system) {
  constexpr double kPart = 1e-3, kAboveRounding = 1e-7;
  const Vector squares = system.stiffness.diagonal().cwiseAbs().cwiseQuotient(system.mass.diagonal());
  double lowest = squares.maxCoeff();
  if (!(lowest > 0.0)) return 1.0;
  for (const double square : squares)
    if (square > 0.0) lowest = std::min(lowest, square);
  return std::max(kPart * std::sqrt(lowest), kAboveRounding * std::sqrt(squares.maxCoeff()));
}

/// y = (A - sigma)^-1 x of the first-order form of the pencil in (x, v).
class ShiftInverted {
 public:
  using Scalar = double;

  ShiftInverted(const SparseMatrix& mass, const SparseMatrix& damping, const SparseMatrix& stiffness, double shift)
      : mass_(mass), damping_(damping), shift_(shift), factor_(shifted(stiffness), counters_) {
    if (!factor_.factorize(shifted(stiffness)))
      throw RunError("the modes could not be computed: the matrices are singular to rounding");
  }

  double shift() const { return shift_; }
  Index rows() const { return 2 * mass_.rows(); }
  Index cols() const { return rows(); }
  void perform_op(const double* in, double* out) const {
    const Index n = mass_.rows();
    const Eigen::Map<const Vector> p(in, n), q(in + n, n);
    Vector x = -(mass_ * (q + shift_ * p)) - damping_ * p;
    factor_.solve(x);
    Eigen::Map<Vector>(out, n) = x;
    Eigen::Map<Vector>(out + n, n) = p + shift_ * x;
  }

 private:
  SparseMatrix shifted(const SparseMatrix& stiffness) const {
    SparseMatrix sum = stiffness + shift_ * damping_ + shift_ * shift_ * mass_;
    sum.makeCompressed();
    return sum;
  }

  const SparseMatrix& mass_;
  SparseMatrix damping_;
  double shift_;
  linalg::Counters counters_;
  mutable linalg::GeneralFactor factor_;
};

/// Sums over the nodes' orbits in a mode: of signed areas, squares, and squares times inertia.
struct Orbits {
  double area = 0.0, square = 0.0, most = 0.0, least = 0.0, inertia = 0.0;
};

/// Modes without oscillation first, then by frequency.
void sort(std::vector<WhirlMode>& modes) {
  std::stable_sort(modes.begin(), modes.end(), [](const WhirlMode& a, const WhirlMode& b) {
    return std::pair(a.lambda.imag(), std::abs(a.lambda)) < std::pair(b.lambda.imag(), std::abs(b.lambda));
  });
}

/// Modes of one eigenvalue have no shape of their own, and no sense of whirl: any sum of them is a mode.
void name_equal(std::vector<WhirlMode>& modes) {
  const auto is_equal = [](const WhirlMode& a, const WhirlMode& b) {
    return a.motion == b.motion && std::abs(a.lambda - b.lambda) <= kEqual * std::abs(a.lambda);
  };
  for (std::size_t i = 1; i < modes.size(); ++i)
    if (is_equal(modes[i - 1], modes[i]))
      for (WhirlMode* mode : {&modes[i - 1], &modes[i]}) mode->direction = 0.0, mode->is_mixed = false;
}

SparseMatrix or_zero(const SparseMatrix& matrix, Index n) {
  return matrix.size() > 0 ? matrix : SparseMatrix(n, n);
}

}  // namespace

double WhirlMode::damping_ratio() const {
  const double size = std::abs(lambda);
  return size > 0.0 ? -lambda.real() / size : 0.0;
}

double WhirlMode::logarithmic_decrement() const {
  return 2.0 * std::numbers::pi * -lambda.real() / lambda.imag();
}

void keep_lowest(std::vector<WhirlMode>& modes, Index count) {
  if (std::ssize(modes) <= count) return;
  std::vector<double> sizes;
  for (const WhirlMode& mode : modes) sizes.push_back(std::abs(mode.lambda));
  std::nth_element(sizes.begin(), sizes.begin() + count - 1, sizes.end());
  const double largest = sizes[static_cast<std::size_t>(count - 1)];
  std::erase_if(modes, [&](const WhirlMode& mode) { return std::abs(mode.lambda) > largest; });
  modes.resize(static_cast<std::size_t>(count));
}

Whirl::Whirl(const model::Model& model, Index dense)
    : system_(assemble(model, model::TurningParts::apart)), dense_(system_.damping.is_modal() ? kDense : dense) {
  const Index n = size();
  const SparseMatrix transposed = system_.stiffness.transpose();
  stiffness_ = 0.5 * (system_.stiffness + transposed);
  skew_ = 0.5 * (system_.stiffness - transposed);
  damping_ = system_.damping.mass_proportional * system_.mass +
             system_.damping.stiffness_proportional * system_.stiffness + or_zero(system_.dashpots, n);
  if (!is_dense()) {
    if (system_.damping.is_modal())
      throw InputError("whirling modes of " + std::to_string(n) +
                       " DOFs cannot be computed with modal damping, whose matrix is dense");
    return;
  }
  const auto pairs = linalg::dense_pairs(stiffness_, system_.mass);
  if (!pairs) throw RunError("the modes at rest could not be computed");
  shapes_ = pairs->vectors;
  const double highest = pairs->values.cwiseAbs().maxCoeff(), unlimited = std::numeric_limits<double>::infinity();
  const Index soft = std::max(count_rigid(pairs->values, unlimited), count_soft(pairs->values, highest));
  const auto in_modes = [&](const SparseMatrix& matrix) {
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(n, n);
    if (matrix.nonZeros() == 0) return product;
    product.noalias() = shapes_.transpose() * (matrix * shapes_);
    product.topLeftCorner(soft, soft) = soft_product(soft, matrix, shapes_);
    return product;
  };
  modal_damping_ = in_modes(damping_);
  if (const auto modal = ModalDamping::of(system_)) {
    Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
    modal->matrix().add_to(full, 1.0);
    modal_damping_ += shapes_.transpose() * full * shapes_;
  }
  modal_stiffness_ = in_modes(skew_);
  modal_stiffness_.diagonal().tail(n - soft) += pairs->values.tail(n - soft);
  modal_stiffness_.topLeftCorner(soft, soft) += SoftStiffness(stiffness_, system_, unlimited).of(soft, shapes_);
  frequencies_ = modal_stiffness_.diagonal().cwiseAbs().cwiseSqrt();
  modal_gyroscopic_ = in_modes(system_.gyroscopic);
  modal_circulatory_ = in_modes(system_.circulatory);
  // The slow modes of very short or light parts, or of strong damping, are rounding of the fast ones.
  if (n >= kFewest && !system_.damping.is_modal() && rounding(0.0) > kMostRounding * slowest()) dense_ = -1;
}

double Whirl::slowest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const double frequency : frequencies_)
    if (frequency > 0.0) least = std::min(least, frequency);
  return least;
}

WhirlMode Whirl::finished(Complex lambda, Eigen::VectorXcd shape) const {
  WhirlMode mode;
  mode.lambda = lambda;
  Index largest = 0;
  shape.cwiseAbs().maxCoeff(&largest);
  mode.shape = shape / shape[largest];
  const auto& free = system_.dofs.free();
  // The orbits of the nodes, or, where only axes tilt, those of their points: (rz, -ry) in the plane (y, z).
  const auto orbits = [&](DofKind first, DofKind second, double sign) {
    Orbits sum;
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i].kind != first) continue;
      const auto y = static_cast<Index>(i), z = system_.dofs.index({free[i].node, second});
      if (z < 0) continue;
      const Complex along_y = mode.shape[y], along_z = sign * mode.shape[z];
      const double turn = -2.0 * (std::conj(along_y) * along_z).imag();
      sum.area += turn;
      sum.square += std::norm(along_y) + std::norm(along_z);
      sum.most = std::max(sum.most, turn);
      sum.least = std::min(sum.least, turn);
      sum.inertia += system_.mass.coeff(y, y) * std::norm(along_y) + system_.mass.coeff(z, z) * std::norm(along_z);
    }
    return sum;
  };
  Orbits of = orbits(DofKind::uy, DofKind::uz, 1.0);
  if (const Orbits tilt = orbits(DofKind::rz, DofKind::ry, -1.0); of.inertia < kOnlyTilts * tilt.inertia) of = tilt;
  const auto inertia = [&](DofKind kind) {
    double sum = 0.0;
    for (std::size_t i = 0; i < free.size(); ++i)
      if (const auto d = static_cast<Index>(i); free[i].kind == kind)
        sum += system_.mass.coeff(d, d) * std::norm(mode.shape[d]);
    return sum;
  };
  // Torsion and motion along the shaft have no orbit but rounding.
  const double torsional = inertia(DofKind::rx), axial = inertia(DofKind::ux);
  if (of.inertia < kOnlyTilts * (torsional + axial)) {
    mode.motion = torsional > axial ? ModeMotion::torsional : ModeMotion::axial;
    return mode;
  }
  if (of.square > 0.0 && lambda.imag() > 0.0) mode.direction = of.area / of.square;
  if (std::abs(mode.direction) < kFlat) mode.direction = 0.0;
  mode.is_mixed = std::min(of.most, -of.least) > 1e-3 * std::max(of.most, -of.least);
  return mode;
}

std::vector<WhirlMode> Whirl::modes(double speed, Index count) const {
  return modes_at(speed, count).lowest;
}

ModesAtSpeed Whirl::modes_at(double speed, Index count) const {
  ModesAtSpeed at;
  if (is_dense()) {
    at = dense_modes(speed, count);
  } else {
    at = {speed, lowest_modes(speed, count), {}};
    for (const WhirlMode& mode : at.lowest) at.eigenvalues.push_back(mode.lambda);
  }
  sort(at.lowest);
  name_equal(at.lowest);
  return at;
}

Index Whirl::count_to(double reach, double from, double to, Index count) const {
  const Index most = std::max(count, std::min(kMostLowest, size()));
  for (Index wanted = count;; wanted = std::min(2 * wanted, most)) {
    bool reaches = true;
    for (const double speed : {from, to}) {
      double highest = 0.0;
      for (const Complex lambda : eigenvalues(speed, wanted)) highest = std::max(highest, std::abs(lambda));
      reaches = reaches && highest > reach;
    }
    if (reaches || wanted >= most) return wanted;
  }
}

Eigen::MatrixXd Whirl::modal_motion(double speed) const {
  const Index n = size();
  // Rigid motion takes the scale of the slowest oscillation.
  const double least = slowest();
  const Vector scale = frequencies_.cwiseMax(std::isfinite(least) ? least : 1.0);
  const Eigen::MatrixXd stiffness = modal_stiffness_ + speed * modal_circulatory_;
  const Eigen::MatrixXd damping = modal_damping_ + speed * modal_gyroscopic_;
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  motion.topRightCorner(n, n) = scale.asDiagonal();
  motion.bottomLeftCorner(n, n) = -(scale.cwiseInverse().asDiagonal() * stiffness);
  motion.bottomRightCorner(n, n) = -(scale.cwiseInverse().asDiagonal() * damping * scale.asDiagonal());
  return motion;
}

std::vector<Whirl::Eigenvalue> Whirl::in_order(const Eigen::VectorXcd& values) const {
  std::vector<Eigenvalue> ordered;
  for (Index i = 0; i < values.size(); ++i)
    if (values[i].imag() >= 0.0) ordered.push_back({values[i], i});
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Eigenvalue& a, const Eigenvalue& b) { return std::abs(a.lambda) < std::abs(b.lambda); });
  const double rigid = kRigid * frequencies_.maxCoeff();
  // Rigid motion has two eigenvalues 0, which rounding separates; some leave 0 if the structure turns.
  Index rigid_left = 2 * (frequencies_.array() == 0.0).count();
  for (Eigenvalue& one : ordered)
    if (std::abs(one.lambda) < rigid && rigid_left-- > 0) one.lambda = 0.0;
  return ordered;
}

ModesAtSpeed Whirl::dense_modes(double speed, Index count) const {
  const auto pairs = linalg::general_pairs(modal_motion(speed));
  if (!pairs) throw RunError(kNotFound);
  ModesAtSpeed at{speed, {}, {}};
  for (const auto& [lambda, place] : in_order(pairs->values)) {
    at.eigenvalues.push_back(lambda);
    if (std::ssize(at.lowest) < count)
      at.lowest.push_back(finished(lambda, shapes_ * pairs->vectors.col(place).head(size())));
  }
  return at;
}

std::vector<WhirlMode> Whirl::lowest_modes(double speed, Index count) const {
  const Index n = size();
  const SparseMatrix damping = damping_ + speed * or_zero(system_.gyroscopic, n);
  const SparseMatrix stiffness = system_.stiffness + speed * or_zero(system_.circulatory, n);
  ShiftInverted operation(system_.mass, damping, stiffness, shift_of(system_));
  const Index wanted = std::min(2 * count + 4, 2 * n - 2);
  Spectra::GenEigsSolver<ShiftInverted> solver(operation, wanted, std::min(2 * wanted + 20, 2 * n));
  solver.init();
  if (solver.compute(Spectra::SortRule::LargestMagn, 1000, 1e-12) < wanted / 2)
    throw RunError(std::string(kNotFound) + ": Arnoldi's method did not converge");
  std::vector<WhirlMode> modes;
  for (Index i = 0; i < solver.eigenvalues().size(); ++i) {
    const Complex lambda = operation.shift() + 1.0 / solver.eigenvalues()[i];
    if (lambda.imag() >= 0.0) modes.push_back(finished(lambda, solver.eigenvectors().col(i).head(n)));
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.lambda) < std::abs(b.lambda); });
  modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
  return modes;
}

std::vector<Complex> Whirl::eigenvalues(double speed, Index count) const {
  std::vector<Complex> values;
  if (!is_dense()) {
    for (const WhirlMode& mode : lowest_modes(speed, count)) values.push_back(mode.lambda);
    return values;
  }
  const auto found = linalg::eigenvalues(modal_motion(speed));
  if (!found) throw RunError(kNotFound);
  for (const auto& [lambda, place] : in_order(*found)) values.push_back(lambda);
  values.resize(std::min(values.size(), static_cast<std::size_t>(count)));
  return values;
}

double Whirl::rounding(double speed) const {
  if (!is_dense() || size() == 0) return 0.0;
  const double of_damping = modal_damping_.cwiseAbs().maxCoeff(), of_turning = modal_gyroscopic_.cwiseAbs().maxCoeff();
  return kRoundingOfEigenvalues * std::max({frequencies_.maxCoeff(), of_damping, std::abs(speed) * of_turning});
}

double Whirl::growth(Complex lambda) const {
  return lambda.real() - kGrows * std::abs(lambda) - rounding(0.0);
}

}  // namespace butee::dynamics
