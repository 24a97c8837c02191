#include <cmath>
#include <numbers>

#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {

Eigen::Vector3d Obstacles::memory(Index i, const ContactPhase& phase, double t, ConstVectorRef x,
                                  ConstVectorRef v) const {
  const bool is_stretched = at(i).group->friction.rule == model::Friction::Rule::spring &&
                            phase.slip == ContactPhase::Slip::stick && phase.touches();
  return {static_cast<double>(phase.normal), static_cast<double>(phase.slip),
          is_stretched ? path(i, t, kinematics(i, t, x, v), phase.angle) - phase.anchor : 0.0};
}

ContactPhase Obstacles::phase_after(Index i, const Eigen::Vector3d& memory, double t, ConstVectorRef x,
                                    ConstVectorRef v) const {
  ContactPhase phase = phase_at(i, t, x, v);
  const model::Friction& friction = at(i).group->friction;
  const ContactPhase before{static_cast<ContactPhase::Normal>(static_cast<int>(memory[0])),
                            static_cast<ContactPhase::Slip>(static_cast<int>(memory[1]))};
  if (!friction.has_memory() || before.slip == ContactPhase::Slip::smooth || !before.touches() || !phase.touches())
    return phase;
  phase.slip = before.slip;
  if (friction.rule == model::Friction::Rule::spring) {
    const Kinematics now = kinematics(i, t, x, v);
    phase.angle = angle_of(i, now);
    phase.anchor = path(i, t, now, phase.angle) - memory[2];
  }
  return phase;
}

ContactPhase Obstacles::rebased(Index i, const ContactPhase& phase, ConstVectorRef x) const {
  const model::ContactShape::Form& form = at(i).form;
  if (at(i).group->friction.rule != model::Friction::Rule::spring || phase.slip != ContactPhase::Slip::stick ||
      form.kind != model::ContactShape::Form::Kind::circle)
    return phase;
  const Eigen::Vector2d arm = gather(i, x).head<2>() - form.place;
  ContactPhase next = phase;
  next.angle = std::atan2(arm[1], arm[0]);
  next.anchor -= form.sense * form.distance * std::remainder(next.angle - phase.angle, 2.0 * std::numbers::pi);
  return next;
}

}  // namespace butee::dynamics
