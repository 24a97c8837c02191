// Operations of Dynamics for implicit methods, other than effective().
#include "butee/core/blocks.hpp"
#include "butee/dynamics/dynamics.hpp"

namespace butee::dynamics {

void Dynamics::secant_contact(ConstVectorRef x, VectorRef kappa, VectorRef c) {
  stops_.displacement(x, stop_displacement_);
  stops_.secant(stop_displacement_, kappa, c);
}

bool Dynamics::solve_secant(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                            ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  return size() == 1 ? solve_single_secant(t, velocity_factor, displacement_factor, kappa, c, x, v, a)
                     : solve_secant_of_many(t, velocity_factor, displacement_factor, kappa, c, x, v, a);
}

bool Dynamics::solve_secant_of_many(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                                    ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  // Solving for a + s v instead of a avoids the product M v: the term C v then becomes a shift of x
  // in K x.
  set_time(t);
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  const double s = on_mass / (1.0 + velocity_factor * on_mass),
               shift = on_stiffness - s * (displacement_factor + velocity_factor * on_stiffness);
  subtract_products(From::nothing, shifted(x, shift, v), 1.0 - s * velocity_factor, v, a);
  add_external_force(t, a);
  if (stop_count() > 0) {
    stops_.displacement(x, stop_displacement_);
    if (s != 0.0) {
      stops_.displacement(v, stop_velocity_);
      stop_displacement_ -= s * displacement_factor * stop_velocity_;
    }
    stop_force_ = c - kappa.cwiseProduct(stop_displacement_);
    stops_.scatter(stop_force_, a);
  }
  if (modal_) {
    modal_force_.setZero();
    modal_->add_force(v, modal_force_);
    a -= modal_force_;
  }
  effective().set_factors(velocity_factor, displacement_factor);
  if (!effective().solve(kappa, a)) return false;
  if (s != 0.0) a -= s * v;
  return true;
}

bool Dynamics::solve_single_secant(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                                   ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  a[0] = 0.0;
  add_external_force(t, a);
  double stiffness = stiffness_product_.first(), force = a[0];
  for (Index i = 0; i < stop_count(); ++i) {
    stiffness += kappa[i];
    force += stops_.dof_a(i) >= 0 ? c[i] : -c[i];
  }
  ++counters_.factorizations;
  ++counters_.solves;
  const double matrix = mass_product_.first() + velocity_factor * single_damping_ + displacement_factor * stiffness;
  a[0] = (force - single_damping_ * v[0] - stiffness * x[0]) / matrix;
  return matrix > 0.0;
}

linalg::ForceBalance Dynamics::residual(ConstVectorRef load, ConstVectorRef stop_force, ConstVectorRef x,
                                        ConstVectorRef v, ConstVectorRef a, VectorRef r) {
  const bool has_stops = stop_count() > 0;
  if (size() == 1 && has_stops) {
    contact_force_[0] = 0.0;
  } else if (has_stops) {
    in_blocks(size(), [&](Index begin, Index count) {
      if (has_stops_[block_of(begin, size())]) contact_force_.segment(begin, count).setZero();
    });
  }
  if (has_stops) stops_.scatter(stop_force, contact_force_);
  linalg::ForceBalance balance;
  if (size() == 1) {
    const double inertia = mass_product_.first() * a[0], damping = single_damping_ * v[0],
                 elastic = stiffness_product_.first() * x[0];
    balance.add({load.data(), has_stops ? contact_force_.data() : nullptr, &inertia, has_damping_ ? &damping : nullptr,
                 &elastic},
                1, r.data());
    return balance;
  }
  if (modal_) damping_force(v, modal_force_);
  if (turning_) {
    // The turning part is a product over all rows, so the forces are summed at once, not block by
    // block.
    damping_force(v, turning_damping_);
    elastic_force(x, other_vector_);
    inertia_force(a, turning_inertia_);
    balance.add({load.data(), has_stops ? contact_force_.data() : nullptr, turning_inertia_.data(),
                 turning_damping_.data(), other_vector_.data()},
                size(), r.data());
    return balance;
  }
  in_blocks(size(), [&](Index begin, Index count) {
    linalg::ForceTerms terms{nullptr, nullptr, inertia_.data(), nullptr, work_.data()};
    mass_product_.multiply(a.data(), begin, count, inertia_.data());
    stiffness_product_.multiply(x.data(), begin, count, work_.data());
    if (has_loads_[block_of(begin, size())]) terms.load = load.data() + begin;
    if (has_stops && has_stops_[block_of(begin, size())]) terms.contact = contact_force_.data() + begin;
    if (modal_) {
      terms.damping = modal_force_.data() + begin;
    } else if (has_damping_) {
      damping_rows(v, begin, count, damping_.data());
      terms.damping = damping_.data();
    }
    balance.add(terms, count, r.data() + begin);
  });
  return balance;
}

}  // namespace butee::dynamics
