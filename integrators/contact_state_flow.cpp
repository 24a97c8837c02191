#include "integrators/contact_state_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

using LongComplex = std::complex<long double>;
using LongComplexMatrix = Eigen::Matrix<LongComplex, Eigen::Dynamic, Eigen::Dynamic>;

/// Damping couples modes where an entry beside the diagonal is above this part of the largest: rounding of proportional
/// damping, which is written in doubles, stays below.
constexpr long double kUncoupled = 1e-14L;
/// Squares of frequencies below this part of the largest are rounding: the motion is rigid.
constexpr long double kRigid = 1e-17L;
/// Eigenvectors whose matrix is worse conditioned lose six digits or more.
constexpr long double kParallel = 1e6L;
/// A load this near to a block, relative to its frequency, is in resonance; else its response in closed form loses
/// four digits of 16 at most.
constexpr double kResonance = 1e-4;
/// Between kinks so near to each other, over the fastest rate, a parabola would be the difference of far larger ones; its
/// response is a power series with so many terms then.
constexpr double kShort = 1.0;
constexpr Index kTerms = 23;
/// Turns in radians for which a response in resonance is followed at a time.
constexpr double kLongest = 100.0;
LongMatrix closed_stiffness(const SmallSystem& system, const std::vector<bool>& closed, bool of_damping) {
  LongMatrix sum = of_damping ? system.damping : system.stiffness;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const LinearStop& stop = system.stops[i];
    const long double k = of_damping ? stop.damping : stop.stiffness;
    if (!closed[i] || k == 0.0L) continue;
    if (stop.a >= 0) sum(stop.a, stop.a) += k;
    if (stop.b >= 0) sum(stop.b, stop.b) += k;
    if (stop.a >= 0 && stop.b >= 0) {
      sum(stop.a, stop.b) -= k;
      sum(stop.b, stop.a) -= k;
    }
  }
  return sum;
}

}  // namespace

ContactStateFlow::ContactStateFlow(const SmallSystem& system, const std::vector<bool>& closed, double end_time)
    : system_(system), n_(system.size()), longest_(end_time) {
  const LongMatrix stiffness = closed_stiffness(system, closed, false), damping = closed_stiffness(system, closed, true);
  const LongMatrix inverse = system.mass.ldlt().solve(LongMatrix::Identity(n_, n_));
  by_force_ = inverse.cast<double>();
  by_x_ = (inverse * stiffness).cast<double>();
  by_v_ = (inverse * damping).cast<double>();
  LongMatrix shapes(n_, n_);
  LongVector squares(n_);
  if (n_ == 1) {
    shapes(0, 0) = 1.0L / std::sqrt(system.mass(0, 0));
    squares[0] = stiffness(0, 0) / system.mass(0, 0);
  } else {
    const Eigen::GeneralizedSelfAdjointEigenSolver<LongMatrix> solver(stiffness, system.mass);
    if (solver.info() != Eigen::Success)
      throw RunError("piecewise: the modes of a contact state could not be computed; take exact or rodas4");
    shapes = solver.eigenvectors();
    squares = solver.eigenvalues();
  }
  const long double largest = squares.cwiseAbs().maxCoeff();
  for (Index i = 0; i < n_; ++i)
    if (std::abs(squares[i]) <= kRigid * static_cast<long double>(n_) * largest) squares[i] = 0.0L;
  if (squares.minCoeff() < 0.0L)
    throw RunError(
        "piecewise: the structure is not stable without its loads (a negative stiffness); take exact or rodas4");
  LongMatrix modal = shapes.transpose() * damping * shapes;
  const long double least = kUncoupled * modal.cwiseAbs().maxCoeff();
  for (Index i = 0; i < n_; ++i)
    if (modal(i, i) <= 0.1L * least) modal(i, i) = 0.0L;
  std::vector<Index> coupled;
  for (Index i = 0; i < n_; ++i) {
    bool is_alone = true;
    for (Index j = 0; j < n_; ++j) is_alone = is_alone && (j == i || std::abs(modal(i, j)) <= least);
    if (is_alone)
      add_alone(shapes, squares, modal, i);
    else
      coupled.push_back(i);
  }
  if (!coupled.empty()) add_coupled(shapes, squares, modal, coupled);
  find_extras(end_time);
  find_response();
  dofs_ = rows_of(LongMatrix::Identity(n_, n_));
  LongMatrix forms = LongMatrix::Zero(system.stop_count(), n_);
  for (Index i = 0; i < forms.rows(); ++i) {
    const LinearStop& stop = system.stops[static_cast<std::size_t>(i)];
    if (stop.a >= 0) forms(i, stop.a) += 1.0L;
    if (stop.b >= 0) forms(i, stop.b) -= 1.0L;
  }
  stops_ = rows_of(forms);
  project_ = left_.cast<double>();
  force_of_ = forcing_.cast<double>();
  x_.resize(static_cast<std::size_t>(n_));
  v_ = x_;
}

