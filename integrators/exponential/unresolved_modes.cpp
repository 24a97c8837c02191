#include "integrators/exponential/unresolved_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {

using Eigen::ArrayXd;

UnresolvedModes::UnresolvedModes(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts,
                                 const ContactGaps& gaps, ComponentSpeeds& speeds, const Goal& goal)
    : modal_(modal),
      contacts_(contacts),
      gaps_(gaps),
      speeds_(speeds),
      account_(goal),
      is_possible_(modal.size() > 1 && !contacts.empty()),
      squares_(modal.frequencies().square()),
      raised_(speeds.largest()),
      closed_(ArrayXd::Zero(modal.stop_count())),
      was_closed_(closed_) {
  for (ArrayXd* of : {&unreceived_, &rates_, &amplitudes_, &rise_, &start_.q, &start_.v, &end_.q, &end_.v})
    of->setZero(modal.size());
  for (Instant* instant : {&start_, &end_}) instant->w = gaps.gaps();
}

void UnresolvedModes::start(double t, const double* w, double* memory) const {
  if (!is_possible_) return;
  memory[0] = account_.rate() * t - account_.advance();
  for (Index j = 0; j < closed_.size(); ++j) memory[1 + j] = gaps_.is_spring(j) ? 1.0 : gaps_.closed_side(j, w[j]);
}

void UnresolvedModes::begin(double t, const double* memory, const ModalState& state) {
  if (!is_possible_) return;
  spent_ = memory[0];
  was_closed_ = Eigen::Map<const ArrayXd>(memory + 1, closed_.size());
  any_ = false;
  for (Index j = 0; j < closed_.size(); ++j) {
    closed_[j] = gaps_.is_spring(j) ? 1.0 : gaps_.closed_side(j, state.w[j]);
    any_ = any_ || (was_closed_[j] != 0.0 && closed_[j] != 0.0);
  }
  if (!any_) return;
  start_.set(t, state);
  find_rates(start_);
  speeds_.raise_to(raised_);
  is_of_start_ = true;
  energy_ = amplitudes_.square().sum();
}

void UnresolvedModes::look(double t, const ModalState& end) {
  constexpr double kGrown = 1.5;
  if (end.v.square().sum() > kGrown * energy_) {
    end_.set(t, end);
    find_rates(end_);
    is_of_start_ = false;
  } else if (!is_of_start_) {
    find_rates(start_);
    is_of_start_ = true;
  }
}

void UnresolvedModes::save(double* memory) const {
  if (!is_possible_) return;
  memory[0] = spent_;
  Eigen::Map<ArrayXd>(memory + 1, closed_.size()) = closed_;
}

double UnresolvedModes::error(double h) {
  if (h != unreceived_h_) {
    unreceived_ = squares_.unaryExpr([h](double square) { return unreceived_part(square * h * h); });
    unreceived_h_ = h;
  }
  return h * (rates_ * unreceived_).matrix().norm();
}

void UnresolvedModes::find_rates(const Instant& at) {
  constexpr double kExpected = 0.1, kRoundingOfModes = 64.0 * std::numeric_limits<double>::epsilon();
  const ArrayXd& frequencies = modal_.frequencies();
  amplitudes_ = -squares_ * at.q - 2.0 * modal_.decay() * at.v;
  modal_.add_load(at.t, amplitudes_);
  for (Index j = 0; j < modal_.stop_count(); ++j)
    if (closed_[j] != 0.0)
      amplitudes_ += modal_.stop_shapes().of(j).array() * contacts_[static_cast<std::size_t>(j)].force_at(at.w[j]);
  amplitudes_ = (frequencies > 0.0).select((at.v.square() + (amplitudes_ / frequencies).square()).sqrt(), 0.0);
  // In a static position modes vibrate by the rounding of the displacements and of the forces of closed stops.
  ArrayXd& rounding = rise_;
  rounding = at.q.matrix().norm() * squares_;
  for (Index j = 0; j < modal_.stop_count(); ++j)
    if (closed_[j] != 0.0) {
      const auto shape = modal_.stop_shapes().of(j).array().abs();
      rounding += contacts_[static_cast<std::size_t>(j)].tangent_at(at.w[j]) * (shape * at.q.abs()).sum() * shape;
    }
  amplitudes_ = (amplitudes_ * frequencies > kRoundingOfModes * rounding).select(amplitudes_, 0.0);
  rise_.setZero(modal_.size());
  for (Index j = 0; j < modal_.stop_count(); ++j)
    if (closed_[j] != 0.0 && was_closed_[j] != 0.0)
      rise_ += contacts_[static_cast<std::size_t>(j)].tangent_at(at.w[j]) * modal_.stop_shapes().of(j).array().square();
  // The largest velocity of a component per unit of modal speed, relative to its scale.
  rates_.setZero(modal_.size());
  for (Index d = 0; d < raised_.size(); ++d) {
    const auto shape = modal_.shape_rows().col(d).array();
    raised_[d] = std::max(speeds_.largest()[d], kExpected * (shape * amplitudes_).matrix().norm());
    if (raised_[d] > 0.0) rates_ = rates_.max(shape.abs() / raised_[d]);
  }
  rates_ *= ((squares_ + rise_).sqrt() - frequencies) * amplitudes_;
}

}  // namespace butee::integrators
