#include "integrators/exponential/macro_step.hpp"

#include <algorithm>

namespace butee::integrators {

MacroStep::MacroStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal,
                     std::vector<ContactForce>& contacts, std::size_t most, double tolerance)
    : modal_(modal),
      breakpoints_(modal, most),
      motion_(dynamics, modal, contacts, breakpoints_),
      output_(dynamics, modal, breakpoints_, motion_),
      energy_(dynamics, modal),
      bounds_(modal, breakpoints_),
      hidden_(dynamics, modal, tolerance),
      fast_(modal) {
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

std::span<const double> MacroStep::inner() {
  if (!hidden_.any()) return breakpoints_.inner();
  inner_.clear();
  for (std::size_t k = 0; k < breakpoints_.steps(); ++k) {
    const HiddenModes::State from = state(k), to = state(k + 1);
    const int parts = hidden_.parts(from, to, HiddenModes::Through::accelerations);
    if (k > 0) inner_.push_back(from.t);
    for (int j = 1; j < parts; ++j)
      if (const double t = from.t + (to.t - from.t) / parts * j; t > from.t && t < to.t) inner_.push_back(t);
  }
  return inner_;
}

void MacroStep::departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
  if (modal_.stop_count() == 0) return bounds_.departure(begin, end, dofs, out);
  if (out.v.empty()) return;
  const std::size_t k = breakpoints_.before(begin);
  for (std::size_t i = 0; i < dofs.size(); ++i)
    out.v[i] = fast_.departure(dofs[i], end - begin, breakpoints_.v(k), breakpoints_.v(k + 1));
}

std::span<const time::EnergyAt> MacroStep::energies(std::span<const double> instants) {
  const auto at = [&](std::size_t k) {
    return ModalEnergy::Breakpoint{breakpoints_.time(k), breakpoints_.q(k), breakpoints_.v(k), breakpoints_.phases(k)};
  };
  energy_.begin(at(0), instants);
  for (std::size_t k = 1; k <= breakpoints_.steps(); ++k) {
    const HiddenModes::State from = state(k - 1), to = state(k);
    // Steps without contact are as long as quintics allow; the cubics of the energies need half
    // that length.
    const int parts = std::max(breakpoints_.forces(k - 1).touched.empty() ? 2 : 1,
                               hidden_.parts(from, to, HiddenModes::Through::speeds));
    for (int j = 1; j < parts; ++j) {
      const double t = from.t + (to.t - from.t) / parts * j;
      motion_.find(k - 1, t);
      modal_.stop_shapes().displacement(motion_.q(), w_middle_.data());
      energy_.go_on({t, motion_.q(), motion_.v(), motion_.find_phases(t)}, w_middle_.data(), false);
    }
    energy_.go_on(at(k), breakpoints_.w(k).data(), k == breakpoints_.steps());
  }
  return energy_.told();
}

}  // namespace butee::integrators
