#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "butee/model/time_function.hpp"

namespace butee::model {

/// amplitude cos(angular_frequency t + phase)
class BUTEE_EXPORT Wave final : public TimeFunction {
 public:
  explicit Wave(const Harmonic& wave) : wave_(wave) {}
  double value(double t) const override;
  bool vanishes() const override { return wave_.amplitude == 0.0; }
  bool taylor(double t, double h, std::span<double> coefficients) const override;
  std::optional<Harmonic> harmonic() const override { return wave_; }

 private:
  Harmonic wave_;
};

/// A piecewise polynomial in time. Piece i, of degree kDegree or less in t - start, is valid from
/// its start to the next start; the first piece is also valid before its start.
class BUTEE_EXPORT PiecewisePolynomial final : public TimeFunction {
 public:
  static constexpr std::size_t kDegree = 4;
  struct Piece {
    double start = 0.0;
    std::array<double, kDegree + 1> coefficients{};
  };

  PiecewisePolynomial() : pieces_(1) {}
  /// `pieces` ascend and are not empty.
  explicit PiecewisePolynomial(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}
  /// The cubic spline through (times, values), with zero curvature at its beginning and zero slope
  /// at its end, after which it is constant. At least two instants, ascending.
  static PiecewisePolynomial spline(const std::vector<double>& times, const std::vector<double>& values);

  double value(double t) const override;
  bool vanishes() const override;
  bool taylor(double t, double h, std::span<double> coefficients) const override;
  bool is_piecewise_parabolic() const override;
  std::vector<double> discontinuities() const override;

  PiecewisePolynomial derivative() const;
  /// The integral that equals `at_zero` at t = 0; for pieces of degree kDegree - 1 or less.
  PiecewisePolynomial integral(double at_zero) const;
  void add(double constant);

 private:
  const Piece& piece_at(double t) const;

  std::vector<Piece> pieces_;
};

/// A motion that can be differentiated and integrated in closed form: the sum of a harmonic and a
/// piecewise polynomial.
struct BUTEE_EXPORT SmoothMotion {
  Harmonic wave{0.0, 0.0, 0.0};
  PiecewisePolynomial line;

  /// Made from a harmonic function or one that is a polynomial of degree two or less between
  /// discontinuities; for all others `problem` states the reason.
  static SmoothMotion of(const TimeFunction& function, std::string& problem);

  double value(double t) const;
  SmoothMotion derivative() const;
  SmoothMotion integral(double at_zero) const;
  /// Its parts that do not vanish, as separate functions.
  std::vector<std::unique_ptr<TimeFunction>> parts() const;
};

}  // namespace butee::model
