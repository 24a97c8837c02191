#include "butee/record/field_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"

namespace butee::record {
namespace {

using Clock = std::chrono::steady_clock;

double at(std::span<const double> samples, std::int32_t place) {
  return place < 0 ? 0.0 : samples[static_cast<std::size_t>(place)];
}

/// True if the nodes have contacts other than elastic stops on u.
bool is_general(const std::vector<model::NodeId>& nodes, dynamics::Dynamics& dynamics) {
  if (dynamics.obstacles() != nullptr) return true;
  const model::Model* const model = dynamics.system().model;
  return model != nullptr && std::any_of(nodes.begin(), nodes.end(), [model](model::NodeId node) {
           return contact_kind(*model, node, model::Quantity::contact_force) != DofKind::u;
         });
}

}  // namespace

FieldRecorder::FieldRecorder(const model::OutputRequest& output, double end_time, dynamics::Dynamics& dynamics,
                             std::vector<std::unique_ptr<model::FieldWriter>> writers)
    : dynamics_(dynamics),
      accelerations_(dynamics),
      times_(output.fields.interval ? output.fields.interval : output.interval, output.every, end_time),
      quantities_(output.fields.quantities),
      writers_(std::move(writers)) {
  const auto wants = [this](std::initializer_list<model::Quantity> any) {
    return std::find_first_of(quantities_.begin(), quantities_.end(), any.begin(), any.end()) != quantities_.end();
  };
  const auto needs = [this](int order) {
    return std::any_of(quantities_.begin(), quantities_.end(), [&](model::Quantity quantity) {
      return source_of(quantity) == model::Source::motion && order_of(quantity) == order;
    });
  };
  needs_v_ = needs(1);
  needs_a_ = needs(2);
  needs_stops_ = (dynamics.stop_count() > 0 || dynamics.obstacles() != nullptr) &&
                 wants({model::Quantity::contact_force, model::Quantity::stop_state});
  find_dofs(output.fields.nodes);
  if (needs_stops_ && is_general(output.fields.nodes, dynamics))
    find_contacts(output.fields.nodes);
  else if (needs_stops_)
    find_stops();
  x_.resize(dofs_.size());
  if (needs_v_) v_.resize(dofs_.size());
  if (needs_a_) a_.resize(dofs_.size());
  record_.resize(quantities_.size() * output.fields.nodes.size());
  if (dynamics.system().model != nullptr) find_base_terms(output.fields.nodes);
}

void FieldRecorder::find_dofs(const std::vector<model::NodeId>& nodes) {
  const model::DofTable& table = dynamics_.system().dofs;
  std::vector<std::int32_t> places(static_cast<std::size_t>(dynamics_.size()), -1);
  const auto place = [&](model::NodeId node, DofKind kind) {
    const Index dof = table.index({node, kind});
    if (dof < 0) return -1;
    std::int32_t& known = places[static_cast<std::size_t>(dof)];
    if (known < 0) {
      known = static_cast<std::int32_t>(dofs_.size());
      dofs_.push_back(dof);
    }
    return known;
  };
  // Forces of stops are those on u.
  std::array<bool, kDofKinds> is_needed{};
  is_needed[static_cast<std::size_t>(DofKind::u)] = true;
  for (const model::Quantity quantity : quantities_) is_needed[static_cast<std::size_t>(kind_of(quantity))] = true;
  for (const DofKind kind : {DofKind::uy, DofKind::rz, DofKind::ux, DofKind::uz, DofKind::rx, DofKind::ry})
    if (is_needed[static_cast<std::size_t>(kind)])
      for (const model::NodeId node : nodes) places_[static_cast<std::size_t>(kind)].push_back(place(node, kind));
}

void FieldRecorder::find_base_terms(const std::vector<model::NodeId>& nodes) {
  const model::System& system = dynamics_.system();
  if (system.model->bases.empty()) return;
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    if (source_of(quantities_[q]) != model::Source::motion) continue;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const model::BaseShare& share : base_shares(*system.model, system.dofs, {nodes[i], kind_of(quantities_[q])},
                                                       order_of(quantities_[q]), false))
        base_.push_back({q * nodes.size() + i, share});
  }
}

