#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "butee/dynamics/local_contact.hpp"
#include "butee/dynamics/modal_damping.hpp"
#include "butee/dynamics/turning.hpp"

namespace butee::dynamics {

/// Solves the effective equations of an implicit method:
///
///     (M + c C + k (K + S^T diag(kappa) S)) y = b,     C = c_m M + c_k K + D, or modal damping + D
///
/// The method gives the feedback factors c (s) and k (s2), which are gamma h and beta h^2 for
/// Newmark, and the stiffnesses kappa (N/m) of the stops, zero for open stops.
///
/// A_0 = M + c C + k K is factorized once for each (c, k), and the last few factorizations are
/// kept; LocalContact accounts for the stops. Systems with one DOF, for which that is a detour, and
/// systems with very many stops are factorized anew for every kappa, as is any system with a
/// negative kappa. The result is a function of (system, c, k, kappa) alone, independent of earlier
/// solves.
///
/// If C or K is not symmetric, A_0 is factorized by sparse LU; with a closed stop the whole matrix
/// is.
class BUTEE_EXPORT EffectiveSolver {
 public:
  enum class Contacts {
    local,      ///< a small dense system for the stops
    factorized  ///< a new factorization for every kappa
  };

  /// All arguments must outlive this object; `modal` is null without modal damping, `turning` is
  /// null unless the speed of rotation varies. The treatment of contacts is chosen by their number.
  EffectiveSolver(const model::System& system, const ElasticStops& contact, linalg::Counters& counters,
                  const ModalDamping* modal = nullptr, const Turning* turning = nullptr);
  /// With a given treatment of contacts, for comparisons.
  EffectiveSolver(const model::System& system, const ElasticStops& contact, linalg::Counters& counters,
                  Contacts contacts, const ModalDamping* modal = nullptr, const Turning* turning = nullptr);

  /// Sets the feedback factors; does work only if they have changed.
  void set_factors(double damping, double stiffness);

  /// The matrix above without modal damping, to be factorized by the caller together with further terms. Valid until
  /// the next call of a function that is not const.
  const SparseMatrix& matrix(ConstVectorRef kappa);
  bool has_modal_damping() const { return modal_ != nullptr; }
  linalg::Counters& counters() const { return counters_; }

  /// Solves in place: b := y. `kappa` has an entry per stop. False if the matrix is not positive
  /// definite.
  [[nodiscard]] bool solve(ConstVectorRef kappa, VectorRef b);

 private:
  /// Cached data of one pair of factors.
  struct Slot {
    Slot(const SparseMatrix& pattern, linalg::Counters& counters, const ModalDamping* modal, bool is_symmetric)
        : base(pattern, counters, modal != nullptr ? &modal->matrix() : nullptr, is_symmetric) {}

    double damping = -1.0, stiffness = -1.0;
    int revision = 0;  ///< revision of the turning parts
    bool usable = false;
    linalg::LinearSolver base;
    std::optional<LocalContact> local;
  };

  void assemble_base(double damping, double stiffness);
  /// effective_ := base_ with the stops
  void add_stops(ConstVectorRef kappa);
  bool solve_factorized(ConstVectorRef kappa, VectorRef b);
  bool solve_modal(VectorRef b);
  bool solve_scalar(ConstVectorRef kappa, VectorRef b);
  void prepare_matrix();
  void prepare_factor();

  const model::System& system_;
  const ElasticStops& contact_;
  linalg::Counters& counters_;
  const ModalDamping* modal_;
  const Turning* turning_;
  Contacts contacts_;
  SparseMatrix base_;  ///< M + c C + k K without modal damping
  std::vector<std::unique_ptr<Slot>> slots_;
  std::size_t current_ = 0, oldest_ = 0;
  double damping_factor_ = -1.0, stiffness_factor_ = -1.0;
  int revision_ = 0;

  // For factorization at every kappa.
  SparseMatrix effective_;
  std::optional<linalg::SymmetricFactor> factor_;
  std::optional<linalg::LinearSolver> general_factor_;  ///< for matrices that are not symmetric
  std::optional<linalg::LinearSolver> modal_factor_;    ///< with modal damping
  /// Positions of stop i in the value array: (a,a), (b,b), (a,b), (b,a), -1 for a fixed end.
  std::vector<std::array<Index, 4>> places_;
};

}  // namespace butee::dynamics
