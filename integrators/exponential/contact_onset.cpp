#include "integrators/exponential/contact_onset.hpp"

#include <cmath>

#include "butee/core/quadrature.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {
namespace {

/// A contact begins with a step if its penetration there is below this part of the way that its rate covers in the
/// step: at that distance from the onset the error for the power 3/2 is a thirtieth.
constexpr double kBeside = 0.1;

/// The weights of the forces at the nodes in their mean over the step.
const StepNodes::Row& weights() {
  static const StepNodes::Row all = [] {
    StepNodes::Row row = StepNodes::Row::Zero();
    for (Index r = 0; r < StepNodes::kCount; ++r)
      row += StepNodes::with_middle().col(r).transpose() / static_cast<double>(r + 1);
    return row;
  }();
  return all;
}

bool is_smooth_in_contact(const model::ContactLaw& law) {
  return law.is_piecewise_linear() || !law.is_silent_while_open();
}

}  // namespace

ContactOnset::ContactOnset(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {
  for (Index i = 0; i < dynamics.stops().size(); ++i)
    if (!is_smooth_in_contact(dynamics.stops().law_of(i))) stops_.push_back(i);
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i)
      if (const auto& law = obstacles->group_of(i).law; law != nullptr && !is_smooth_in_contact(*law))
        obstacles_.push_back(i);
  if (!any()) return;
  x_ = force_ = sum_ = Vector::Zero(dynamics.size());
}

template <class Force>
void ContactOnset::add(const End& end, const std::vector<Index>& dofs, const Force& force, Vector& errors) {
  const auto take = [&](double s, double weight) {
    for (const Index dof : dofs) {
      x_[dof] = end.x[dof] + s * end.h * end.v[dof];
      force_[dof] = 0.0;
    }
    force(end.t + s * end.h);
    for (const Index dof : dofs) sum_[dof] += weight * force_[dof];
  };
  for (const Index dof : dofs) sum_[dof] = 0.0;
  for (Index j = 0; j < StepNodes::kCount; ++j) take(StepNodes::kPlaces[static_cast<std::size_t>(j)], weights()[j]);
  for (const auto& [begin, middle] : {std::pair{0.0, 0.5}, std::pair{0.5, 1.0}})
    for (const auto& [u, weight] : gauss_points(begin, middle)) take(u * u * u * u, -4.0 * u * u * u * weight);
  for (const Index dof : dofs) errors[dof] += std::abs(sum_[dof]);
}

void ContactOnset::add_errors(const End& end, Vector& errors) {
  const double sense = end.h > 0.0 ? 1.0 : -1.0, h = std::abs(end.h);
  const auto begins = [&](double penetration, double rate) {
    return sense * rate > 0.0 && std::abs(penetration) <= kBeside * sense * rate * h;
  };
  dynamics::ElasticStops& stops = dynamics_.stops();
  for (const Index i : stops_) {
    dofs_.clear();
    double w = 0.0, speed = 0.0;
    for (const auto& [dof, sign] : {std::pair{stops.dof_a(i), 1.0}, std::pair{stops.dof_b(i), -1.0}})
      if (dof >= 0) {
        dofs_.push_back(dof);
        w += sign * end.x[dof];
        speed += sign * end.v[dof];
      }
    if (!begins(w - stops.play_of(i).upper(), speed) && !begins(stops.play_of(i).lower() - w, -speed)) continue;
    const auto force = [&](double) {
      const Index a = stops.dof_a(i), b = stops.dof_b(i);
      const double value = stops.force_of(i, (a >= 0 ? x_[a] : 0.0) - (b >= 0 ? x_[b] : 0.0));
      if (a >= 0) force_[a] += value;
      if (b >= 0) force_[b] -= value;
    };
    add(end, dofs_, force, errors);
  }
  const dynamics::Obstacles* const obstacles = dynamics_.obstacles();
  for (const Index i : obstacles_) {
    if (!obstacles->phase(i).touches()) continue;
    const dynamics::ContactForces now = obstacles->forces(i, end.t, end.x, end.v);
    if (!begins(now.penetration, now.rate)) continue;
    dofs_.clear();
    for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
      for (const Index dof : side)
        if (dof >= 0) dofs_.push_back(dof);
    const auto force = [&](double t) { obstacles->scatter(i, obstacles->forces(i, t, x_, end.v).along_all(), force_); };
    add(end, dofs_, force, errors);
  }
}

}  // namespace butee::integrators
