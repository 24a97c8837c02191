#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "butee/dynamics/local_contact.hpp"
#include "butee/dynamics/modal_damping.hpp"
#include "butee/dynamics/turning.hpp"

namespace butee::dynamics {

/// Solves the effective equations of an implicit method,
///
///     (M + c C + k (K + S^T diag(kappa) S)) y = b,     C = c_m M + c_k K + D, or modal damping + D
///
/// with the feedback factors c (s) and k (s2) of the method (gamma h and beta h^2 for Newmark) and the stiffnesses
/// kappa (N/m) of the stops, zero where open.
///
/// A_0 = M + c C + k K is factorized once for each (c, k), of which the last few are kept; the stops are taken care of
/// by LocalContact. Systems of one DOF, for which that is a detour, and those with very many stops are
/// factorized anew for every kappa, as is any with a negative kappa. The result is a function of (system, c, k, kappa)
/// alone, whatever was solved before.
///
/// Where C or K is not symmetric, A_0 is factorized by sparse LU; with a stop closed the whole matrix is.
class BUTEE_EXPORT EffectiveSolver {
 public:
  enum class Contacts {
    local,      ///< a small system on the stops
    factorized  ///< a new factorization for every kappa
  };

  /// All arguments must outlive it; `modal` is null without modal damping, `turning` unless the speed of rotation
  /// varies. The way to treat contacts is chosen by their number.
  EffectiveSolver(const model::System& system, const Contact& contact, linalg::Counters& counters,
                  const ModalDamping* modal = nullptr, const Turning* turning = nullptr);
  /// With a way of one's own, for comparisons.
  EffectiveSolver(const model::System& system, const Contact& contact, linalg::Counters& counters, Contacts contacts,
                  const ModalDamping* modal = nullptr, const Turning* turning = nullptr);

  /// Sets the feedback factors; work is done only where they are new.
  void set_factors(double damping, double stiffness);

  /// b := y. `kappa` has an entry per stop. False where the matrix is not positive definite.
  [[nodiscard]] bool solve(ConstVectorRef kappa, VectorRef b);

 private:
  /// What is kept of one pair of factors.
  struct Slot {
    Slot(const SparseMatrix& pattern, linalg::Counters& counters, const ModalDamping* modal, bool is_symmetric)
        : base(pattern, counters, modal != nullptr ? &modal->matrix() : nullptr, is_symmetric) {}

    double damping = -1.0, stiffness = -1.0;
    int revision = 0;  ///< of the turning parts
    bool usable = false;
    linalg::LinearSolver base;
    std::optional<LocalContact> local;
  };

  void assemble_base(double damping, double stiffness);
  bool solve_factorized(ConstVectorRef kappa, VectorRef b);
  bool solve_modal(VectorRef b);
  bool solve_scalar(ConstVectorRef kappa, VectorRef b);
  void prepare_factorized();

  const model::System& system_;
  const Contact& contact_;
  linalg::Counters& counters_;
  const ModalDamping* modal_;
  const Turning* turning_;
  Contacts contacts_;
  SparseMatrix base_;  ///< M + c C + k K without modal damping
  std::vector<std::unique_ptr<Slot>> slots_;
  std::size_t current_ = 0, oldest_ = 0;
  double damping_factor_ = -1.0, stiffness_factor_ = -1.0;
  int revision_ = 0;

  // Where factorized for every kappa.
  SparseMatrix effective_;
  std::optional<linalg::SymmetricFactor> factor_;
  std::optional<linalg::LinearSolver> general_factor_;  ///< instead, of matrices that are not symmetric
  std::optional<linalg::LinearSolver> modal_factor_;    ///< instead, with modal damping
  /// Places of stop i in the value array: (a,a), (b,b), (a,b), (b,a), -1 where an end is fixed.
  std::vector<std::array<Index, 4>> places_;
};

}  // namespace butee::dynamics
