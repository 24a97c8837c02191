#include "butee/dynamics/external_forces.hpp"

#include <algorithm>

namespace butee::dynamics {

ExternalForces::ExternalForces(const model::System& system) : system_(system), values_(system.loads.size()) {
  for (std::size_t j = 0; j < system.loads.size(); ++j)
    for (std::size_t i = 0; i < system.loads[j].dofs.size(); ++i)
      entries_.push_back({system.loads[j].dofs[i], system.loads[j].weights[i], j});
}

void ExternalForces::evaluate(double t) {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = system_.loads[i].in_time->value(t);
  time_ = t;
}

void ExternalForces::rate(double t, double h, VectorRef rate) {
  rate.setZero();
  for (const model::FreeLoad& load : system_.loads) {
    double slope = 0.0;
    if (load.in_time->taylor(t, 1.0, series_))
      slope = series_[1];
    else
      slope = (load.in_time->value(t + h) - load.in_time->value(t)) / h;
    for (std::size_t i = 0; i < load.dofs.size(); ++i) rate[load.dofs[i]] += load.weights[i] * slope;
  }
}

std::vector<double> ExternalForces::discontinuities() const {
  std::vector<double> all;
  const auto take = [&all](const std::vector<double>& instants) {
    all.insert(all.end(), instants.begin(), instants.end());
  };
  for (const model::FreeLoad& load : system_.loads) take(load.in_time->discontinuities());
  if (system_.rotation != nullptr) take(system_.rotation->discontinuities());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace butee::dynamics
