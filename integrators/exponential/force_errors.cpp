#include "integrators/exponential/force_errors.hpp"

#include <algorithm>

namespace butee::integrators {

ForceErrors::ForceErrors(dynamics::Dynamics& dynamics, const ContactDofs& dofs)
    : dynamics_(dynamics), dofs_(dofs), onset_(dynamics) {
  x_ = v_ = onset_errors_ = Vector::Zero(dynamics.size());
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const model::ObstacleGroup& group = obstacles->group_of(i);
      if (group.shape == nullptr && group.friction.rule != model::Friction::Rule::none) supports_.push_back(i);
    }
  support_friction_.resize(static_cast<Index>(supports_.size()), StepNodes::kCount);
}

void ForceErrors::find(const Step& step) {
  const Index count = step.active.count();
  const AtNodes legendre = step.forces * StepNodes::legendre();
  impulse_errors_.resize(count);
  inner_errors_.resize(count);
  for (Index k = 0; k < count; ++k) {
    impulse_errors_[k] = StepNodes::quadrature_error(legendre.row(k));
    inner_errors_[k] = StepNodes::inner_error(legendre.row(k));
  }
  if (!supports_.empty()) add_supports(step);
  if (onset_.any()) add_onsets(step);
  impulse_errors_ *= step.h;
  for (Index k = 0; k < count; ++k)
    inner_errors_[k] *= step.h * dofs_.inverse_mass(step.active.dofs[static_cast<std::size_t>(k)]);
}

// Beside the force of a stop on the same DOF, the slow decay of a small force that reverses would not be seen.
void ForceErrors::add_supports(const Step& step) {
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  for (Index node = 0; node < StepNodes::kCount; ++node) {
    for (Index k = 0; k < step.active.count(); ++k) {
      const Index dof = step.active.dofs[static_cast<std::size_t>(k)];
      x_[dof] = step.x(k, node);
      v_[dof] = step.v(k, node);
    }
    const double now = step.t + StepNodes::kPlaces[static_cast<std::size_t>(node)] * step.h;
    for (std::size_t i = 0; i < supports_.size(); ++i)
      support_friction_(static_cast<Index>(i), node) = obstacles.forces(supports_[i], now, x_, v_).friction;
  }
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    const StepNodes::Row row = support_friction_.row(static_cast<Index>(i)) * StepNodes::legendre();
    for (const auto& side : {obstacles.ends_of(supports_[i]).a, obstacles.ends_of(supports_[i]).b})
      if (side[0] >= 0) {
        const Index k = step.active.place(side[0]);
        impulse_errors_[k] = std::max(impulse_errors_[k], StepNodes::quadrature_error(row));
        inner_errors_[k] = std::max(inner_errors_[k], StepNodes::inner_error(row));
      }
  }
}

void ForceErrors::add_onsets(const Step& step) {
  onset_errors_.setZero();
  for (const bool at_end : {false, true}) {
    for (Index k = 0; k < step.active.count(); ++k) {
      const Index dof = step.active.dofs[static_cast<std::size_t>(k)];
      x_[dof] = step.x(k, at_end ? StepNodes::kEnd : 0);
      v_[dof] = at_end ? step.modes.velocity().col(dof).dot(step.end) : step.v(k, 0);
    }
    onset_.add_errors({at_end ? step.t + step.h : step.t, at_end ? -step.h : step.h, x_, v_}, onset_errors_);
  }
  for (Index k = 0; k < step.active.count(); ++k) {
    const double error = onset_errors_[step.active.dofs[static_cast<std::size_t>(k)]];
    impulse_errors_[k] += error;
    inner_errors_[k] += ContactOnset::kInner * error;
  }
}

}  // namespace butee::integrators