void ContactStateFlow::append(Block block, const LongMatrix& right, const LongMatrix& left, const LongMatrix& forcing) {
  const Index k = 2 * static_cast<Index>(blocks_.size());
  right_.conservativeResize(n_, k + 2);
  left_.conservativeResize(k + 2, 2 * n_);
  forcing_.conservativeResize(k + 2, n_);
  right_.rightCols(2) = right;
  left_.bottomRows(2) = left;
  forcing_.bottomRows(2) = forcing;
  largest_decay_ = std::max(largest_decay_, block.kind == Kind::reals || !block.oscillates() ? block.rate : block.decay);
  grows_ = grows_ || !block.oscillates();
  fastest_ = std::max(fastest_, block.rate);
  blocks_.push_back(std::move(block));
}

void ContactStateFlow::add_alone(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                                 Index mode) {
  Block block;
  const long double d = 0.5L * damping(mode, mode), turning = squares[mode] - d * d;
  block.decay = static_cast<double>(d);
  block.square = static_cast<double>(squares[mode]);
  block.turning = static_cast<double>(turning);
  block.frequency = static_cast<double>(std::sqrt(std::abs(turning)));
  block.rate = std::sqrt(block.square);
  if (turning < 0.0L) block.rate = std::max(block.rate, block.decay + block.frequency);
  LongMatrix right = LongMatrix::Zero(n_, 2), left = LongMatrix::Zero(2, 2 * n_), forcing = LongMatrix::Zero(2, n_);
  right.col(0) = shapes.col(mode);
  left.topLeftCorner(1, n_) = shapes.col(mode).transpose() * system_.mass;
  left.bottomRightCorner(1, n_) = left.topLeftCorner(1, n_);
  forcing.row(0) = shapes.col(mode).transpose();
  append(std::move(block), right, left, forcing);
}

