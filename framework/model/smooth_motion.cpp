#include "butee/model/smooth_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/core/error.hpp"

namespace butee::model {
namespace {

constexpr double kQuarter = 0.5 * std::numbers::pi;

}  // namespace

double Wave::value(double t) const {
  return wave_.amplitude * std::cos(wave_.angular_frequency * t + wave_.phase);
}

bool Wave::taylor(double t, double h, std::span<double> coefficients) const {
  const double angle = wave_.angular_frequency * t + wave_.phase, cosine = std::cos(angle), sine = std::sin(angle);
  const std::array<double, 4> derivatives = {cosine, -sine, -cosine, sine};
  double factor = wave_.amplitude;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    coefficients[k] = factor * derivatives[k % 4];
    factor *= wave_.angular_frequency * h / static_cast<double>(k + 1);
  }
  return true;
}

const PiecewisePolynomial::Piece& PiecewisePolynomial::piece_at(double t) const {
  const auto after = std::upper_bound(pieces_.begin() + 1, pieces_.end(), t,
                                      [](double instant, const Piece& piece) { return instant < piece.start; });
  return *(after - 1);
}

double PiecewisePolynomial::value(double t) const {
  const Piece& piece = piece_at(t);
  double sum = 0.0;
  for (std::size_t k = kDegree + 1; k-- > 0;) sum = sum * (t - piece.start) + piece.coefficients[k];
  return sum;
}

bool PiecewisePolynomial::vanishes() const {
  return std::all_of(pieces_.begin(), pieces_.end(), [](const Piece& piece) {
    return std::all_of(piece.coefficients.begin(), piece.coefficients.end(), [](double c) { return c == 0.0; });
  });
}

bool PiecewisePolynomial::taylor(double t, double h, std::span<double> coefficients) const {
  const Piece& piece = piece_at(t);
  std::fill(coefficients.begin(), coefficients.end(), 0.0);
  auto shifted = piece.coefficients;
  for (std::size_t i = 0; i < kDegree; ++i)
    for (std::size_t k = kDegree; k-- > i;) shifted[k] += (t - piece.start) * shifted[k + 1];
  double power = 1.0;
  for (std::size_t k = 0; k < std::min(coefficients.size(), shifted.size()); ++k, power *= h)
    coefficients[k] = power * shifted[k];
  return true;
}

bool PiecewisePolynomial::is_piecewise_parabolic() const {
  return std::all_of(pieces_.begin(), pieces_.end(),
                     [](const Piece& piece) { return piece.coefficients[3] == 0.0 && piece.coefficients[4] == 0.0; });
}

std::vector<double> PiecewisePolynomial::discontinuities() const {
  std::vector<double> starts;
  for (std::size_t i = 1; i < pieces_.size(); ++i) starts.push_back(pieces_[i].start);
  return starts;
}

PiecewisePolynomial PiecewisePolynomial::derivative() const {
  PiecewisePolynomial result = *this;
  for (Piece& piece : result.pieces_) {
    for (std::size_t k = 0; k < kDegree; ++k)
      piece.coefficients[k] = static_cast<double>(k + 1) * piece.coefficients[k + 1];
    piece.coefficients[kDegree] = 0.0;
  }
  return result;
}

PiecewisePolynomial PiecewisePolynomial::integral(double at_zero) const {
  PiecewisePolynomial result = *this;
  double begin = 0.0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    require(pieces_[i].coefficients[kDegree] == 0.0, "a polynomial of lower degree");
    Piece& piece = result.pieces_[i];
    for (std::size_t k = kDegree; k > 0; --k)
      piece.coefficients[k] = pieces_[i].coefficients[k - 1] / static_cast<double>(k);
    piece.coefficients[0] = begin;
    if (i + 1 == pieces_.size()) break;
    double sum = 0.0;
    for (std::size_t k = kDegree + 1; k-- > 0;)
      sum = sum * (pieces_[i + 1].start - piece.start) + piece.coefficients[k];
    begin = sum;
  }
  result.add(at_zero - result.value(0.0));
  return result;
}

void PiecewisePolynomial::add(double constant) {
  for (Piece& piece : pieces_) piece.coefficients[0] += constant;
}

