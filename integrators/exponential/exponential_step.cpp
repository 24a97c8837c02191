#include "integrators/exponential/exponential_step.hpp"

#include <algorithm>
#include <cmath>

#include "butee/dynamics/dynamics.hpp"
#include "integrators/exponential/propagation.hpp"

namespace butee::integrators {
namespace {

using dynamics::ContactPropagator;
using dynamics::ModalPropagator;
using Eigen::ArrayXd;

std::vector<ContactForce> contact_forces(dynamics::ElasticStops& contact) {
  std::vector<ContactForce> forces;
  for (Index i = 0; i < contact.size(); ++i) forces.emplace_back(contact, i);
  return forces;
}

/// Rounds the length of a step between outputs to kSameBits bits of the time, so that equal output
/// intervals give equal step lengths; steps so short that this changes them by more than 1/(2 kMany)
/// are left alone, as those of pulses.
double rounded(double h, double t_end) {
  constexpr int kSameBits = 50;
  constexpr double kMany = 1e8;
  const double unit = std::ldexp(1.0, std::ilogb(t_end) - kSameBits);
  return h > kMany * unit ? std::round(h / unit) * unit : h;
}

}  // namespace

ExponentialStep::ExponentialStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, const StepGoal& goal,
                                 std::size_t most)
    : modal_(modal),
      goal_(goal),
      contacts_(contact_forces(dynamics.stops())),
      record_(dynamics, modal, contacts_, 2 * most, goal_.outputs),
      bounds_(modal, dynamics.stops()),
      scales_(modal, dynamics.stops()),
      errors_(dynamics.stops(), goal_, bounds_, scales_, step_),
      residual_(modal, dynamics.stops()),
      jumps_(modal, contacts_),
      iteration_(modal, goal_, contacts_, bounds_.gaps(), scales_, step_),
      contact_error_(dynamics.system(), modal, goal_, contacts_, bounds_, scales_, iteration_, errors_),
      interpolation_(modal, goal_.outputs) {
  for (ModalState* state : {&step_.from, &step_.to, &step_.middle}) state->resize(modal);
  for (std::vector<Index>* list : {&step_.iterated, &step_.constant}) list->reserve(contacts_.size());
}

void ExponentialStep::complete(double t, double* memory) const {
  if (!has_stops()) return;
  const Index n = modal_.size(), m = modal_.stop_count();
  double* stops = memory + 2 * n;
  find_stops(memory);
  scales_.start(memory, memory + n, stops, stops + 2 * m);
  contact_error_.start(t, memory, stops, stops + 2 * m + scales_.memory_size());
}

void ExponentialStep::find_stops(double* memory) const {
  const Index n = modal_.size();
  modal_.stop_shapes().displacement(memory, memory + n, memory + 2 * n, memory + 2 * n + modal_.stop_count());
}

bool ExponentialStep::rests_in_middle() const {
  if (!errors_.any()) return false;
  for (Index i = 0; i < modal_.stop_count(); ++i)
    if (step_.from.w[i] == 0.0 && errors_.force(i).jumps()) return true;
  return false;
}

void ExponentialStep::begin(double t, const double* memory, ContactScale scale) {
  const Index n = modal_.size(), m = modal_.stop_count();
  step_.from.q = Eigen::Map<const ArrayXd>(memory, n);
  step_.from.v = Eigen::Map<const ArrayXd>(memory + n, n);
  step_.from.w.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n, m);
  step_.from.wv.head(m) = Eigen::Map<const ArrayXd>(memory + 2 * n + m, m);
  scales_.load(memory + 2 * n + 2 * m, scale);
  contact_error_.load(t, memory + 2 * n + 2 * m + scales_.memory_size(), step_.from);
  if (errors_.any())
    for (Index i = 0; i < m; ++i) {
      const double impulse = kLasting * goal_.tolerance / modal_.stop_shapes().of(i).squaredNorm();
      contacts_[static_cast<std::size_t>(i)].allow(impulse * scale.speed / goal_.run_time,
                                                   impulse * scale.speed / scale.characteristic_time());
    }
  record_.begin(t, step_.from);
  residual_.begin(step_.from.w);
}

void ExponentialStep::save(double* memory) const {
  const Index n = modal_.size(), m = modal_.stop_count();
  Eigen::Map<ArrayXd>(memory, n) = step_.from.q;
  Eigen::Map<ArrayXd>(memory + n, n) = step_.from.v;
  Eigen::Map<ArrayXd>(memory + 2 * n, m) = step_.from.w.head(m);
  Eigen::Map<ArrayXd>(memory + 2 * n + m, m) = step_.from.wv.head(m);
  scales_.save(memory + 2 * n + 2 * m);
  contact_error_.save(memory + 2 * n + 2 * m + scales_.memory_size());
}

Trial ExponentialStep::attempt_until(double t) {
  const double h = t - this->t();
  return attempt(modal_.odd(has_stops() ? h : rounded(h, t)), t);
}

