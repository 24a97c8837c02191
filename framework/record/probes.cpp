#include "butee/record/probes.hpp"

#include <algorithm>

namespace butee::record {

Probes::Probes(const std::vector<ProbeRequest>& requests, solve::Dynamics& dynamics) : dynamics_(dynamics) {
  const model::DofTable& table = dynamics.system().dofs;
  for (const ProbeRequest& request : requests)
    for (const Quantity quantity : request.quantities) {
      const Index dof = table.index({request.node, kind_of(quantity)});
      Column column{samples_of(quantity), slot(dof), stops_.size(), stops_.size()};
      if (quantity == Quantity::contact_force && dof >= 0) add_stops(dof);
      column.last_stop = stops_.size();
      needs_v_ = needs_v_ || quantity == Quantity::v || quantity == Quantity::theta_v;
      needs_a_ = needs_a_ || quantity == Quantity::a || quantity == Quantity::theta_a;
      columns_.push_back(request.label + "." + name_of(quantity));
      sources_.push_back(column);
    }
  x_.resize(dofs_.size());
  v_.resize(needs_v_ ? dofs_.size() : 0);
  a_.resize(needs_a_ ? dofs_.size() : 0);
}

const std::vector<double>* Probes::samples_of(Quantity quantity) const {
  switch (quantity) {
    case Quantity::u:
    case Quantity::theta:
      return &x_;
    case Quantity::v:
    case Quantity::theta_v:
      return &v_;
    case Quantity::a:
    case Quantity::theta_a:
      return &a_;
    case Quantity::contact_force:
    case Quantity::stop_state:  // not of probes
      break;
  }
  return nullptr;
}

std::size_t Probes::slot(Index dof) {
  if (dof < 0) return kFixed;
  const auto found = std::find(dofs_.begin(), dofs_.end(), dof);
  if (found == dofs_.end()) {
    dofs_.push_back(dof);
    return dofs_.size() - 1;
  }
  return static_cast<std::size_t>(found - dofs_.begin());
}

void Probes::add_stops(Index dof) {
  const solve::Contact& contact = dynamics_.contact();
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a != dof && b != dof) continue;
    stops_.push_back({i, slot(a), slot(b), a == dof ? 1.0 : -1.0});
  }
}

void Probes::evaluate(const time::AcceptedStep& step, double t, std::span<double> values) {
  if (t == step.to.t) return evaluate(step.to, values);
  step.integrator.interpolate(step.from, step.to, t, dofs_, {x_, v_, a_});
  evaluate_sampled(values);
}

void Probes::evaluate(const time::State& state, std::span<double> values) {
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    x_[i] = state.x[dofs_[i]];
    if (needs_v_) v_[i] = state.v[dofs_[i]];
    if (needs_a_) a_[i] = state.a[dofs_[i]];
  }
  evaluate_sampled(values);
}

double Probes::contact_force(const Column& column) {
  double force = 0.0;
  for (std::size_t i = column.first_stop; i < column.last_stop; ++i) {
    const ProbedStop& stop = stops_[i];
    const double a = stop.slot_a == kFixed ? 0.0 : x_[stop.slot_a], b = stop.slot_b == kFixed ? 0.0 : x_[stop.slot_b];
    force += stop.sign * dynamics_.contact().force_of(stop.stop, a - b);
  }
  return force;
}

void Probes::evaluate_sampled(std::span<double> values) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Column& column = sources_[i];
    if (column.samples == nullptr)
      values[i] = contact_force(column);
    else
      values[i] = column.slot == kFixed ? 0.0 : (*column.samples)[column.slot];
  }
}

}  // namespace butee::record
