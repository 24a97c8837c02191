#include "butee/record/energy.hpp"

#include <algorithm>
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

EnergyRecorder::EnergyRecorder(solve::Dynamics& dynamics)
    : dynamics_(dynamics), all_(static_cast<std::size_t>(dynamics.size())), middle_(dynamics.size()), force_(middle_) {
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
  first_total_ = last_total_ = largest_ = energy_of(state, dynamics_).total();
  work_ = dissipated_ = 0.0;
  last_ = power(state.t, state.v);
}

void EnergyRecorder::step(const time::AcceptedStep& step) {
  const double half = 0.5 * (step.from.t + step.to.t);
  step.integrator.interpolate(step.from, step.to, half, all_,
                              {{}, {middle_.data(), static_cast<std::size_t>(middle_.size())}, {}});
  const Power middle = power(half, middle_);
  const Power end = power(step.to.t, step.to.v);
  work_ += step.h / 6.0 * (last_.of_loads + 4.0 * middle.of_loads + end.of_loads);
  dissipated_ += step.h / 6.0 * (last_.of_damping + 4.0 * middle.of_damping + end.of_damping);
  last_ = end;
  last_total_ = energy_of(step.to, dynamics_).total();
  largest_ = std::max(largest_, std::abs(last_total_));
}

void EnergyRecorder::save(ByteWriter& to) const {
  for (const double number :
       {last_.of_loads, last_.of_damping, first_total_, last_total_, largest_, work_, dissipated_})
    to.put(number);
}

void EnergyRecorder::restore(ByteReader& from) {
  for (double* number :
       {&last_.of_loads, &last_.of_damping, &first_total_, &last_total_, &largest_, &work_, &dissipated_})
    from.take(*number);
}

double EnergyRecorder::balance_error() const {
  return largest_ > 0.0 ? (last_total_ - first_total_ + dissipated_ - work_) / largest_ : 0.0;
}

}  // namespace butee::record