PiecewisePolynomial PiecewisePolynomial::spline(const std::vector<double>& times, const std::vector<double>& values) {
  const std::size_t n = times.size();
  require(n >= 2 && values.size() == n, "a spline of two or more points");
  // Curvatures m_i: h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = 6 (s_i - s_(i-1)) with
  // the slopes s of chords; m_0 = 0 and, for zero slope at the end, h m_(n-2) + 2 h m_(n-1) = -6
  // s_(n-2).
  std::vector<double> diagonal(n, 1.0), upper(n, 0.0), m(n, 0.0);
  const auto h = [&](std::size_t i) { return times[i + 1] - times[i]; };
  const auto slope = [&](std::size_t i) { return (values[i + 1] - values[i]) / h(i); };
  for (std::size_t i = 1; i < n; ++i) {
    const bool is_last = i + 1 == n;
    const double lower = h(i - 1), factor = lower / diagonal[i - 1];
    diagonal[i] = (is_last ? 2.0 * lower : 2.0 * (lower + h(i))) - factor * upper[i - 1];
    upper[i] = is_last ? 0.0 : h(i);
    m[i] = 6.0 * ((is_last ? 0.0 : slope(i)) - slope(i - 1)) - factor * m[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) m[i] = (m[i] - (i + 1 < n ? upper[i] * m[i + 1] : 0.0)) / diagonal[i];
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < n; ++i)
    pieces.push_back({times[i],
                      {values[i], slope(i) - h(i) / 6.0 * (2.0 * m[i] + m[i + 1]), 0.5 * m[i],
                       (m[i + 1] - m[i]) / (6.0 * h(i)), 0.0}});
  pieces.push_back({times.back(), {values.back()}});
  return PiecewisePolynomial(std::move(pieces));
}

SmoothMotion SmoothMotion::of(const TimeFunction& function, std::string& problem) {
  SmoothMotion motion;
  if (const auto wave = function.harmonic()) {
    motion.wave = *wave;
    return motion;
  }
  std::vector<double> starts = {0.0};
  for (const double t : function.discontinuities())
    if (t > 0.0) starts.push_back(t);
  std::vector<PiecewisePolynomial::Piece> pieces;
  for (const double start : starts) {
    PiecewisePolynomial::Piece piece{start, {}};
    std::array<double, 3> coefficients{};
    if (!function.is_piecewise_parabolic() || !function.taylor(start, 1.0, coefficients)) {
      problem = "only harmonic, constant, ramp and table can be integrated";
      return motion;
    }
    std::copy(coefficients.begin(), coefficients.end(), piece.coefficients.begin());
    pieces.push_back(piece);
  }
  motion.line = PiecewisePolynomial(std::move(pieces));
  return motion;
}

double SmoothMotion::value(double t) const {
  const double oscillation = wave.amplitude == 0.0 ? 0.0 : Wave(wave).value(t);
  return oscillation + line.value(t);
}

SmoothMotion SmoothMotion::derivative() const {
  return {{wave.amplitude * wave.angular_frequency, wave.angular_frequency, wave.phase + kQuarter}, line.derivative()};
}

SmoothMotion SmoothMotion::integral(double at_zero) const {
  SmoothMotion result;
  if (wave.angular_frequency != 0.0) {
    result.wave = {wave.amplitude / wave.angular_frequency, wave.angular_frequency, wave.phase - kQuarter};
    result.line = line.integral(at_zero - (wave.amplitude != 0.0 ? Wave(result.wave).value(0.0) : 0.0));
    return result;
  }
  PiecewisePolynomial whole = line;
  whole.add(wave.amplitude * std::cos(wave.phase));
  result.line = whole.integral(at_zero);
  return result;
}

std::vector<std::unique_ptr<TimeFunction>> SmoothMotion::parts() const {
  std::vector<std::unique_ptr<TimeFunction>> all;
  if (wave.amplitude != 0.0) all.push_back(std::make_unique<Wave>(wave));
  if (!line.vanishes()) all.push_back(std::make_unique<PiecewisePolynomial>(line));
  return all;
}

}  // namespace butee::model