void ContactStateFlow::add_coupled(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                                   const std::vector<Index>& modes) {
  const auto p = static_cast<Index>(modes.size());
  long double scale = 0.0L;
  for (const Index i : modes) scale = std::max({scale, std::sqrt(squares[i]), damping(i, i)});
  LongMatrix motion = LongMatrix::Zero(2 * p, 2 * p), some(n_, p);  // of (scale q, q')
  motion.topRightCorner(p, p).diagonal().setConstant(scale);
  for (Index i = 0; i < p; ++i) {
    some.col(i) = shapes.col(modes[static_cast<std::size_t>(i)]);
    motion(p + i, i) = -squares[modes[static_cast<std::size_t>(i)]] / scale;
    for (Index j = 0; j < p; ++j)
      motion(p + i, p + j) = -damping(modes[static_cast<std::size_t>(i)], modes[static_cast<std::size_t>(j)]);
  }
  const Eigen::EigenSolver<LongMatrix> solver(motion);
  const LongComplexMatrix vectors = solver.eigenvectors();
  const LongComplexMatrix inverse = vectors.partialPivLu().inverse();
  const long double condition = vectors.norm() * inverse.norm();
  if (solver.info() != Eigen::Success || !(condition < kParallel))
    throw RunError(
        "piecewise: dashpots make two motions of a contact state nearly the same (critical damping), so that they are no "
        "basis; take exact or rodas4");
  const LongMatrix weighted = some.transpose() * system_.mass;
  const auto right_of = [&](Index m) -> Eigen::Matrix<LongComplex, Eigen::Dynamic, 1> {
    return some.cast<LongComplex>() * vectors.col(m).head(p) / LongComplex(scale);
  };
  LongMatrix right(n_, 2), left(2, 2 * n_), forcing(2, n_);
  const auto fill_left = [&](Index row, const auto& of_q, const auto& of_v) {
    left.block(row, 0, 1, n_) = scale * of_q * weighted;
    left.block(row, n_, 1, n_) = of_v * weighted;
    forcing.row(row) = of_v * some.transpose();
  };
  Block reals;
  int held = 0;
  for (Index m = 0; m < 2 * p; ++m) {
    const LongComplex lambda = solver.eigenvalues()[m];
    const LongMatrix of_q_re = inverse.row(m).head(p).real(), of_v_re = inverse.row(m).tail(p).real();
    if (lambda.imag() < 0.0L) continue;  // the other one of a pair
    if (lambda.imag() > 0.0L) {
      Block block;
      block.kind = Kind::pair;
      block.decay = std::max(0.0, static_cast<double>(-lambda.real()));
      block.frequency = static_cast<double>(lambda.imag());
      block.square = static_cast<double>(std::norm(lambda));
      block.rate = static_cast<double>(std::abs(lambda));
      const auto r = right_of(m);
      LongMatrix shape(n_, 2);
      shape.col(0) = 2.0L * r.real();
      shape.col(1) = -2.0L * r.imag();
      fill_left(0, of_q_re, of_v_re);
      const LongMatrix of_q_im = inverse.row(m).head(p).imag(), of_v_im = inverse.row(m).tail(p).imag();
      fill_left(1, of_q_im, of_v_im);
      append(std::move(block), shape, left, forcing);
    }
  }
  for (Index m = 0; m < 2 * p; ++m) {
    const LongComplex lambda = solver.eigenvalues()[m];
    if (lambda.imag() != 0.0L) continue;
    const LongMatrix of_q = inverse.row(m).head(p).real(), of_v = inverse.row(m).tail(p).real();
    reals.rates[static_cast<std::size_t>(held)] = std::min(0.0, static_cast<double>(lambda.real()));
    right.col(held) = right_of(m).real();
    fill_left(held, of_q, of_v);
    if (++held == 1) continue;
    reals.kind = Kind::reals;
    reals.rate = std::max(-reals.rates[0], -reals.rates[1]);
    append(reals, right, left, forcing);
    held = 0;
  }
}

void ContactStateFlow::find_extras(double end_time) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    const auto is_slow = [&](double rate) { return rate * end_time < 0.5; };
    if (block.kind == Kind::mode)
      block.slow[0] = block.square == 0.0 || is_slow(std::sqrt(block.square) + 2.0 * block.decay);
    if (block.kind == Kind::reals)
      for (std::size_t i = 0; i < 2; ++i) block.slow[i] = is_slow(-block.rates[i]);
    for (Index j = 0; j < system_.harmonic_count(); ++j) {
      const double omega = system_.frequencies[static_cast<std::size_t>(j)];
      const bool resonates =
          block.oscillates() && std::hypot(block.decay, omega - block.frequency) < kResonance * block.frequency;
      if (resonates || ((block.slow[0] || block.slow[1]) && is_slow(omega) && is_slow(block.rate)))
        block.resonant.push_back(j);
      if (resonates) longest_ = std::min(longest_, kLongest / block.frequency);
    }
    if (!block.slow[0] && !block.slow[1] && block.resonant.empty()) continue;
    block.extra = static_cast<Index>(with_extras_.size());
    with_extras_.push_back(b);
    grows_ = true;
  }
}

