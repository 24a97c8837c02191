#include "butee/dynamics/effective_solver.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::dynamics {
namespace {

/// An adaptive method alternates between few step sizes; each one kept costs the memory of a
/// factorization.
constexpr std::size_t kSlots = 4;

Index place_of(const SparseMatrix& matrix, Index row, Index column) {
  if (row < 0 || column < 0) return -1;
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  const int* found = std::lower_bound(begin, end, static_cast<int>(row));
  require(found != end && *found == row, "the pattern lacks the place of a stop");
  return found - matrix.innerIndexPtr();
}

bool prefers_local(const model::System& system, const ElasticStops& contact, const ModalDamping* modal) {
  if (system.size() == 1) return contact.size() == 0;
  if (!system.is_symmetric) return true;
  return contact.size() <= LocalContact::kMostStops || (modal != nullptr && modal->matrix().prefers_dense());
}

}  // namespace

EffectiveSolver::EffectiveSolver(const model::System& system, const ElasticStops& contact, linalg::Counters& counters,
                                 const ModalDamping* modal, const Turning* turning)
    : EffectiveSolver(system, contact, counters,
                      prefers_local(system, contact, modal) ? Contacts::local : Contacts::factorized, modal, turning) {}

EffectiveSolver::EffectiveSolver(const model::System& system, const ElasticStops& contact, linalg::Counters& counters,
                                 Contacts contacts, const ModalDamping* modal, const Turning* turning)
    : system_(system),
      contact_(contact),
      counters_(counters),
      modal_(modal),
      turning_(turning),
      contacts_(contacts),
      base_(system.mass) {}

void EffectiveSolver::prepare_matrix() {
  effective_ = base_;
  for (Index i = 0; i < contact_.size(); ++i) {
    const Index a = contact_.dof_a(i), b = contact_.dof_b(i);
    places_.push_back({place_of(base_, a, a), place_of(base_, b, b), place_of(base_, a, b), place_of(base_, b, a)});
  }
}

void EffectiveSolver::prepare_factor() {
  if (modal_ != nullptr)
    modal_factor_.emplace(base_, counters_, &modal_->matrix());
  else if (!system_.is_symmetric)
    general_factor_.emplace(base_, counters_, nullptr, false);
  else
    factor_.emplace(base_, counters_);
}

void EffectiveSolver::assemble_base(double damping, double stiffness) {
  const double on_mass = 1.0 + damping * system_.damping.mass_proportional;
  const double on_stiffness = stiffness + damping * system_.damping.stiffness_proportional;
  base_.coeffs() = on_mass * system_.mass.coeffs() + on_stiffness * system_.stiffness.coeffs();
  if (system_.dashpots.size() > 0) base_.coeffs() += damping * system_.dashpots.coeffs();
  if (turning_ != nullptr) turning_->add_to(damping, on_stiffness, base_);
}

void EffectiveSolver::set_factors(double damping, double stiffness) {
  const int revision = turning_ != nullptr ? turning_->revision() : 0;
  if (damping == damping_factor_ && stiffness == stiffness_factor_ && revision == revision_) return;
  revision_ = revision;
  damping_factor_ = damping;
  stiffness_factor_ = stiffness;
  if (contacts_ == Contacts::factorized) return assemble_base(damping, stiffness);
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i]->damping == damping && slots_[i]->stiffness == stiffness && slots_[i]->revision == revision) {
      current_ = i;
      return;
    }
  if (slots_.size() < kSlots) {
    current_ = slots_.size();
    slots_.push_back(std::make_unique<Slot>(base_, counters_, modal_, system_.is_symmetric));
    if (contact_.size() > 0 && system_.is_symmetric) slots_.back()->local.emplace(contact_);
  } else {
    current_ = oldest_;
    oldest_ = (oldest_ + 1) % kSlots;
  }
  Slot& slot = *slots_[current_];
  slot.damping = damping;
  slot.stiffness = stiffness;
  slot.revision = revision;
  assemble_base(damping, stiffness);
  slot.usable = slot.base.factorize(base_, damping);
  if (slot.usable && slot.local) slot.local->set_base(slot.base);
}

bool EffectiveSolver::solve(ConstVectorRef kappa, VectorRef b) {
  require(stiffness_factor_ >= 0.0, "set_factors() comes before solve()");
  if (contacts_ == Contacts::factorized)
    return system_.size() == 1 ? solve_scalar(kappa, b) : solve_factorized(kappa, b);
  Slot& slot = *slots_[current_];
  if (!slot.usable) return false;
  const bool by_base = system_.is_symmetric ? (kappa.array() >= 0.0).all() : kappa.isZero(0.0);
  if (!by_base) {
    assemble_base(damping_factor_, stiffness_factor_);
    return solve_factorized(kappa, b);
  }
  slot.base.solve(b);
  return !slot.local || slot.local->correct(slot.base, stiffness_factor_, kappa, b);
}

bool EffectiveSolver::solve_scalar(ConstVectorRef kappa, VectorRef b) {
  ++counters_.factorizations;
  ++counters_.solves;
  double stiffness = 0.0;
  for (Index i = 0; i < kappa.size(); ++i) stiffness += kappa[i];
  const double modal = modal_ != nullptr ? damping_factor_ * modal_->single() : 0.0;
  const double a = base_.valuePtr()[0] + modal + stiffness_factor_ * stiffness;
  if (!(a > 0.0)) return false;
  b[0] /= a;
  return true;
}

const SparseMatrix& EffectiveSolver::matrix(ConstVectorRef kappa) {
  require(stiffness_factor_ >= 0.0, "set_factors() comes before matrix()");
  assemble_base(damping_factor_, stiffness_factor_);
  add_stops(kappa);
  return effective_;
}

void EffectiveSolver::add_stops(ConstVectorRef kappa) {
  if (effective_.size() == 0) prepare_matrix();
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
}

bool EffectiveSolver::solve_factorized(ConstVectorRef kappa, VectorRef b) {
  add_stops(kappa);
  if (!factor_ && !general_factor_ && !modal_factor_) prepare_factor();
  if (modal_ != nullptr) return solve_modal(b);
  if (general_factor_) {
    if (!general_factor_->factorize(effective_)) return false;
    general_factor_->solve(b);
    return true;
  }
  if (!factor_->factorize(effective_)) return false;
  factor_->solve(b);
  return true;
}

bool EffectiveSolver::solve_modal(VectorRef b) {
  if (!modal_factor_->factorize(effective_, damping_factor_)) return false;
  modal_factor_->solve(b);
  return true;
}

}  // namespace butee::dynamics
