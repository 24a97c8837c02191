#include "integrators/exponential/macro_step.hpp"

namespace butee::integrators {

MacroStep::MacroStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal,
                     std::vector<ContactForce>& contacts, std::size_t most)
    : modal_(modal),
      breakpoints_(modal, most),
      motion_(dynamics, modal, contacts, breakpoints_),
      output_(dynamics, modal, breakpoints_, motion_),
      energy_(dynamics, modal),
      bounds_(modal, breakpoints_) {
  w_middle_.setZero(dynamics::ContactPropagator::padded(modal.stop_count()));
}

void MacroStep::begin(double t, const ModalState& state) {
  breakpoints_.clear();
  motion_.begin();
  bounds_.begin();
  add(t, state);
}

void MacroStep::add(double t, const ModalState& state) {
  output_.forget(breakpoints_.add(t, state.q.data(), state.v.data(), state.w.data()));
}

std::span<const time::EnergyAt> MacroStep::energies(std::span<const double> instants) {
  const auto at = [&](std::size_t k) {
    return ModalEnergy::Breakpoint{breakpoints_.time(k), breakpoints_.q(k), breakpoints_.v(k), breakpoints_.phases(k)};
  };
  energy_.begin(at(0), instants);
  for (std::size_t k = 1; k <= breakpoints_.steps(); ++k) {
    // Steps without contact are as long as quintics allow; the cubics of the energies need half
    // that length.
    if (breakpoints_.forces(k - 1).touched.empty()) {
      const double t = 0.5 * (breakpoints_.time(k - 1) + breakpoints_.time(k));
      motion_.find(k - 1, t);
      modal_.stop_shapes().displacement(motion_.q(), w_middle_.data());
      energy_.go_on({t, motion_.q(), motion_.v(), motion_.find_phases(t)}, w_middle_.data(), false);
    }
    energy_.go_on(at(k), breakpoints_.w(k).data(), k == breakpoints_.steps());
  }
  return energy_.told();
}

}  // namespace butee::integrators