void ContactStateFlow::find_response() {
  const Index harmonics = system_.harmonic_count();
  const LongMatrix by_cosine = forcing_ * system_.cosine, by_sine = forcing_ * system_.sine;
  harmonic_c_ = by_cosine.cast<double>();
  harmonic_s_ = by_sine.cast<double>();
  cosine_ = sine_ = LongMatrix::Zero(n_, harmonics);
  std::array<LongMatrix, 3> response;
  response.fill(LongMatrix::Zero(n_, n_));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const auto k = static_cast<Index>(2 * b);
    const LongVector r0 = right_.col(k), r1 = right_.col(k + 1);
    const long double d = block.decay, square = block.square;
    for (Index j = 0; j < harmonics; ++j) {
      if (std::find(block.resonant.begin(), block.resonant.end(), j) != block.resonant.end()) continue;
      const long double omega = system_.frequencies[static_cast<std::size_t>(j)];
      const long double c0 = by_cosine(k, j), s0 = by_sine(k, j), c1 = by_cosine(k + 1, j), s1 = by_sine(k + 1, j);
      if (block.kind == Kind::mode) {
        const long double root = std::sqrt(square), stiff = (root - omega) * (root + omega), drag = 2.0L * d * omega;
        const long double size = stiff * stiff + drag * drag;
        cosine_.col(j) += r0 * ((stiff * c0 - drag * s0) / size);
        sine_.col(j) += r0 * ((drag * c0 + stiff * s0) / size);
      } else if (block.kind == Kind::pair) {
        const LongComplex lambda(-d, block.frequency), i_omega(0.0L, omega), i(0.0L, 1.0L), gc(c0, c1), gs(s0, s1);
        const LongComplex ahead = 0.5L * (gc - i * gs) / (i_omega - lambda), back = 0.5L * (gc + i * gs) / (-i_omega - lambda);
        const LongComplex of_cosine = ahead + back, of_sine = i * (ahead - back);
        cosine_.col(j) += r0 * of_cosine.real() + r1 * of_cosine.imag();
        sine_.col(j) += r0 * of_sine.real() + r1 * of_sine.imag();
      } else {
        for (Index i = 0; i < 2; ++i) {
          const long double rate = block.rates[static_cast<std::size_t>(i)], size = rate * rate + omega * omega;
          const long double c = i == 0 ? c0 : c1, s = i == 0 ? s0 : s1;
          cosine_.col(j) -= right_.col(k + i) * ((rate * c + omega * s) / size);
          sine_.col(j) += right_.col(k + i) * ((omega * c - rate * s) / size);
        }
      }
    }
    if (block.kind == Kind::mode && !block.slow[0]) {
      const LongMatrix each = r0 * forcing_.row(k);
      response[0] += each / square;
      response[1] -= each * (2.0L * d / (square * square));
      response[2] += each * (4.0L * d * d / (square * square * square) - 1.0L / (square * square));
    } else if (block.kind == Kind::pair) {
      const LongComplex inverse = 1.0L / LongComplex(-d, block.frequency);
      LongComplex factor = -inverse;
      for (LongMatrix& each : response) {
        // Re and Im of factor (l_re + i l_im) f
        each += r0 * (factor.real() * forcing_.row(k) - factor.imag() * forcing_.row(k + 1)) +
                r1 * (factor.real() * forcing_.row(k + 1) + factor.imag() * forcing_.row(k));
        factor *= inverse;
      }
    } else if (block.kind == Kind::reals) {
      for (Index i = 0; i < 2; ++i) {
        if (block.slow[static_cast<std::size_t>(i)]) continue;
        const long double inverse = 1.0L / static_cast<long double>(block.rates[static_cast<std::size_t>(i)]);
        long double factor = -inverse;
        for (LongMatrix& each : response) {
          each += factor * right_.col(k + i) * forcing_.row(k + i);
          factor *= inverse;
        }
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) parabola_[k] = response[k].cast<double>();
}

ContactStateFlow::Rows ContactStateFlow::rows_of(const LongMatrix& forms) const {
  const LongMatrix all = forms * right_;
  Rows rows;
  for (Table& table : rows.of) table.resize(forms.rows(), all.cols());
  rows.size.resize(forms.rows(), static_cast<Index>(blocks_.size()));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const auto k = static_cast<Index>(2 * b);
    for (Index i = 0; i < forms.rows(); ++i) {
      const long double r0 = all(i, k), r1 = all(i, k + 1), d = block.decay, square = block.square;
      const auto set = [&](std::size_t order, long double first, long double second) {
        rows.of[order](i, k) = static_cast<double>(first);
        rows.of[order](i, k + 1) = static_cast<double>(second);
      };
      rows.size(i, static_cast<Index>(b)) = static_cast<double>(std::sqrt(r0 * r0 + r1 * r1));
      if (block.kind == Kind::mode) {
        set(0, r0, 0.0L);
        set(1, 0.0L, r0);
        set(2, -square * r0, -2.0L * d * r0);
        set(3, 2.0L * d * square * r0, (4.0L * d * d - square) * r0);
      } else if (block.kind == Kind::pair) {
        LongComplex form(r0, -r1);  // r0 Re z + r1 Im z = Re (form z)
        for (std::size_t order = 0; order < 4; ++order, form *= LongComplex(-d, block.frequency))
          set(order, form.real(), -form.imag());
      } else {
        long double first = r0, second = r1;
        for (std::size_t order = 0; order < 4; ++order, first *= block.rates[0], second *= block.rates[1])
          set(order, first, second);
      }
    }
  }
  rows.cosine = (forms * cosine_).cast<double>();
  rows.sine = (forms * sine_).cast<double>();
  rows.swing = (rows.cosine.array().square() + rows.sine.array().square()).sqrt().matrix();
  return rows;
}

