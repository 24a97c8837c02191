#include "butee/solve/effective_solver.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::solve {
namespace {

Index place_of(const SparseMatrix& matrix, Index row, Index column) {
  if (row < 0 || column < 0) return -1;
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, static_cast<int>(row));
  require(found != end && *found == row, "the pattern lacks the place of a stop");
  return found - matrix.innerIndexPtr();
}

}  // namespace

EffectiveSolver::EffectiveSolver(const model::System& system, const Contact& contact, Counters& counters)
    : system_(system),
      base_(system.mass),
      effective_(system.mass),
      factor_(system.mass, counters),
      has_stops_(contact.size() > 0) {
  locate_stops(contact);
}

void EffectiveSolver::locate_stops(const Contact& contact) {
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    places_.push_back({place_of(base_, a, a), place_of(base_, b, b), place_of(base_, a, b), place_of(base_, b, a)});
  }
}

void EffectiveSolver::set_factors(double damping, double stiffness) {
  if (damping == damping_factor_ && stiffness == stiffness_factor_) return;
  damping_factor_ = damping;
  stiffness_factor_ = stiffness;
  factorized_ = false;
  const double on_mass = 1.0 + damping * system_.damping.mass_proportional;
  const double on_stiffness = stiffness + damping * system_.damping.stiffness_proportional;
  base_.coeffs() = on_mass * system_.mass.coeffs() + on_stiffness * system_.stiffness.coeffs();
  if (system_.dashpots.size() > 0) base_.coeffs() += damping * system_.dashpots.coeffs();
}

bool EffectiveSolver::solve(ConstVectorRef kappa, VectorRef b) {
  require(stiffness_factor_ >= 0.0, "set_factors() comes before solve()");
  if (has_stops_) {
    effective_.coeffs() = base_.coeffs();
    double* values = effective_.valuePtr();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double k = stiffness_factor_ * kappa[static_cast<Index>(i)];
      const auto [aa, bb, ab, ba] = places_[i];
      if (aa >= 0) values[aa] += k;
      if (bb >= 0) values[bb] += k;
      if (ab >= 0) values[ab] -= k;
      if (ba >= 0) values[ba] -= k;
    }
    if (!factor_.factorize(effective_)) return false;
  } else if (!factorized_) {
    if (!factor_.factorize(base_)) return false;
    factorized_ = true;
  }
  factor_.solve(b);
  return true;
}

}  // namespace butee::solve
