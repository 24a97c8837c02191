#pragma once

#include <cstdint>

namespace butee::linalg {

/// Counts of the work done. Each number is counted where the work is done.
struct Counters {
  std::int64_t force_evaluations = 0;    ///< evaluations of the right-hand side M^-1 (F + F_c - C v - K x)
  std::int64_t contact_evaluations = 0;  ///< evaluations of all stops of the scene
  std::int64_t law_evaluations = 0;      ///< evaluations of single stops
  std::int64_t factorizations = 0;       ///< numeric factorizations of matrices of the system, or of parts of it
  std::int64_t factor_updates = 0;       ///< updates of a factorization that replace a new one
  std::int64_t solves = 0;               ///< solutions with a factorization
};

inline Counters operator+(const Counters& a, const Counters& b) {
  return {a.force_evaluations + b.force_evaluations, a.contact_evaluations + b.contact_evaluations,
          a.law_evaluations + b.law_evaluations,     a.factorizations + b.factorizations,
          a.factor_updates + b.factor_updates,       a.solves + b.solves};
}

}  // namespace butee::linalg
