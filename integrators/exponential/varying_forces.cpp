#include "integrators/exponential/varying_forces.hpp"

#include <algorithm>

#include "butee/model/model.hpp"
#include "butee/model/rotation.hpp"

namespace butee::integrators {

VaryingForces::VaryingForces(const model::System& system, double reference_speed)
    : system_(system), reference_speed_(reference_speed) {
  if (system.rotation != nullptr)
    for (const SparseMatrix* matrix : {&system.gyroscopic, &system.circulatory})
      for (Index column = 0; column < matrix->outerSize(); ++column)
        for (SparseMatrix::InnerIterator entry(*matrix, column); entry; ++entry)
          if (entry.value() != 0.0) dofs_.insert(dofs_.end(), {entry.row(), entry.col()});
  for (const model::FreeLoad& load : system.loads) {
    if (!contains(load)) continue;
    unbalances_.push_back(&load);
    dofs_.insert(dofs_.end(), load.dofs.begin(), load.dofs.end());
    highest_frequency_ = system.model->rotation->largest_speed();
  }
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
}

bool VaryingForces::contains(const model::FreeLoad& load) {
  return dynamic_cast<const model::TurningUnbalance*>(load.in_time) != nullptr && !load.in_time->harmonic();
}

void VaryingForces::add(double t, const Vector& x, const Vector& v, Vector& force) {
  for (const model::FreeLoad* load : unbalances_) {
    const double value = load->in_time->value(t);
    for (std::size_t i = 0; i < load->dofs.size(); ++i) force[load->dofs[i]] += load->weights[i] * value;
  }
  if (system_.rotation == nullptr) return;
  const double more = system_.rotation->speed(t) - reference_speed_;
  if (system_.gyroscopic.size() > 0) {
    work_ = more * v + system_.rotation->acceleration(t) * x;
    force.noalias() -= system_.gyroscopic * work_;
  }
  if (system_.circulatory.size() > 0) force.noalias() -= more * (system_.circulatory * x);
}

}  // namespace butee::integrators
