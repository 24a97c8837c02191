#include "butee/solve/force_balance.hpp"

#include <cmath>

#include "butee/solve/lanes.hpp"

namespace butee::solve {
namespace {

/// Adds `sign` times a piece of a term to the residual and its squares to the sum of squares.
inline void add(double sign, const double* term, Lane& residual, Lane& squares) {
  Lane piece;
  load(term, piece);
  residual += sign * piece;
  squares += piece * piece;
}

inline void add(double sign, double term, double& residual, double& squares) {
  residual += sign * term;
  squares += term * term;
}

template <bool has_contact, bool has_damping>
double balance(const ForceTerms& terms, Index size, double* residual) {
  Lane load{}, contact{}, inertia{}, damping{}, elastic{};
  Index i = 0;
  for (; i + kLaneSize <= size; i += kLaneSize) {
    Lane r{};
    add(1.0, terms.load + i, r, load);
    if constexpr (has_contact) add(1.0, terms.contact + i, r, contact);
    add(-1.0, terms.inertia + i, r, inertia);
    if constexpr (has_damping) add(-1.0, terms.damping + i, r, damping);
    add(-1.0, terms.elastic + i, r, elastic);
    store(r, residual + i);
  }
  double last_load = sum(load), last_contact = sum(contact), last_inertia = sum(inertia), last_damping = sum(damping),
         last_elastic = sum(elastic);
  for (; i < size; ++i) {
    double r = 0.0;
    add(1.0, terms.load[i], r, last_load);
    if constexpr (has_contact) add(1.0, terms.contact[i], r, last_contact);
    add(-1.0, terms.inertia[i], r, last_inertia);
    if constexpr (has_damping) add(-1.0, terms.damping[i], r, last_damping);
    add(-1.0, terms.elastic[i], r, last_elastic);
    residual[i] = r;
  }
  return std::sqrt(last_load) + std::sqrt(last_contact) + std::sqrt(last_inertia) + std::sqrt(last_damping) +
         std::sqrt(last_elastic);
}

}  // namespace

double force_balance(const ForceTerms& terms, Index size, double* residual) {
  if (terms.contact != nullptr)
    return terms.damping != nullptr ? balance<true, true>(terms, size, residual)
                                    : balance<true, false>(terms, size, residual);
  return terms.damping != nullptr ? balance<false, true>(terms, size, residual)
                                  : balance<false, false>(terms, size, residual);
}

}  // namespace butee::solve
