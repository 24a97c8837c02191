#include "butee/record/contact_peaks.hpp"

#include <algorithm>

namespace butee::record {
namespace {

/// A sample below this fraction of the peak is not adjacent to a larger maximum, with eight samples
/// in a piece of a step, or three where it is near a quintic.
constexpr double kNearPeak = 0.9;
/// Distance of the samples beside the ends of a piece, in parts of it: they show whether forces rise
/// from an end, so that a peak lies between it and the next sample.
constexpr double kNearEnd = 1e-4;
/// The same where no phases are followed and dashpots make forces jump at breakpoints.
constexpr double kBeside = 1e-9;

/// True if the tangent at a sample close to one of its neighbours exceeds `largest` at the other
/// neighbour: a concave force remains below it.
bool may_exceed(const Sampled& before, const Sampled& at, const Sampled& after, double largest) {
  constexpr double kClose = 0.01;
  const double left = at.t - before.t, right = after.t - at.t;
  if (left < kClose * right) return at.value + (at.value - before.value) / left * right > largest;
  if (right < kClose * left) return at.value + (at.value - after.value) / right * left > largest;
  return false;
}

std::vector<Index> contacts_of(dynamics::Dynamics& dynamics, model::NodeId node) {
  const model::System& system = dynamics.system();
  const dynamics::Obstacles& obstacles = *dynamics.obstacles();
  std::vector<Index> contacts;
  for (Index i = 0; i < obstacles.size(); ++i)
    if (obstacles.touches_node(i, system.dofs, system.model->nodes.canonical(node))) contacts.push_back(i);
  return contacts;
}

}  // namespace

ContactPeaks::ContactPeaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics)
    : dynamics_(dynamics) {
  if (dynamics.obstacles() == nullptr || dynamics.system().model == nullptr) return;
  std::vector<model::ProbeRequest> chosen;
  for (model::ProbeRequest request : requests) {
    const std::vector<Index> contacts = contacts_of(dynamics, request.node);
    std::erase_if(request.quantities, [&](model::Quantity quantity) {
      return source_of(quantity) != model::Source::contacts && (!is_contact_force(quantity) || contacts.empty());
    });
    if (request.quantities.empty()) continue;
    contacts_.insert(contacts_.end(), contacts.begin(), contacts.end());
    chosen.push_back(std::move(request));
  }
  if (chosen.empty()) return;
  probes_ = std::make_unique<Probes>(chosen, dynamics);
  values_.resize(probes_->columns().size());
  largest_.assign(values_.size(), 0.0);
  last_.resize(values_.size());
}

void ContactPeaks::start(const time::State& state) {
  if (!probes_) return;
  probes_->evaluate(state, values_);
  for (std::size_t i = 0; i < values_.size(); ++i) largest_[i] = std::abs(values_[i]);
}

bool ContactPeaks::is_active() const {
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  if (obstacles.is_live()) return true;
  return std::any_of(contacts_.begin(), contacts_.end(), [&](Index i) {
    return obstacles.phase(i).normal != dynamics::ContactPhase::Normal::apart || obstacles.group_of(i).shape == nullptr;
  });
}

void ContactPeaks::step(const time::AcceptedStep& step) {
  if (!probes_ || !is_active()) return;
  const std::span<const double> breakpoints = step.motion.breakpoints();
  const int samples = step.motion.interpolation() == time::Interpolation::near_quintic ? kSamplesOfQuintic : kSamples;
  samples_ = 0;
  look(step, step.from.t);
  double begin = step.from.t;
  for (std::size_t piece = 0; piece <= breakpoints.size(); ++piece) {
    const double end = piece < breakpoints.size() ? breakpoints[piece] : step.to.t, length = end - begin;
    const auto look_near_end = [&](double part) {
      const double t = part > 0.0 ? begin + part * length : end + part * length;
      if (t > begin && t < end) look(step, t);
    };
    const bool may_jump = dynamics_.obstacles()->is_live();
    if (may_jump) look_near_end(kBeside);
    look_near_end(kNearEnd);
    for (int k = 1; k < samples; ++k) look(step, begin + length * k / samples);
    look_near_end(-kNearEnd);
    if (may_jump) look_near_end(-kBeside);
    look(step, end);
    begin = end;
  }
}

void ContactPeaks::look(const time::AcceptedStep& step, double t) {
  if (t <= step.from.t)
    probes_->evaluate(step.from, values_);
  else
    probes_->evaluate(step, t, values_, Probes::View::contacts);
  now_ = values_;
  const bool has_two_before = samples_++ >= 2;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    const Sampled sample{t, std::abs(now_[i])};
    auto& [before, last] = last_[i];
    largest_[i] = std::max(largest_[i], sample.value);
    const bool is_top = has_two_before && last.value >= before.value && last.value >= sample.value && last.value > 0.0;
    if (is_top && (last.value > kNearPeak * largest_[i] || may_exceed(before, last, sample, largest_[i]))) {
      const Sampled top = local_maximum(before, last, sample, [&](double instant) {
        probes_->evaluate(step, instant, values_);
        return std::abs(values_[i]);
      });
      largest_[i] = std::max(largest_[i], top.value);
    }
    before = last;
    last = sample;
  }
}

void ContactPeaks::add_to(std::map<std::string, double>& peaks) const {
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    double& peak = peaks[probes_->columns()[i]];
    peak = std::max(peak, largest_[i]);
  }
}

}  // namespace butee::record
