#include "butee/dynamics/static_position.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/free_motion.hpp"
#include "butee/dynamics/structure.hpp"
#include "butee/linalg/linear_solver.hpp"

namespace butee::dynamics {
namespace {

constexpr int kMostIterations = 200, kMostHalvings = 40, kMostDoublings = 40;
constexpr double kConverged = 1e-12;
/// The weakest support of bodies that nothing holds, as a part of the stiffness of contacts.
constexpr double kWeakest = 1e-6;
/// A point along a step is accepted if the forces do at most this part of their work at its start.
constexpr double kSufficient = 0.5;
/// Rounding of the residual, as a part of the sum of the sizes of its terms: of loads and contacts, and of elastic
/// forces, which are summed in extended precision.
constexpr double kRounding = 1e-14, kRoundingOfElastic = 100.0 * std::numeric_limits<long double>::epsilon();
/// A motion d is held by rounding if d^T K d is below this part of |d|^T |K| |d|: K may have as much rounding. If the
/// elements are known, it must be below this multiple of their rounding.
constexpr double kOfElements = 4.0;
constexpr double kHeldByRounding = 4.0 * std::numeric_limits<double>::epsilon();

/// K + S^T diag(k) S
SparseMatrix with_stops(const Dynamics& dynamics, const ElasticStops& contact, const Vector& stiffness) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Index i, Index j, double value) {
    if (i >= 0 && j >= 0) entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
  };
  for (Index i = 0; i < stiffness.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    add(a, a, stiffness[i]);
    add(b, b, stiffness[i]);
    add(a, b, -stiffness[i]);
    add(b, a, -stiffness[i]);
  }
  SparseMatrix stops(dynamics.size(), dynamics.size());
  stops.setFromTriplets(entries.begin(), entries.end());
  SparseMatrix sum = dynamics.system().stiffness + stops;
  sum.makeCompressed();
  return sum;
}

using ExtendedVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// A x in extended precision.
ExtendedVector product(const SparseMatrix& matrix, const ExtendedVector& x) {
  ExtendedVector y = ExtendedVector::Zero(matrix.rows());
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      y[entry.row()] += static_cast<long double>(entry.value()) * x[column];
  return y;
}

class Equilibrium {
 public:
  Equilibrium(Dynamics& dynamics, double t)
      : dynamics_(dynamics),
        load_(dynamics.size()),
        elastic_(load_),
        rest_(Vector::Zero(dynamics.size())),
        t_(t),
        w_(dynamics.stop_count()),
        structure_(Structure::of(dynamics.system(), dynamics.system().stiffness)) {
    if (dynamics.obstacles() != nullptr) dynamics.obstacles()->follow_live_without_friction();
    dynamics.external_force(t, load_);
    const model::System& system = dynamics.system();
    if (system.model == nullptr || system.model->bases.empty()) return;
    // At rest relative to the base: in space all DOFs move with it.
    rest_ = motion_with_base(*system.model, system.dofs, 1, t);
    dynamics.damping_force(rest_, elastic_);
    load_ -= elastic_;
    dynamics.inertia_force(motion_with_base(*system.model, system.dofs, 2, t), elastic_);
    load_ -= elastic_;
  }

  ~Equilibrium() {
    if (dynamics_.obstacles() != nullptr) dynamics_.obstacles()->follow_live();
  }
  Equilibrium(const Equilibrium&) = delete;
  Equilibrium& operator=(const Equilibrium&) = delete;

  /// r := F + F_c(x) - K x; returns |r| over |F| + |F_c| + |K x|, or 0 without any force. The terms of K x cancel to
  /// n^-4 of their size in a beam of n elements.
  double residual(const ExtendedVector& x, Vector& r) {
    const Vector rounded = x.cast<double>();
    r.setZero();
    dynamics_.add_contact_force(rounded, r);
    dynamics_.add_obstacle_force(t_, rounded, rest_, r);
    const model::System& system = dynamics_.system();
    ExtendedVector elastic = structure_ ? ExtendedVector(structure_->stiffness() * x) : product(system.stiffness, x);
    // As Turning::add_elastic_force(). At a constant speed these terms are in K.
    if (system.rotation != nullptr && system.circulatory.size() > 0)
      elastic += static_cast<long double>(system.rotation->speed(t_)) * product(system.circulatory, x);
    if (system.rotation != nullptr && system.gyroscopic.size() > 0)
      elastic += static_cast<long double>(system.rotation->acceleration(t_)) * product(system.gyroscopic, x);
    elastic_ = elastic.cast<double>();
    const double scale = load_.norm() + r.norm() + elastic_.norm();
    r += load_ - elastic_;
    return scale > 0.0 ? r.norm() / scale : 0.0;
  }

