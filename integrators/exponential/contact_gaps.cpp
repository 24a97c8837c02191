#include "integrators/exponential/contact_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/dynamics/load_parabola.hpp"
#include "integrators/contact_on_the_way.hpp"
#include "integrators/exponential/residual_force.hpp"

namespace butee::integrators {
namespace {

constexpr double kNoGap = std::numeric_limits<double>::infinity();
/// Added to the distance from a side on which a stop does not act, m.
constexpr double kNoContact = 1e100;

}  // namespace

ContactGaps::ContactGaps(const dynamics::ElasticStops& contact) {
  const Index padded = dynamics::ContactPropagator::padded(contact.size());
  gaps_.setConstant(padded, kNoGap);
  limits_ = gaps_;
  upper_ = gaps_;
  lower_ = -gaps_;
  off_upper_.setZero(padded);
  off_lower_.setZero(padded);
  inner_borders_.setZero(padded);
  for (Index i = 0; i < contact.size(); ++i) {
    gaps_[i] = contact.play_of(i).gap;
    limits_[i] = constant_force_limit(contact, i);
    inner_borders_[i] = inner_border(contact.law_of(i));
    if (contact.play_of(i).has_positive())
      upper_[i] = gaps_[i];
    else
      off_upper_[i] = kNoContact;
    if (contact.play_of(i).has_negative())
      lower_[i] = -gaps_[i];
    else
      off_lower_[i] = kNoContact;
  }
}

double ContactGaps::time_to_contact(const ModalState& now) const {
  double time = kNoGap;
  for (Index i = 0; i < gaps_.size(); ++i) {
    if (now.wv[i] > 0.0 && off_upper_[i] == 0.0) time = std::min(time, (limits_[i] - now.w[i]) / now.wv[i]);
    if (now.wv[i] < 0.0 && off_lower_[i] == 0.0) time = std::min(time, (limits_[i] + now.w[i]) / -now.wv[i]);
  }
  return time;
}

DisplacementBounds::DisplacementBounds(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact)
    : modal_(modal), gaps_(contact), longest_near_(longest_near_stops(modal)) {
  bounds_.setZero(gaps_.gaps().size());
}

void DisplacementBounds::update(const TriedStep& step) {
  gaps_.bound_displacements(step.from.w, step.to.w,
                            (kBump * step.h) * (step.from.wv.abs() + step.to.wv.abs()) + beyond_cubic_, bounds_);
  for (const Index i : step.carried) bounds_[i] = kNoGap;
}

// Without branches: which stops are near changes from step to step.
void DisplacementBounds::find_near(std::vector<Index>& stops) const {
  stops.resize(static_cast<std::size_t>(modal_.stop_count()));
  std::size_t count = 0;
  for (Index i = 0; i < modal_.stop_count(); ++i) {
    stops[count] = i;
    count += is_near(i) ? 1 : 0;
  }
  stops.resize(count);
}

bool DisplacementBounds::find_carried(const Eigen::ArrayXd& start_speed, const dynamics::StopMotion& path,
                                      TriedStep& step) {
  if (static_cast<Index>(step.iterated.size()) == modal_.stop_count()) return false;
  gaps_.bound_displacements(step.from.w, path.end, kBump * (start_speed.abs() + path.speed.abs()) + beyond_cubic_,
                            path_bounds_);
  for (const Index i : step.iterated) path_bounds_[i] = -kNoGap;
  if (!((path_bounds_ - gaps_.gaps()).maxCoeff() > 0.0)) return false;
  const std::size_t before = step.carried.size();
  for (Index i = 0; i < modal_.stop_count(); ++i)
    if (path_bounds_[i] > gaps_.gaps()[i]) step.carried.push_back(i);
  return step.carried.size() > before;
}

void DisplacementBounds::find(const dynamics::ContactPropagator& flow, const TriedStep& step) {
  of_loads_ = flow.swing_harmonics;
  for (const dynamics::ModalSystem::OtherLoad& load : modal_.other_loads()) {
    const dynamics::LoadParabola force(*load.in_time, step.t, step.t + step.h);
    of_loads_ += force.largest() * (flow.swing_force * load.shape.abs()).sum();
    if (force.bend() != 0.0) of_loads_ += std::abs(force.bend()) * (flow.swing_bend * load.shape.abs()).sum();
  }
  beyond_cubic_ = (flow.swing_q * step.from.q.abs() + flow.swing_v * step.from.v.abs()).sum() + of_loads_;
  update(step);
}

}  // namespace butee::integrators
