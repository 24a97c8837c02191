#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {

Eigen::Vector3d Obstacles::memory(Index i, const ContactPhase& phase, double t, ConstVectorRef x,
                                  ConstVectorRef v) const {
  const bool is_stretched = at(i).group->friction.rule == model::Friction::Rule::spring &&
                            phase.slip == ContactPhase::Slip::stick && phase.touches();
  return {static_cast<double>(phase.normal), static_cast<double>(phase.slip),
          is_stretched ? stretch(i, t, kinematics(i, t, x, v), phase.anchor) : 0.0};
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
  if (friction.rule == model::Friction::Rule::spring) phase.anchor = path(i, t, kinematics(i, t, x, v)) - memory[2];
  return phase;
}

}  // namespace butee::dynamics