  /// The tangent stiffness with the stop phases at x.
  SparseMatrix tangent(const Vector& x) {
    Vector force(w_.size()), stiffness(w_.size());
    if (w_.size() > 0) {
      dynamics_.stops().displacement(x, w_);
      dynamics_.stops().tangent(w_, force, stiffness);
    }
    SparseMatrix sum = with_stops(dynamics_, dynamics_.stops(), stiffness.cwiseMax(0.0));
    Obstacles* obstacles = dynamics_.obstacles();
    if (obstacles == nullptr) return sum;
    std::vector<Eigen::Triplet<double>> entries;
    for (const Obstacles::Tangent& tangent : obstacles->tangents(t_, x, rest_))
      obstacles->visit(tangent.contact, tangent.stiffness, [&](Index i, Index j, double value) {
        entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
      });
    SparseMatrix pressed(sum.rows(), sum.cols());
    pressed.setFromTriplets(entries.begin(), entries.end());
    sum += pressed;
    sum.makeCompressed();
    return sum;
  }

  /// A diagonal stiffness, `part` of those of the contacts.
  SparseMatrix support(double part) const {
    double stiffest = 0.0;
    if (dynamics_.stop_count() > 0) stiffest = dynamics_.stops().closed_stiffness().maxCoeff();
    if (const Obstacles* obstacles = dynamics_.obstacles())
      for (Index i = 0; i < obstacles->size(); ++i) stiffest = std::max(stiffest, obstacles->closed_stiffness(i));
    const Vector mass = dynamics_.system().mass.diagonal();
    SparseMatrix support(mass.size(), mass.size());
    support.setIdentity();
    support.diagonal() = part * stiffest / mass.maxCoeff() * mass;
    return support;
  }

  /// Whether rounding alone may hold the motion d. False for none.
  bool is_held_by_rounding(const SparseMatrix& tangent, const Vector& d) const {
    const ExtendedVector way = d.cast<long double>();
    if (structure_) {
      const Structure::Elastic elastic = structure_->elastic(d, true);
      const SparseMatrix contacts = tangent - dynamics_.system().stiffness;
      const Vector large = contacts.cwiseAbs() * d.cwiseAbs();
      const double work = static_cast<double>(way.dot(elastic.forces.col(0))) + d.dot(contacts * d),
                   of_contacts = std::numeric_limits<double>::epsilon() * d.cwiseAbs().dot(large);
      return !d.isZero(0.0) && std::abs(work) <= kOfElements * (elastic.rounding[0] + of_contacts);
    }
    return may_be_held_by_rounding(tangent, d);
  }
  /// The same by the entries of the tangent, which have more rounding than the elements.
  static bool may_be_held_by_rounding(const SparseMatrix& tangent, const Vector& d) {
    const ExtendedVector way = d.cast<long double>();
    const double work = static_cast<double>(way.dot(product(tangent, way)));
    const double size = d.cwiseAbs().dot(tangent.cwiseAbs() * d.cwiseAbs());
    return size > 0.0 && std::abs(work) <= kHeldByRounding * size;
  }

  /// The rounding of the residual, N.
  double rounding(const SparseMatrix& tangent, const Vector& x) const {
    const SparseMatrix contacts = tangent - dynamics_.system().stiffness;
    return (kRoundingOfElastic * (tangent.cwiseAbs() * x.cwiseAbs()) +
            kRounding * (contacts.cwiseAbs() * x.cwiseAbs() + load_.cwiseAbs()))
        .norm();
  }