void ContactStateFlow::begin(double t, const double* x, const double* v, const Eigen::MatrixXd& force, bool has_force,
                             double length, Piece& piece) const {
  const auto harmonics = system_.frequencies.size();
  piece.t = t;
  piece.start.resize(2 * blocks_.size());
  piece.y.resize(2 * blocks_.size());
  piece.phases.resize(2 * harmonics);
  piece.now.resize(2 * harmonics);
  piece.forcing.resize(6 * with_extras_.size());
  piece.extra.assign(8 * with_extras_.size(), 0.0);
  piece.displacement = piece.speed = 0.0;
  for (Index i = 0; i < n_; ++i) {
    x_[static_cast<std::size_t>(i)] = x[i];
    v_[static_cast<std::size_t>(i)] = v[i];
    piece.displacement = std::max(piece.displacement, std::abs(x[i]));
    piece.speed = std::max(piece.speed, std::abs(v[i]));
  }
  for (std::size_t j = 0; j < harmonics; ++j) {
    const double omega = system_.frequencies[j], c = std::cos(omega * t), s = std::sin(omega * t);
    piece.phases[2 * j] = c;
    piece.phases[2 * j + 1] = s;
    for (Index i = 0; i < n_; ++i) {
      const double by_cosine = dofs_.cosine(i, static_cast<Index>(j)), by_sine = dofs_.sine(i, static_cast<Index>(j));
      x_[static_cast<std::size_t>(i)] -= by_cosine * c + by_sine * s;
      v_[static_cast<std::size_t>(i)] -= omega * (by_sine * c - by_cosine * s);
    }
  }
  piece.is_short = has_force && fastest_ * length < kShort && !force.rightCols(2).isZero(0.0);
  piece.has_parabola = has_force = has_force && !piece.is_short;
  if (piece.is_short) expand(force, length, piece);
  if (has_force) {
    piece.parabola.resize(n_, 3);
    // Column by column; F_1 and F_2 are zero for constant loads.
    piece.parabola.noalias() = parabola_[0] * force;
    if (!force.rightCols(2).isZero(0.0)) {
      piece.parabola.col(0).noalias() += parabola_[1] * force.col(1);
      piece.parabola.col(0).noalias() += 2.0 * (parabola_[2] * force.col(2));
      piece.parabola.col(1).noalias() += 2.0 * (parabola_[1] * force.col(2));
    }
    for (Index i = 0; i < n_; ++i) {
      x_[static_cast<std::size_t>(i)] -= piece.parabola(i, 0);
      v_[static_cast<std::size_t>(i)] -= piece.parabola(i, 1);
    }
  }
  for (std::size_t e = 0; e < with_extras_.size(); ++e) {
    const auto row = static_cast<Index>(2 * with_extras_[e]);
    for (Index i = 0; i < 2; ++i)
      for (Index k = 0; k < 3; ++k)
        piece.forcing[6 * e + static_cast<std::size_t>(3 * i + k)] =
            has_force ? force_of_.row(row + i).dot(force.col(k)) : 0.0;
    const Block& block = blocks_[with_extras_[e]];
    respond(piece, block, 0.0, &piece.extra[8 * e]);
    for (Index i = 0; i < n_; ++i)
      v_[static_cast<std::size_t>(i)] -=
          dofs_.of[0](i, row) * piece.extra[8 * e + 1] + dofs_.of[0](i, row + 1) * piece.extra[8 * e + 5];
  }
  for (Index k = 0; k < project_.rows(); ++k) {
    double sum = 0.0;
    for (Index i = 0; i < n_; ++i)
      sum += project_(k, i) * x_[static_cast<std::size_t>(i)] + project_(k, n_ + i) * v_[static_cast<std::size_t>(i)];
    piece.start[static_cast<std::size_t>(k)] = sum;
  }
  piece.s = 0.0;
  piece.y = piece.start;
  piece.now = piece.phases;
}