void FieldRecorder::find_stops() {
  const std::size_t kept = dofs_.size();
  std::vector<std::int32_t> places(static_cast<std::size_t>(dynamics_.size()), -1);
  for (std::size_t i = 0; i < kept; ++i) places[static_cast<std::size_t>(dofs_[i])] = static_cast<std::int32_t>(i);
  const auto place = [&](Index dof) { return dof < 0 ? -1 : places[static_cast<std::size_t>(dof)]; };
  const dynamics::ElasticStops& contact = dynamics_.stops();
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (place(a) < 0 && place(b) < 0) continue;
    // The other end is sampled even if it is not a recorded node.
    for (const Index dof : {a, b})
      if (dof >= 0 && place(dof) < 0) {
        places[static_cast<std::size_t>(dof)] = static_cast<std::int32_t>(dofs_.size());
        dofs_.push_back(dof);
      }
    stops_.push_back({i, place(a), place(b)});
  }
  force_.resize(dofs_.size());
  state_.resize(dofs_.size());
}

void FieldRecorder::evaluate_stops(std::span<const double> x) {
  std::fill(force_.begin(), force_.end(), 0.0);
  std::fill(state_.begin(), state_.end(), 0.0);
  for (const KeptStop& stop : stops_) {
    const double w = at(x, stop.a) - at(x, stop.b);
    const double force = dynamics_.stops().force_of(stop.stop, w);
    const double side = dynamics_.stops().play_of(stop.stop).closed_side(w);
    for (const auto& [place, sign] : {std::pair(stop.a, 1.0), std::pair(stop.b, -1.0)}) {
      if (place < 0) continue;
      force_[static_cast<std::size_t>(place)] += sign * force;
      if (side != 0.0) state_[static_cast<std::size_t>(place)] = sign * side;
    }
  }
}

void FieldRecorder::find_contacts(const std::vector<model::NodeId>& nodes) {
  const model::System& system = dynamics_.system();
  std::vector<bool> is_sampled(static_cast<std::size_t>(dynamics_.size()), false);
  for (const Index dof : dofs_) is_sampled[static_cast<std::size_t>(dof)] = true;
  const auto sample = [&](Index dof) {
    if (dof < 0 || is_sampled[static_cast<std::size_t>(dof)]) return;
    is_sampled[static_cast<std::size_t>(dof)] = true;
    dofs_.push_back(dof);
  };
  for (const model::NodeId node : nodes) {
    contacts_.push_back(contacts_on(*system.model, system.dofs,
                                    {node, contact_kind(*system.model, node, model::Quantity::contact_force)}));
    for (const ContactsOn::Stop& one : contacts_.back().stops)
      for (const Index dof : {dynamics_.stops().dof_a(one.stop), dynamics_.stops().dof_b(one.stop)}) sample(dof);
    for (const ContactsOn::Obstacle& one : contacts_.back().obstacles)
      for (const auto& side :
           {dynamics_.obstacles()->ends_of(one.contact).a, dynamics_.obstacles()->ends_of(one.contact).b})
        for (const Index dof : side) sample(dof);
  }
  // The forces of rigid sticks follow from the motion of the whole structure.
  if (dynamics_.obstacles() != nullptr && dynamics_.obstacles()->has_rigid_friction())
    for (Index dof = 0; dof < dynamics_.size(); ++dof) sample(dof);
  needs_v_ = true;
  all_x_ = all_v_ = Vector::Zero(dynamics_.size());
  force_.resize(nodes.size());
  state_.resize(nodes.size());
}