void ExponentialStep::propagate(const ModalPropagator& flow, double t_end, ArrayXd& q, ArrayXd* v) {
  Breakpoints& breakpoints = record_.breakpoints();
  integrators::propagate(
      modal_, flow,
      {breakpoints.last(), step_.from.q, step_.from.v, breakpoints.phases(breakpoints.steps()), residual_force()},
      t_end, q, v);
}

bool ExponentialStep::propagate_to_end(const ModalPropagator& flow) {
  propagate(flow, step_.t_end, step_.to.q, &step_.to.v);
  if (!has_stops()) return step_.to.q.allFinite() && step_.to.v.allFinite();
  step_.to.find_stops(modal_.stop_shapes());
  return std::isfinite(step_.to.w.sum() + step_.to.wv.sum());
}

Trial ExponentialStep::attempt(ContactPropagator& flow, double t_end) {
  step_.t = t();
  step_.t_end = t_end;
  step_.h = flow.h();
  step_.carried.clear();
  step_.crossing.clear();
  while (true)
    if (const std::optional<Trial> trial = attempt(flow)) return *trial;
}

std::optional<Trial> ExponentialStep::attempt(ContactPropagator& flow) {
  step_.iterated.clear();
  step_.is_near = false;
  step_.breakpoint = error_ = 0.0;
  contact_error_.begin();
  if (!propagate_to_end(flow.whole)) return Trial::not_finite;
  if (!has_stops()) return Trial::accepted;
  choose_stops(flow);
  if (step_.is_near && step_.h > bounds_.longest_near()) return Trial::too_long;
  if (!step_.iterated.empty()) propagate(flow.half, 0.5 * (step_.t + step_.t_end), step_.middle.q, nullptr);
  if (!step_.is_near && !is_smooth(flow)) return Trial::too_long;
  if (errors_.any() && !add_jumps(flow)) return Trial::too_long;
  if (step_.breakpoint > 0.0 && shows_jump()) return Trial::too_long;
  if (!step_.iterated.empty()) {
    const std::optional<double> displacement = iteration_.solve(flow);
    if (!displacement) return Trial::too_long;
    error_ = contact_error_.of_step(flow, step_, *displacement);
    if (!(error_ <= goal_.middle * *displacement)) return Trial::too_long;
    iteration_.complete_paths(flow);
    if (bounds_.find_carried(iteration_.paths().start_speed(), iteration_.paths().motion(), step_)) return std::nullopt;
    if (errors_.any() && jumps_.find_moved(flow, errors_, residual_.forces(), iteration_.paths(), step_))
      return std::nullopt;
    iteration_.apply(flow, step_);
    error_ = std::max(error_, contact_error_.of_modes(step_) * goal_.middle * *displacement);
    if (!(error_ <= goal_.middle * *displacement)) return Trial::too_long;
  }
  if (errors_.any() && step_.breakpoint > 0.0)
    modal_.stop_shapes().displacement(step_.middle.q.data(), step_.middle.w.data());
  scales_.raise_largest(step_.to);
  return Trial::accepted;
}

void ExponentialStep::choose_stops(ContactPropagator& flow) {
  step_.reached = {std::max(scales_.largest().displacement, step_.to.largest_w()),
                   std::max(scales_.largest().speed, step_.to.largest_wv())};
  const bool has_residual = errors_.any();
  if (has_residual) errors_.find_shares();
  bounds_.find(flow, step_);
  step_.constant.clear();
  if (has_residual) errors_.find_constant(flow, step_);
  bounds_.find_near(step_.iterated);
  step_.is_near = !step_.iterated.empty();
  if (has_residual) {
    step_.iterated.clear();
    for (Index i = 0; i < modal_.stop_count(); ++i) {
      const bool is_iterated = bounds_.is_near(i) || step_.is_crossing(i) || !errors_.is_constant(flow, i);
      (is_iterated ? step_.iterated : step_.constant).push_back(i);
    }
  }
  while (has_residual && residual_.update(flow, errors_, step_) && choose_more_stops(flow)) {
  }
}

bool ExponentialStep::choose_more_stops(ContactPropagator& flow) {
  std::vector<Index>& iterated = step_.iterated;
  const std::size_t before = iterated.size();
  step_.reached.displacement = std::max(step_.reached.displacement, step_.to.largest_w());
  errors_.find_shares();
  bounds_.update(step_);
  for (const Index i : step_.constant) {
    const bool is_near = bounds_.is_near(i);
    step_.is_near = step_.is_near || is_near;
    if (is_near || !errors_.may_be(flow, i)) iterated.push_back(i);
  }
  if (iterated.size() == before) return false;
  std::sort(iterated.begin(), iterated.end());
  std::erase_if(step_.constant, [&](Index i) { return std::binary_search(iterated.begin(), iterated.end(), i); });
  return true;
}

