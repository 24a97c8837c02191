#include "integrators/exponential/single_record.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

using Point = Oscillator::Point;

SingleRecord::SingleRecord(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, const SingleMode& mode,
                           ContactForce& contact, double tolerance, std::size_t most)
    : mode_(mode),
      contact_(contact),
      tolerance_(tolerance),
      phases_(mode.harmonics, most),
      motion_(dynamics, modal, mode, contact),
      energy_(dynamics, modal) {
  breakpoints_.reserve(most + 1);
  times_.reserve(most + 1);
}

void SingleRecord::begin(double t, Point at, const double* phase_memory) {
  breakpoints_.assign(1, {t, at});
  times_.assign(1, t);
  phases_.load(t, phase_memory);
}

void SingleRecord::add(const SingleFlow& flow, const SingleBreakpoint::Step& step, double t, Point at) {
  breakpoints_.back().step = step;
  breakpoints_.push_back({t, at});
  times_.push_back(t);
  phases_.turn(breakpoints_.size() - 1, t, [&](std::size_t j) { return flow.harmonics[j].turn; });
}

std::span<const double> SingleRecord::inner() const {
  if (times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

const Motion& SingleRecord::motion_at(std::size_t k) {
  SingleBreakpoint& at = breakpoints_[k];
  if (at.has_motion) return at.motion;
  at.has_motion = true;
  return at.motion = motion_.at(at.at, phases_.at(k));
}

bool SingleRecord::is_quintic(std::size_t k, double speed) const {
  // Relative error of a quintic's slope: (omega h)^5 sqrt(5)/30000 in smooth motion, kKinkedSlope
  // (omega h)^2 if a stop opens or closes, and kJumpedSlope times the speed that a jump or a bend of the
  // force causes in the step.
  constexpr double kGoodPart = 0.5, kKinkedSlope = 5e-3, kJumpedSlope = 0.07;
  const SingleBreakpoint& from = breakpoints_[k];
  const double h = breakpoints_[k + 1].t - from.t, shape = mode_.stop_shape;
  const ContactPath path = path_between(mode_, from, breakpoints_[k + 1]);
  const double stiff = from.step.force[0] != 0.0 ? h * h * contact_.stiffness_along(path) * shape * shape : 0.0;
  const double angle =
      h * h * (mode_.square + 4.0 * mode_.decay * mode_.decay + mode_.load_frequency * mode_.load_frequency) + stiff;
  const double good = kGoodPart * tolerance_;
  if (quintic_error(1.0, angle * angle * std::sqrt(angle)).v > good) return false;
  const double change = std::max(contact_.jump(path), contact_.bend(path));
  if (kJumpedSlope * h * shape * shape * change > good * speed) return false;
  return kKinkedSlope * stiff <= good || contact_.status(path) != ContactStatus::changing;
}

std::span<const time::EnergyAt> SingleRecord::energies(std::span<const double> instants) {
  const auto at = [&](std::size_t k) {
    const SingleBreakpoint& known = breakpoints_[k];
    return ModalEnergy::Breakpoint{known.t, &known.at.q, &known.at.v, phases_.at(k)};
  };
  energy_.begin(at(0), instants);
  std::vector<Phase> middle_phases(mode_.harmonics.size());
  for (std::size_t k = 1; k < breakpoints_.size(); ++k) {
    // Steps without contact are as long as quintics allow; the cubics of the energies need half
    // that length.
    const double t = 0.5 * (breakpoints_[k - 1].t + breakpoints_[k].t);
    const Motion motion = motion_within(k - 1, t);
    const Point middle = {motion.x / mode_.shape, motion.v / mode_.shape};
    for (std::size_t j = 0; j < middle_phases.size(); ++j) {
      const double angle = mode_.harmonics[j].angular_frequency * t;
      middle_phases[j] = {std::cos(angle), std::sin(angle)};
    }
    const double w_middle = mode_.stop_shape * middle.q, w = mode_.stop_shape * breakpoints_[k].at.q;
    energy_.go_on({t, &middle.q, &middle.v, middle_phases}, &w_middle, false);
    energy_.go_on(at(k), &w, k + 1 == breakpoints_.size());
  }
  return energy_.told();
}

void SingleRecord::interpolate(std::span<const double> times, ContactScale scale, time::Interpolated out) {
  const auto put = [&](std::size_t place, const Motion& motion) {
    if (!out.x.empty()) out.x[place] = motion.x;
    if (!out.v.empty()) out.v[place] = motion.v;
    if (!out.a.empty()) out.a[place] = motion.a;
  };
  std::size_t k = 0;
  for (std::size_t i = 0; i < times.size();) {
    while (k + 2 < breakpoints_.size() && breakpoints_[k + 1].t <= times[i]) ++k;
    if (times[i] == breakpoints_[k].t) {
      put(i++, motion_at(k));
      continue;
    }
    const double begin = breakpoints_[k].t, end = breakpoints_[k + 1].t, h = end - begin;
    if (is_quintic(k, scale.speed)) {
      const Quintic quintic(h, motion_at(k), motion_at(k + 1));
      for (; i < times.size() && times[i] < end; ++i) {
        const double s = (times[i] - begin) / h;
        put(i, {quintic.value(s), quintic.slope(s), quintic.curvature(s)});
      }
    } else {
      for (; i < times.size() && times[i] < end; ++i) put(i, motion_within(k, times[i]));
    }
    if (k + 2 == breakpoints_.size() && i < times.size() && times[i] >= end) put(i++, motion_at(k + 1));
  }
}

}  // namespace butee::integrators
