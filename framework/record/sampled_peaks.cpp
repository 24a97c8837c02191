#include "butee/record/sampled_peaks.hpp"

#include <algorithm>
#include <cmath>

#include "butee/model/element_choice.hpp"
#include "butee/record/contacts_on.hpp"

namespace butee::record {
namespace {

/// A sample below this fraction of the peak is not adjacent to a larger maximum, with eight samples
/// in a piece of a step, or three where it is near a quintic.
constexpr double kNearPeak = 0.9;
/// A force that is at least this fraction of the peak at an end of a piece, and larger than at the next
/// sample, may have its maximum between both: the force kNearEnd of their distance away tells.
constexpr double kHighEnd = 0.5, kNearEnd = 1e-4;
/// Distance of samples beside breakpoints, in parts of the piece, where no phases are followed:
/// dashpots make forces jump there.
constexpr double kBeside = 1e-9;

/// Samples of a harmonic motion of a frame are at most this phase angle apart, rad, but not more in a piece than
/// kMostSamples: beyond, the peak is that of the samples.
constexpr double kTurn = 0.5, kMostSamples = 1e6;

}  // namespace

SampledPeaks::SampledPeaks(Kind kind, const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics)
    : kind_(kind), dynamics_(dynamics), view_(kind == Kind::contacts ? Probes::View::contacts : Probes::View::output) {
  const model::System& system = dynamics.system();
  if (system.model == nullptr || (kind == Kind::contacts && dynamics.obstacles() == nullptr)) return;
  std::vector<model::ProbeRequest> chosen;
  for (model::ProbeRequest request : requests) {
    const std::vector<Index> contacts =
        kind == Kind::contacts ? obstacles_at(*system.model, system.dofs, request.node) : std::vector<Index>{};
    std::erase_if(request.quantities, [&](model::Quantity quantity) {
      if (kind == Kind::other_frame) return !Probes::has_base_share(system.model, system.dofs, request.node, quantity);
      return source_of(quantity) != model::Source::contacts && (!is_contact_force(quantity) || contacts.empty());
    });
    if (request.quantities.empty()) continue;
    for (const model::Quantity quantity : request.quantities)
      if (kind == Kind::other_frame) detail_ = std::max(detail_, static_cast<time::Detail>(order_of(quantity)));
    contacts_.insert(contacts_.end(), contacts.begin(), contacts.end());
    for (const model::Quantity quantity : request.quantities)
      has_stops_ = has_stops_ || (kind == Kind::contacts && is_contact_force(quantity) &&
                                  !contacts_on(*system.model, system.dofs,
                                               {request.node, contact_kind(*system.model, request.node, quantity)})
                                       .stops.empty());
    chosen.push_back(std::move(request));
  }
  for (const model::BaseMotion& base : system.model->bases)
    if (base.motion) fastest_ = std::max(fastest_, std::abs((*base.motion)[0].wave.angular_frequency));
  if (chosen.empty()) return;
  probes_ = std::make_unique<Probes>(chosen, dynamics);
  values_.resize(probes_->columns().size());
  largest_.assign(values_.size(), 0.0);
  last_.resize(values_.size());
}

void SampledPeaks::start(const time::State& state) {
  if (!probes_) return;
  probes_->evaluate(state, values_);
  for (std::size_t i = 0; i < values_.size(); ++i) largest_[i] = std::abs(values_[i]);
}

bool SampledPeaks::is_active() const {
  if (kind_ == Kind::other_frame || has_stops_) return true;
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  if (obstacles.is_live()) return true;
  return std::any_of(contacts_.begin(), contacts_.end(), [&](Index i) {
    return obstacles.phase(i).normal != dynamics::ContactPhase::Normal::apart || obstacles.group_of(i).shape == nullptr;
  });
}

void SampledPeaks::step(const time::AcceptedStep& step) {
  if (!probes_ || !is_active()) return;
  const std::span<const double> breakpoints =
      kind_ == Kind::contacts ? step.motion.breakpoints() : step.motion.breakpoints(detail_);
  const bool is_near_quintic = step.motion.interpolation() == time::Interpolation::near_quintic;
  const bool sees_jumps = kind_ == Kind::contacts && dynamics_.obstacles()->is_live();
  samples_ = 0;
  look(step, step.from.t);
  double begin = step.from.t;
  for (std::size_t piece = 0; piece <= breakpoints.size(); ++piece) {
    const double end = piece < breakpoints.size() ? breakpoints[piece] : step.to.t, length = end - begin;
    const bool may_jump = sees_jumps && begin + kBeside * length > begin && end - kBeside * length < end;
    int samples = is_near_quintic ? kSamplesOfQuintic : kSamples;
    if (kind_ == Kind::other_frame)
      samples = std::max(samples, static_cast<int>(std::min(kMostSamples, std::ceil(length * fastest_ / kTurn))));
    if (may_jump) look(step, begin + kBeside * length);
    for (int k = 1; k < samples; ++k) {
      look(step, begin + length * k / samples);
      if (k == 1) look_near(step, End::first);
    }
    look(step, may_jump ? end - kBeside * length : end);
    look_near(step, End::last);
    if (may_jump) look(step, end);
    begin = end;
  }
}

void SampledPeaks::look(const time::AcceptedStep& step, double t) {
  if (t <= step.from.t)
    probes_->evaluate(step.from, values_);
  else
    probes_->evaluate(step, t, values_, view_);
  now_ = values_;
  const bool has_two_before = samples_++ >= 2;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Sampled sample{t, std::abs(now_[i])};
    auto& [before, last] = last_[i];
    largest_[i] = std::max(largest_[i], sample.value);
    const bool is_top = has_two_before && last.value >= before.value && last.value >= sample.value && last.value > 0.0;
    if (is_top && last.value > kNearPeak * largest_[i]) {
      const Sampled top = local_maximum(before, last, sample, [&](double instant) {
        probes_->evaluate(step, instant, values_, view_);
        return std::abs(values_[i]);
      });
      largest_[i] = std::max(largest_[i], top.value);
    }
    before = last;
    last = sample;
  }
}

void SampledPeaks::look_near(const time::AcceptedStep& step, End end) {
  for (std::size_t i = 0; i < last_.size(); ++i) {
    const auto [before, last] = last_[i];
    const Sampled &at = end == End::first ? before : last, &other = end == End::first ? last : before;
    if (!(at.value > other.value) || !(at.value >= kHighEnd * largest_[i])) continue;
    const auto value_at = [&](double t) {
      probes_->evaluate(step, t, values_, view_);
      return std::abs(values_[i]);
    };
    const double t = at.t + kNearEnd * (other.t - at.t);
    if (!(t > before.t && t < last.t)) continue;
    const Sampled near{t, value_at(t)};
    if (near.value > at.value) largest_[i] = std::max(largest_[i], local_maximum(before, near, last, value_at).value);
  }
}

void SampledPeaks::add_to(std::map<std::string, double>& peaks) const {
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    double& peak = peaks[probes_->columns()[i]];
    peak = std::max(peak, largest_[i]);
  }
}

}  // namespace butee::record