void FieldRecorder::evaluate_contacts(double t, const time::Interpolated& samples) {
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    all_x_[dofs_[k]] = samples.x[k];
    all_v_[dofs_[k]] = samples.v[k];
  }
  if (dynamics_.obstacles() != nullptr) dynamics_.contact_forces(t, all_x_, all_v_, forces_);
  dynamics::ElasticStops& stops = dynamics_.stops();
  const auto of = [this](Index dof) { return dof < 0 ? 0.0 : all_x_[dof]; };
  for (std::size_t node = 0; node < contacts_.size(); ++node) {
    double force = 0.0, state = 0.0;
    for (const auto& [stop, sign] : contacts_[node].stops) {
      const double w = of(stops.dof_a(stop)) - of(stops.dof_b(stop));
      force += sign * stops.force_of(stop, w);
      if (const double side = stops.play_of(stop).closed_side(w); side != 0.0) state = sign * side;
    }
    for (const ContactsOn::Obstacle& one : contacts_[node].obstacles) {
      const dynamics::ContactForces& now = forces_[static_cast<std::size_t>(one.contact)];
      force += one.of(now);
      if (!(now.penetration > 0.0) || one.place == ContactsOn::Obstacle::kMoment) continue;
      const dynamics::Obstacles::Motion motion = dynamics_.obstacles()->motion(one.contact, all_x_, all_v_);
      state = std::copysign(1.0, one.factor * motion.d[static_cast<Index>(one.place)]);
    }
    force_[node] = force;
    state_[node] = state;
  }
}

void FieldRecorder::fill(double t, const time::Interpolated& samples) {
  if (!contacts_.empty())
    evaluate_contacts(t, samples);
  else if (needs_stops_)
    evaluate_stops(samples.x);
  auto out = record_.begin();
  const std::array<std::span<const double>, 3> motion = {samples.x, samples.v, samples.a};
  for (const model::Quantity quantity : quantities_) {
    const auto& places = places_[static_cast<std::size_t>(kind_of(quantity))];
    const bool is_motion = source_of(quantity) == model::Source::motion;
    const std::span<const double> from =
        is_motion ? motion[static_cast<std::size_t>(order_of(quantity))]
                  : std::span<const double>(quantity == model::Quantity::contact_force ? force_ : state_);
    if (from.empty())
      out = std::fill_n(out, places.size(), 0.0);
    else if (!is_motion && !contacts_.empty())
      out = std::copy(from.begin(), from.end(), out);
    else
      out = std::transform(places.begin(), places.end(), out, [&](std::int32_t place) { return at(from, place); });
  }
  for (const BaseTerm& term : base_) record_[term.place] += term.share.factor * term.share.motion->value(t);
}

void FieldRecorder::fill(const time::State& state) {
  const Vector& a = needs_a_ ? accelerations_.of(state) : state.a;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    x_[i] = state.x[dofs_[i]];
    if (needs_v_) v_[i] = state.v[dofs_[i]];
    if (needs_a_) a_[i] = a[dofs_[i]];
  }
  fill(state.t, time::Interpolated{x_, v_, a_});
}

void FieldRecorder::start(const time::State& state) {
  start_time_ = state.t;
  fill(state);
}

void FieldRecorder::step(const time::AcceptedStep& step) {
  times_.visit(step, [&](double t) {
    if (t == step.to.t)
      fill(step.to);
    else if (t != step.from.t) {
      step.motion.interpolate(t, dofs_, {x_, v_, a_});
      fill(t, time::Interpolated{x_, v_, a_});
    }  // else the first instant, filled by start()
    write(t);
  });
}

void FieldRecorder::write(double t) {
  const auto begin = Clock::now();
  for (const auto& writer : writers_) writer->append(t, record_);
  seconds_ += std::chrono::duration<double>(Clock::now() - begin).count();
}

void FieldRecorder::restore(ByteReader&) {
  throw RunError("a run that writes fields cannot resume from a checkpoint");
}

void FieldRecorder::finish() {
  if (finished_) return;
  finished_ = true;
  if (!times_.begun()) write(start_time_);
  for (const auto& writer : writers_) writer->finish();
}

}  // namespace butee::record
