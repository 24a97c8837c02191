#include "butee/record/energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace butee::record {

Energy energy_of(const time::State& state, solve::Dynamics& dynamics) {
  Vector force(dynamics.size());
  Energy energy;
  dynamics.inertia_force(state.v, force);
  energy.kinetic = 0.5 * state.v.dot(force);
  dynamics.elastic_force(state.x, force);
  energy.strain = 0.5 * state.x.dot(force);
  if (dynamics.stop_count() > 0) {
    Vector w(dynamics.stop_count());
    dynamics.contact().displacement(state.x, w);
    energy.contact = dynamics.contact().energy(w);
  }
  return energy;
}

EnergyRecorder::EnergyRecorder(solve::Dynamics& dynamics, CsvWriter* writer, std::optional<OutputTimes> times)
    : dynamics_(dynamics),
      all_(static_cast<std::size_t>(dynamics.size())),
      middle_(dynamics.size()),
      force_(middle_),
      writer_(writer),
      times_(std::move(times)) {
  std::iota(all_.begin(), all_.end(), Index{0});
}

EnergyRecorder::Power EnergyRecorder::power(double t, const Vector& v) {
  Power power{};
  dynamics_.external_force(t, force_);
  power.of_loads = v.dot(force_);
  if (dynamics_.has_damping()) {
    dynamics_.damping_force(v, force_);
    power.of_damping = v.dot(force_);
  }
  return power;
}

void EnergyRecorder::start(const time::State& state) {
  now_ = energy_of(state, dynamics_);
  first_total_ = largest_ = now_.total();
  work_ = dissipated_ = 0.0;
  last_ = power(state.t, state.v);
}

void EnergyRecorder::step(const time::AcceptedStep& step) {
  bool due = false;
  if (writer_ != nullptr && times_) {
    times_->visit(step, [&](double t) {
      if (t == step.from.t)
        write_row(t);
      else
        due = true;
    });
  }
  const double half = 0.5 * (step.from.t + step.to.t);
  step.integrator.interpolate(step.from, step.to, half, all_,
                              {{}, {middle_.data(), static_cast<std::size_t>(middle_.size())}, {}});
  const Power middle = power(half, middle_);
  const Power end = power(step.to.t, step.to.v);
  work_ += step.h / 6.0 * (last_.of_loads + 4.0 * middle.of_loads + end.of_loads);
  dissipated_ += step.h / 6.0 * (last_.of_damping + 4.0 * middle.of_damping + end.of_damping);
  last_ = end;
  now_ = energy_of(step.to, dynamics_);
  largest_ = std::max(largest_, std::abs(now_.total()));
  if (due) write_row(step.to.t);
}

std::vector<std::string> EnergyRecorder::columns() {
  return {"t", "kinetic", "strain", "contact", "work", "dissipated"};
}

void EnergyRecorder::write_row(double t) {
  const std::array<double, 6> row = {t, now_.kinetic, now_.strain, now_.contact, work_, dissipated_};
  writer_->row(row);
}

void EnergyRecorder::finish() {
  if (writer_ != nullptr) writer_->flush();
}

void EnergyRecorder::save(ByteWriter& to) const {
  for (const double number : {last_.of_loads, last_.of_damping, now_.kinetic, now_.strain, now_.contact, first_total_,
                              largest_, work_, dissipated_})
    to.put(number);
  if (times_) times_->save(to);
  to.put(writer_ != nullptr ? writer_->position() : std::uint64_t{0});
}

void EnergyRecorder::restore(ByteReader& from) {
  for (double* number : {&last_.of_loads, &last_.of_damping, &now_.kinetic, &now_.strain, &now_.contact, &first_total_,
                         &largest_, &work_, &dissipated_})
    from.take(*number);
  if (times_) times_->restore(from);
  const auto position = from.take<std::uint64_t>();
  if (writer_ != nullptr) writer_->go_back(position);
}

double EnergyRecorder::balance_error() const {
  return largest_ > 0.0 ? (now_.total() - first_total_ + dissipated_ - work_) / largest_ : 0.0;
}

}  // namespace butee::record
