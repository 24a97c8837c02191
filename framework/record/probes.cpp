#include "butee/record/probes.hpp"

#include <algorithm>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"

namespace butee::record {
namespace {

/// Number of values of a motion that are interpolated together for forces.
constexpr std::size_t kLargestSample = 1U << 14U;

void interpolate(const time::AcceptedStep& step, std::span<const double> times, std::span<const Index> dofs,
                 time::Interpolated out, Probes::View view) {
  if (view == Probes::View::output) return step.motion.interpolate(times, dofs, out);
  const auto part = [&](std::span<double> values, std::size_t i) {
    return values.empty() ? values : values.subspan(i * dofs.size(), dofs.size());
  };
  for (std::size_t i = 0; i < times.size(); ++i)
    step.motion.trace(times[i], dofs, {part(out.x, i), part(out.v, i), part(out.a, i)});
}

}  // namespace

Probes::Probes(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics)
    : dynamics_(dynamics), accelerations_(dynamics) {
  const model::DofTable& table = dynamics.system().dofs;
  for (const model::ProbeRequest& request : requests)
    for (const model::Quantity quantity : request.quantities) {
      columns_.push_back(request.label + "." + name_of(quantity));
      const Index dof = dof_of(quantity, request.node, dynamics);
      const bool is_on_support = dof < 0 && dynamics.system().model != nullptr;
      if (is_element_force(quantity) ||
          (is_contact_force(quantity) && (dynamics.obstacles() != nullptr || is_on_support))) {
        sources_.push_back(element_force(quantity, request));
        continue;
      }
      Column column{samples_of(quantity), slot(dof), stops_.size(), stops_.size()};
      if (is_contact_force(quantity) && dof >= 0) add_stops(dof);
      column.last_stop = stops_.size();
      if (dynamics.system().model != nullptr && source_of(quantity) == model::Source::motion)
        column.base = base_shares(*dynamics.system().model, table, {request.node, kind_of(quantity)},
                                  order_of(quantity), is_absolute(quantity));
      has_base_shares_ = has_base_shares_ || !column.base.empty();
      needs_v_ = needs_v_ || order_of(quantity) == 1;
      needs_a_ = needs_a_ || order_of(quantity) == 2;
      sources_.push_back(column);
    }
  if (element_forces_ == nullptr) return;
  force_dofs_ = element_forces_->dofs();
  all_x_ = all_v_ = Vector::Zero(dynamics.size());
}

Index Probes::dof_of(model::Quantity quantity, model::NodeId node, const dynamics::Dynamics& dynamics) {
  const model::Model* const owner = dynamics.system().model;
  const DofKind kind = owner != nullptr ? contact_kind(*owner, node, quantity) : kind_of(quantity);
  return dynamics.system().dofs.index({node, kind});
}

bool Probes::has_base_share(const model::Model* model, const model::DofTable& dofs, model::NodeId node,
                            model::Quantity quantity) {
  return model != nullptr && source_of(quantity) == model::Source::motion &&
         !base_shares(*model, dofs, {node, kind_of(quantity)}, order_of(quantity), is_absolute(quantity)).empty();
}

Probes::Column Probes::element_force(model::Quantity quantity, const model::ProbeRequest& request) {
  if (element_forces_ == nullptr) element_forces_ = std::make_unique<ElementForces>(dynamics_);
  element_forces_->add(quantity, request.node, request.element);
  return {&forces_, element_forces_->size() - 1, 0, 0, true};
}

const std::vector<double>* Probes::samples_of(model::Quantity quantity) const {
  if (source_of(quantity) == model::Source::stops) return nullptr;
  const std::array<const std::vector<double>*, 3> samples = {&x_, &v_, &a_};
  return samples.at(static_cast<std::size_t>(order_of(quantity)));
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
  const dynamics::ElasticStops& contact = dynamics_.stops();
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a != dof && b != dof) continue;
    stops_.push_back({i, slot(a), slot(b), a == dof ? 1.0 : -1.0});
  }
}

