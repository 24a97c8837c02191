#pragma once

#include <vector>

#include "butee/linalg/counters.hpp"
#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The elastic scalar stops of a system (m = 1, no memory, no dissipation), all at once in stop space: displacements w
/// = S x (m stops), forces F_c = S^T f.
///
/// S selects u_a, or u_a - u_b for a stop between two nodes. All vectors here have one entry per
/// stop.
class BUTEE_EXPORT ElasticStops {
 public:
  /// `system` and `counters` must outlive this object.
  ElasticStops(const model::System& system, linalg::Counters& counters);

  Index size() const { return static_cast<Index>(a_.size()); }
  /// n, the free DOFs of the system.
  Index system_size() const { return system_size_; }

  /// w := S x
  void displacement(ConstVectorRef x, VectorRef w) const {
    if (!grounded_) return difference(x, w);
    for (std::size_t i = 0; i < a_.size(); ++i) w[static_cast<Index>(i)] = x[a_[i]];
  }
  /// F += S^T f
  void scatter(ConstVectorRef f, VectorRef force) const {
    if (!grounded_) return scatter_both(f, force);
    for (std::size_t i = 0; i < a_.size(); ++i) force[a_[i]] += f[static_cast<Index>(i)];
  }

  /// f(w), N
  void force(ConstVectorRef w, VectorRef f);
  /// f(w) and k = -df/dw, N/m
  void tangent(ConstVectorRef w, VectorRef f, VectorRef k);
  /// k (N/m) and c (N) of f = -k w + c, with the secant stiffness at w
  void secant(ConstVectorRef w, VectorRef k, VectorRef c);
  /// Sum over the stops of U(w) = -int_0^w f dw, J
  double energy(ConstVectorRef w) const;
  /// U(w) of stop i alone, J
  double energy_of(Index i, double w) const;
  /// f(w) of stop i alone, N
  double force_of(Index i, double w);
  /// The law and the free play of stop i
  const model::ContactLaw& law_of(Index i) const { return *group_of(i).law; }
  const model::FreePlay& play_of(Index i) const { return group_of(i).play; }
  /// The penetration g of every stop on its nearer side, m; negative while open
  void penetration(ConstVectorRef w, VectorRef g) const;

  /// The free DOFs of stop i; FreeStops::kGround for a fixed end.
  Index dof_a(Index i) const { return a_[static_cast<std::size_t>(i)]; }
  Index dof_b(Index i) const { return b_[static_cast<std::size_t>(i)]; }
  /// The stiffness of each stop when closed, N/m.
  Vector closed_stiffness() const;

 private:
  struct Group {
    const model::ContactLaw* law;
    model::FreePlay play;
    Index begin, count;
  };

  void difference(ConstVectorRef x, VectorRef w) const;
  void scatter_both(ConstVectorRef f, VectorRef force) const;
  const Group& group_of(Index i) const;
  static double force_at(const Group& group, double w);
  void count_evaluation();
  /// Fills penetration_ and side_ (+1, -1 or 0) of all stops.
  void locate(ConstVectorRef w);

  linalg::Counters* counters_;
  std::vector<Group> groups_;
  std::vector<Index> a_, b_;
  Index system_size_;
  bool grounded_ = true;  ///< every stop acts on one free DOF a, against ground
  Vector penetration_, side_, secant_;
};

}  // namespace butee::dynamics
