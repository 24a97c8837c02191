#include <algorithm>
#include <cmath>

#include "integrators/contact_state_flow.hpp"

namespace butee::integrators {
namespace {

/// If load discontinuities are closer than kShort over the fastest rate, the parabola would be the
/// difference of much larger ones; the response is then a power series with kTerms terms.
constexpr double kShort = 1.0;
constexpr Index kTerms = 23;

}  // namespace

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
  // Rounding of the parts into which the motion is divided is larger than that of their sum.
  for (Index i = 0; i < n_; ++i) {
    piece.displacement = std::max(piece.displacement, std::abs(x_[static_cast<std::size_t>(i)]));
    piece.speed = std::max(piece.speed, std::abs(v_[static_cast<std::size_t>(i)]));
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
  for (std::size_t e = 0; e < with_extras_.size(); ++e)
    respond(piece, blocks_[with_extras_[e]], s, &piece.extra[8 * e]);
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

Eigen::MatrixXd ContactStateFlow::propagator(double s) const {
  Eigen::MatrixXd product(2 * n_, 2 * n_);
  Piece piece;
  piece.start.resize(2 * blocks_.size());
  piece.y.resize(piece.start.size());
  const auto harmonics = 2 * system_.frequencies.size();
  piece.phases.assign(harmonics, 0.0);
  piece.now.assign(harmonics, 0.0);
  piece.forcing.assign(6 * with_extras_.size(), 0.0);
  piece.extra.assign(8 * with_extras_.size(), 0.0);
  for (Index column = 0; column < 2 * n_; ++column) {
    for (std::size_t k = 0; k < piece.start.size(); ++k) piece.start[k] = project_(static_cast<Index>(k), column);
    go(piece, s);
    for (Index i = 0; i < n_; ++i) {
      const Jet jet = dof(piece, i);
      product(i, column) = jet[0];
      product(n_ + i, column) = jet[1];
    }
  }
  return product;
}

}  // namespace butee::integrators
