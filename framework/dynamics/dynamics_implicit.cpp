// Operations of Dynamics for implicit methods, other than effective().
#include "butee/dynamics/dynamics_parts.hpp"

namespace butee::dynamics {

void Dynamics::secant_contact(ConstVectorRef x, VectorRef kappa, VectorRef c) {
  stops_->displacement(x, parts_->stop_displacement);
  stops_->secant(parts_->stop_displacement, kappa, c);
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
  parts_->internal.set_shifted(x, shift, 1.0 - s * velocity_factor, v, a);
  parts_->loads.add(t, 0.0, a);
  if (stop_count() > 0) {
    Vector& w = parts_->stop_displacement;
    stops_->displacement(x, w);
    if (s != 0.0) {
      stops_->displacement(v, parts_->stop_velocity);
      w -= s * displacement_factor * parts_->stop_velocity;
    }
    parts_->stop_force = c - kappa.cwiseProduct(w);
    stops_->scatter(parts_->stop_force, a);
  }
  parts_->internal.subtract_modal(v, a);
  effective().set_factors(velocity_factor, displacement_factor);
  if (!effective().solve(kappa, a)) return false;
  if (s != 0.0) a -= s * v;
  return true;
}

bool Dynamics::solve_single_secant(double t, double velocity_factor, double displacement_factor, ConstVectorRef kappa,
                                   ConstVectorRef c, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  set_time(t);
  a[0] = 0.0;
  parts_->loads.add(t, 0.0, a);
  const InternalForces& internal = parts_->internal;
  double stiffness = internal.single_stiffness(), force = a[0];
  for (Index i = 0; i < stop_count(); ++i) {
    stiffness += kappa[i];
    force += stops_->dof_a(i) >= 0 ? c[i] : -c[i];
  }
  ++counters_->factorizations;
  ++counters_->solves;
  const double matrix =
      internal.single_mass() + velocity_factor * internal.single_damping() + displacement_factor * stiffness;
  a[0] = (force - internal.single_damping() * v[0] - stiffness * x[0]) / matrix;
  return matrix > 0.0;
}

linalg::ForceBalance Dynamics::residual(ConstVectorRef load, ConstVectorRef stop_force, ConstVectorRef x,
                                        ConstVectorRef v, ConstVectorRef a, VectorRef r) {
  Vector& contact = parts_->contact_force;
  const bool has_stops = stop_count() > 0;
  if (size() == 1 && has_stops) {
    contact[0] = 0.0;
  } else if (has_stops) {
    in_blocks(size(), [&](Index begin, Index count) {
      if (parts_->has_stops[block_of(begin, size())]) contact.segment(begin, count).setZero();
    });
  }
  if (has_stops) stops_->scatter(stop_force, contact);
  return parts_->internal.balance({load.data(), parts_->has_loads},
                                  {has_stops ? contact.data() : nullptr, parts_->has_stops}, x, v, a, r);
}

}  // namespace butee::dynamics