void ContactStateFlow::expand(const Eigen::MatrixXd& force, double length, Piece& piece) const {
  piece.length = length;
  piece.series.resize(n_, kTerms);
  piece.series.leftCols(2).setZero();
  double power = length * length;
  for (Index k = 0; k + 2 < kTerms; ++k) {
    const auto order = static_cast<double>(k + 1);
    piece.series.col(k + 2).noalias() = -(length * order) * (by_v_ * piece.series.col(k + 1));
    piece.series.col(k + 2).noalias() -= (length * length) * (by_x_ * piece.series.col(k));
    if (k < 3) piece.series.col(k + 2).noalias() += power * (by_force_ * force.col(k));
    piece.series.col(k + 2) /= order * (order + 1.0);
    power *= length;
  }
}

void ContactStateFlow::go(Piece& piece, double s) const {
  piece.s = s;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const double y0 = piece.start[2 * b], y1 = piece.start[2 * b + 1], d = block.decay;
    double& z0 = piece.y[2 * b];
    double& z1 = piece.y[2 * b + 1];
    if (block.kind == Kind::reals) {
      z0 = std::exp(block.rates[0] * s) * y0;
      z1 = std::exp(block.rates[1] * s) * y1;
      continue;
    }
    double c, sine;
    if (block.kind == Kind::pair || block.turning > 0.0) {
      const double size = d == 0.0 ? 1.0 : std::exp(-d * s), angle = block.frequency * s;
      c = size * std::cos(angle);
      sine = size * std::sin(angle);
      if (block.kind == Kind::pair) {
        z0 = c * y0 - sine * y1;
        z1 = sine * y0 + c * y1;
        continue;
      }
      sine /= block.frequency;
    } else if (block.turning == 0.0) {
      c = d == 0.0 ? 1.0 : std::exp(-d * s);
      sine = s * c;
    } else {
      const double r = block.frequency, slow = std::exp(-block.square / (d + r) * s);
      c = 0.5 * slow * (1.0 + std::exp(-2.0 * r * s));
      sine = -0.5 * slow * std::expm1(-2.0 * r * s) / r;
    }
    z0 = (c + d * sine) * y0 + sine * y1;
    z1 = (c - d * sine) * y1 - block.square * sine * y0;
  }
  for (std::size_t j = 0; j < system_.frequencies.size(); ++j) {
    const double angle = system_.frequencies[j] * s, c = std::cos(angle), sine = std::sin(angle);
    piece.now[2 * j] = piece.phases[2 * j] * c - piece.phases[2 * j + 1] * sine;
    piece.now[2 * j + 1] = piece.phases[2 * j + 1] * c + piece.phases[2 * j] * sine;
  }
  for (std::size_t e = 0; e < with_extras_.size(); ++e) respond(piece, blocks_[with_extras_[e]], s, &piece.extra[8 * e]);
}