void Probes::make_room(std::size_t instants) {
  const std::size_t size = instants * dofs_.size();
  if (x_.size() < size) x_.resize(size);
  if (needs_v_ && v_.size() < size) v_.resize(size);
  if (needs_a_ && a_.size() < size) a_.resize(size);
  if (element_forces_ != nullptr) forces_.resize(std::max(forces_.size(), instants * element_forces_->size()));
}

void Probes::copy(const time::State& state, std::size_t instant) {
  const Vector& a = needs_a_ ? accelerations_.of(state) : state.a;
  for (std::size_t i = 0, place = instant * dofs_.size(); i < dofs_.size(); ++i, ++place) {
    x_[place] = state.x[dofs_[i]];
    if (needs_v_) v_[place] = state.v[dofs_[i]];
    if (needs_a_) a_[place] = a[dofs_[i]];
  }
}

void Probes::sample(const time::AcceptedStep& step, std::span<const double> times, View view) {
  if (times.empty()) return;
  make_room(times.size());
  if (has_base_shares_) times_.assign(times.begin(), times.end());
  std::size_t within = times.size();
  for (; within > 0 && times[within - 1] == step.to.t; --within) copy(step.to, within - 1);
  if (!dofs_.empty()) interpolate(step, times.first(within), dofs_, {x_, v_, a_}, view);
  if (element_forces_ != nullptr) sample_forces(step, times, view);
}

void Probes::sample_forces(const time::AcceptedStep& step, std::span<const double> times, View view) {
  const std::size_t n = force_dofs_.size(),
                    most = std::max<std::size_t>(1, kLargestSample / std::max<std::size_t>(n, 1));
  std::size_t within = times.size();
  for (; within > 0 && times[within - 1] == step.to.t; --within)
    evaluate_forces(step.to.t, step.to.x, step.to.v, within - 1);
  for (std::size_t first = 0, count = 0; first < within; first += count) {
    count = std::min(most, within - first);
    for (std::vector<double>* samples : {&force_x_, &force_v_}) samples->resize(std::max(samples->size(), n * count));
    if (n > 0)
      interpolate(step, times.subspan(first, count), force_dofs_,
                  {{force_x_.data(), n * count}, {force_v_.data(), n * count}, {}}, view);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < n; ++k) {
        all_x_[force_dofs_[k]] = force_x_[i * n + k];
        all_v_[force_dofs_[k]] = force_v_[i * n + k];
      }
      evaluate_forces(times[first + i], all_x_, all_v_, first + i);
    }
  }
}

void Probes::evaluate_forces(double t, ConstVectorRef x, ConstVectorRef v, std::size_t instant) {
  const std::size_t count = element_forces_->size();
  element_forces_->evaluate(t, x, v, std::span(forces_).subspan(instant * count, count));
}

void Probes::evaluate(const time::State& state, std::span<double> values) {
  make_room(1);
  if (has_base_shares_) times_.assign(1, state.t);
  copy(state, 0);
  if (element_forces_ != nullptr) evaluate_forces(state.t, state.x, state.v, 0);
  take(0, values);
}

double Probes::contact_force(const Column& column, const double* x) {
  double force = 0.0;
  for (std::size_t i = column.first_stop; i < column.last_stop; ++i) {
    const ProbedStop& stop = stops_[i];
    const double a = stop.slot_a == kFixed ? 0.0 : x[stop.slot_a], b = stop.slot_b == kFixed ? 0.0 : x[stop.slot_b];
    force += stop.sign * dynamics_.stops().force_of(stop.stop, a - b);
  }
  return force;
}

void Probes::take(std::size_t instant, std::span<double> values) {
  const std::size_t begin = instant * dofs_.size();
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Column& column = sources_[i];
    if (column.is_element_force)
      values[i] = forces_[instant * element_forces_->size() + column.slot];
    else if (column.samples == nullptr)
      values[i] = contact_force(column, x_.data() + begin);
    else
      values[i] = column.slot == kFixed ? 0.0 : (*column.samples)[begin + column.slot];
    for (const model::BaseShare& share : column.base) values[i] += share.factor * share.motion->value(times_[instant]);
  }
}

}  // namespace butee::record
