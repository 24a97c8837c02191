#include "integrators/exponential/varying_forces.hpp"

#include <algorithm>

#include "butee/model/model.hpp"
#include "butee/model/rotation.hpp"

namespace butee::integrators {
namespace {

/// force -= factor A y
void subtract(const SparseMatrix& matrix, double factor, const Vector& y, Vector& force) {
  if (matrix.size() > 0 && factor != 0.0) force.noalias() -= factor * (matrix * y);
}

}  // namespace

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

void VaryingForces::add(double t, const Vector& x, const Vector& v, Vector& force) const {
  for (const model::FreeLoad* load : unbalances_) {
    const double value = load->in_time->value(t);
    for (std::size_t i = 0; i < load->dofs.size(); ++i) force[load->dofs[i]] += load->weights[i] * value;
  }
  if (system_.rotation == nullptr) return;
  const double more = system_.rotation->speed(t) - reference_speed_;
  subtract(system_.gyroscopic, more, v, force);
  subtract(system_.circulatory, more, x, force);
  subtract(system_.gyroscopic, system_.rotation->acceleration(t), x, force);
}

}  // namespace butee::integrators