void ContactStateFlow::respond(const Piece& piece, const Block& block, double s, double* extra) const {
  std::fill(extra, extra + 8, 0.0);
  if (block.slow[0] || block.slow[1]) respond_slowly(piece, block, s, extra);
  if (block.oscillates() && !block.slow[0]) resonate(piece, block, s, extra);
}

Jet ContactStateFlow::stop(const Piece& piece, Index i) const {
  const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
  return jet(stops_, piece, i, stop.a, stop.b);
}

Jet ContactStateFlow::jet(const Rows& rows, const Piece& piece, Index row, Index a, Index b) const {
  Jet jet{};
  const Index count = static_cast<Index>(piece.y.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const double* form = rows.of[k].data() + row * count;
    double sum = 0.0;
    for (Index i = 0; i < count; ++i) sum += form[i] * piece.y[static_cast<std::size_t>(i)];
    jet[k] = sum;
  }
  for (std::size_t j = 0; j < system_.frequencies.size(); ++j) {
    const double omega = system_.frequencies[j], c = piece.now[2 * j], s = piece.now[2 * j + 1];
    const double by_cosine = rows.cosine(row, static_cast<Index>(j)), by_sine = rows.sine(row, static_cast<Index>(j));
    const double x = by_cosine * c + by_sine * s, v = omega * (by_sine * c - by_cosine * s);
    jet[0] += x;
    jet[1] += v;
    jet[2] -= omega * omega * x;
    jet[3] -= omega * omega * v;
  }
  if (piece.has_parabola) {
    const double s = piece.s;
    double sign = 1.0;
    for (const Index dof : {a, b}) {
      if (dof >= 0) {
        const double p0 = piece.parabola(dof, 0), p1 = piece.parabola(dof, 1), p2 = piece.parabola(dof, 2);
        jet[0] += sign * (p0 + s * (p1 + s * p2));
        jet[1] += sign * (p1 + 2.0 * s * p2);
        jet[2] += sign * 2.0 * p2;
      }
      sign = -1.0;
    }
  }
  if (piece.is_short) {
    const double s = piece.s / piece.length;
    Jet sum{};
    for (Index k = kTerms; k-- > 0;) {
      const double c = (a >= 0 ? piece.series(a, k) : 0.0) - (b >= 0 ? piece.series(b, k) : 0.0);
      sum[3] = sum[3] * s + 3.0 * sum[2];
      sum[2] = sum[2] * s + 2.0 * sum[1];
      sum[1] = sum[1] * s + sum[0];
      sum[0] = sum[0] * s + c;
    }
    double scale = 1.0;
    for (std::size_t k = 0; k < 4; ++k, scale /= piece.length) jet[k] += scale * sum[k];
  }
  for (std::size_t e = 0; e < with_extras_.size(); ++e) {
    const auto place = static_cast<Index>(2 * with_extras_[e]);
    const double r0 = rows.of[0](row, place), r1 = rows.of[0](row, place + 1);
    for (std::size_t k = 0; k < 4; ++k) jet[k] += r0 * piece.extra[8 * e + k] + r1 * piece.extra[8 * e + 4 + k];
  }
  return jet;
}

}  // namespace butee::integrators