bool ExponentialStep::add_jumps(ContactPropagator& flow) {
  if (!jumps_.find(flow, errors_, step_)) return true;
  for (const Index i : jumps_.stops()) {
    if (!errors_.force(i).jumps()) continue;
    const ContactScale at_end = {std::abs(step_.to.w[i]), std::abs(step_.to.wv[i])};
    if (contact_error_.of_jump(flow, i, scales_.of(i, at_end, step_.reached.displacement).speed) > 1.0) return false;
  }
  if (step_.iterated.empty()) propagate(flow.half, 0.5 * (step_.t + step_.t_end), step_.middle.q, nullptr);
  jumps_.add(flow, residual_.forces(), step_);
  return true;
}

bool ExponentialStep::is_smooth(ContactPropagator& flow) {
  if (interpolation_.is_bounded(flow, step_, bounds_.of_loads())) return true;
  propagate(flow.half, 0.5 * (step_.t + step_.t_end), step_.middle.q, &step_.middle.v);
  step_.middle.find_stops(modal_.stop_shapes());
  return interpolation_.is_close(step_, residual_force());
}

// A breakpoint in the middle divides forces as polynomials, which is not accurate for a jump.
bool ExponentialStep::shows_jump() const {
  const auto shows = [&](Index i) { return errors_.shows_jump(i, modal_.stop_shapes().of(i).squaredNorm()); };
  return std::any_of(step_.iterated.begin(), step_.iterated.end(), shows) ||
         std::any_of(jumps_.stops().begin(), jumps_.stops().end(), shows);
}

// Where a stop is closed its force balances others, and the motion without it says nothing.
void ExponentialStep::expect_motion(int index) {
  const ContactGaps& gaps = bounds_.gaps();
  for (Index i = 0; i < modal_.stop_count(); ++i)
    if (!gaps.is_spring(i) && gaps.closed_side(i, step_.from.w[i]) != 0.0) return;
  const ModalPropagator& flow = modal_.propagator(index).whole;
  step_.t_end = t() + flow.h();
  if (propagate_to_end(flow)) scales_.raise_largest(step_.to);
}

void ExponentialStep::accept(double t) {
  record_forces();
  contact_error_.charge(step_);
  if (step_.breakpoint > 0.0) record_.add(step_.breakpoint, step_.middle);
  std::swap(step_.from, step_.to);
  scales_.raise(step_.from);
  record_.add(t, step_.from);
}

void ExponentialStep::record_forces() {
  const std::size_t k_from = record_.breakpoints().steps();
  StepForces& forces = record_.breakpoints().forces(k_from);
  const bool has_contact = !step_.iterated.empty() && !iteration_.touched().empty(), has_residual = errors_.any();
  const bool has_jumps = !jumps_.stops().empty();
  forces.is_free = !has_contact && !has_residual;
  record_contacts(forces, has_contact);
  if (has_residual) forces.constant = residual_.forces();
  for (std::size_t k = 0; k < (forces.is_free ? 0 : forces.moments.size()); ++k) {
    auto to = forces.moments[k].head(modal_.size()).array();
    if (has_contact)
      to = iteration_.modal_moments(k);
    else
      to.setZero();
    if (has_jumps) to += jumps_.modal_moments(k);
    if (k == 0 && has_residual) to += residual_.modal();
  }
  // Only steps without contact have a breakpoint in the middle.
  if (step_.breakpoint > 0.0)
    forces.divide(0.5, step_.from.w.matrix(), step_.to.w.matrix(), record_.breakpoints().forces(k_from + 1));
}

void ExponentialStep::record_contacts(StepForces& forces, bool has_contact) const {
  forces.touched.clear();
  auto& paths = forces.paths;
  const auto allowed_speed = [&](Index i) {
    const ContactScale reached = {std::abs(step_.to.w[i]),
                                  std::max(std::abs(step_.from.wv[i]), std::abs(step_.to.wv[i]))};
    return goal_.outputs * scales_.of(i, reached, scales_.largest().displacement).speed;
  };
  if (has_contact) {
    forces.touched = iteration_.touched();
    paths.col(StepForces::kStartSpeed) = iteration_.paths().start_speed();
    paths.col(StepForces::kEndSpeed) = iteration_.paths().motion().speed;
    paths.col(StepForces::kQuartic) = iteration_.paths().quartic();
    for (std::size_t k = 0; k < 3; ++k) paths.col(StepForces::kMoments + static_cast<Index>(k)) = iteration_.moments(k);
  }
  for (const Index i : forces.touched) paths(i, StepForces::kAllowedSpeed) = allowed_speed(i);
  for (std::size_t j = 0; j < jumps_.stops().size(); ++j) {
    const Index i = jumps_.stops()[j];
    forces.touched.push_back(i);
    forces.set(
        i, {step_.from.w[i], step_.h * step_.from.wv[i], step_.to.w[i], step_.h * step_.to.wv[i], jumps_.quartic(j)},
        jumps_.moments(j), allowed_speed(i));
  }
}

}  // namespace butee::integrators