 private:
  Dynamics& dynamics_;
  Vector load_, elastic_;
  Vector rest_;  ///< velocity of the DOFs at rest, m/s
  double t_;
  Vector w_;
  std::optional<Structure> structure_;  ///< the elements, whose sum has more digits than K
};

InputError not_found(double residual) {
  return InputError("gravity.static: the static position was not found: Newton's iteration stopped at a residual of " +
                    to_short_text(residual) + " of the forces; give a start near it by [initial] displacement");
}

InputError not_held(const SparseMatrix& tangent, const model::System& system) {
  return InputError(
      "gravity.static: the scene has no static position: nothing holds " +
      describe_softest_motion(tangent, system.dofs) +
      ", a preload buckles it, or its mesh is so fine that rounding hides what holds it; add a support or "
      "a spring there, give a start near it by [initial] displacement, take fewer elements, or start "
      "without static = true");
}

}  // namespace

Vector static_position(Dynamics& dynamics, double t, const Vector& start) {
  Equilibrium equilibrium(dynamics, t);
  const model::System& system = dynamics.system();
  ExtendedVector x = start.cast<long double>();
  Vector r(x.size()), next_r(x.size());
  double size = equilibrium.residual(x, r);
  for (int i = 0; i < kMostIterations && size > kConverged; ++i) {
    const SparseMatrix tangent = equilibrium.tangent(x.cast<double>());
    linalg::LinearSolver solver(tangent, dynamics.counters(), nullptr,
                                system.stiffness_is_symmetric && dynamics.obstacles() == nullptr);
    Vector step = r;
    bool solved = solver.factorize(tangent);
    if (solved) solver.solve(step);
    // Bodies that nothing holds yet, or that buckle: a weak support gives a long step along their loads, and the search
    // along it ends where a contact holds them. If the stiffness along the step is rounding, nothing holds it either.
    const bool falls = !solved || !step.allFinite() || equilibrium.is_held_by_rounding(tangent, step);
    solved = !falls;
    for (double part = kWeakest; !solved && part <= 1.0; part *= 10.0) {
      const SparseMatrix held = tangent + equilibrium.support(part);
      step = r;
      solved = solver.factorize(held);
      if (solved) solver.solve(step);
      solved = solved && step.allFinite();
    }
    if (!solved) throw not_held(tangent, system);
    // Along the step the forces do work r.step; where it vanishes, a convex energy is at its lowest.
    const double work = r.dot(step);
    double low = 0.0, high = 1.0, next = size;
    ExtendedVector moved = x;
    const auto work_at = [&](double part) {
      moved = x + (part * step).cast<long double>();
      next = equilibrium.residual(moved, next_r);
      return next_r.dot(step);
    };
    // Where nothing loads what is not held, the step is as good as Newton's.
    if (falls && work_at(high) * work > 0.0 && !(next < kSufficient * size)) {
      for (int k = 0; k < kMostDoublings && work_at(high) * work > 0.0; ++k) {
        low = high;
        high *= 2.0;
      }
      if (work_at(high) * work > 0.0) throw not_held(tangent, system);
    }
    bool is_better = false;
    double part = high;
    for (int k = 0; k < kMostHalvings && !is_better; ++k, part = 0.5 * (low + high)) {
      const double rest = work_at(part);
      is_better = next < size || std::abs(rest) <= kSufficient * std::abs(work);
      (rest * work > 0.0 ? low : high) = part;
    }
    if (!(next < size) && r.norm() <= equilibrium.rounding(tangent, x.cast<double>())) break;
    if (!is_better)
      throw falls || Equilibrium::may_be_held_by_rounding(tangent, step) ? not_held(tangent, system) : not_found(size);
    x = moved;
    r.swap(next_r);
    size = next;
  }
  const Vector found = x.cast<double>();
  const SparseMatrix tangent = equilibrium.tangent(found);
  // Structures that nothing holds come to rest where rounding balances the forces, very far away.
  if (equilibrium.is_held_by_rounding(tangent, found - start)) throw not_held(tangent, system);
  if (size > kConverged && r.norm() > equilibrium.rounding(tangent, found))
    throw Equilibrium::may_be_held_by_rounding(tangent, found - start) ? not_held(tangent, system) : not_found(size);
  return found;
}

}  // namespace butee::dynamics
