#include "butee/solve/force_balance.hpp"

#include <cmath>

#include "butee/solve/lanes.hpp"

namespace butee::solve {
namespace {

/// Adds `sign` times a piece of a term to the residual and its squares to the sum of squares.
inline void take(double sign, const double* term, Lane& residual, Lane& squares) {
  Lane piece;
  load(term, piece);
  residual += sign * piece;
  squares += piece * piece;
}

inline void take(double sign, const double* term, double& residual, double& squares) {
  residual += sign * *term;
  squares += *term * *term;
}

/// One row, or as many as a lane has.
template <bool has_load, bool has_contact, bool has_damping, class Piece>
inline void take_all(const ForceTerms& terms, Index i, Piece& r, std::array<Piece, 5>& squares) {
  if constexpr (has_load) take(1.0, terms.load + i, r, squares[0]);
  if constexpr (has_contact) take(1.0, terms.contact + i, r, squares[1]);
  take(-1.0, terms.inertia + i, r, squares[2]);
  if constexpr (has_damping) take(-1.0, terms.damping + i, r, squares[3]);
  take(-1.0, terms.elastic + i, r, squares[4]);
}

}  // namespace

template <bool has_load, bool has_contact, bool has_damping>
void ForceBalance::add_terms(const ForceTerms& terms, Index count, double* residual) {
  Index i = 0;
  if (count >= kLaneSize) {
    std::array<Lane, 5> squares{};
    Lane residual_squares{};
    for (; i + kLaneSize <= count; i += kLaneSize) {
      Lane r{};
      take_all<has_load, has_contact, has_damping>(terms, i, r, squares);
      residual_squares += r * r;
      store(r, residual + i);
    }
    for (std::size_t k = 0; k < squares.size(); ++k) squares_[k] += sum(squares[k]);
    residual_square_ += sum(residual_squares);
  }
  for (const Index end = i + count % kLaneSize; i < end; ++i) {
    double r = 0.0;
    take_all<has_load, has_contact, has_damping>(terms, i, r, squares_);
    residual_square_ += r * r;
    residual[i] = r;
  }
}

template <bool has_load, bool has_contact>
void ForceBalance::add_with(const ForceTerms& terms, Index count, double* residual) {
  terms.damping != nullptr ? add_terms<has_load, has_contact, true>(terms, count, residual)
                           : add_terms<has_load, has_contact, false>(terms, count, residual);
}

void ForceBalance::add(const ForceTerms& terms, Index count, double* residual) {
  if (terms.contact != nullptr)
    terms.load != nullptr ? add_with<true, true>(terms, count, residual)
                          : add_with<false, true>(terms, count, residual);
  else
    terms.load != nullptr ? add_with<true, false>(terms, count, residual)
                          : add_with<false, false>(terms, count, residual);
}

double ForceBalance::residual() const {
  return std::sqrt(residual_square_);
}

double ForceBalance::scale() const {
  double sum = 0.0;
  for (const double square : squares_) sum += std::sqrt(square);
  return sum;
}

}  // namespace butee::solve
