#include "butee/record/contact_peaks.hpp"

#include <algorithm>

namespace butee::record {
namespace {

/// A sample below this fraction of the peak is not adjacent to a larger maximum, with eight samples
/// in a step.
constexpr double kNearPeak = 0.9;

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
      return source_of(quantity) != model::Source::contacts &&
             (quantity != model::Quantity::contact_force || contacts.empty());
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
  double begin = step.from.t;
  for (const double breakpoint : step.motion.breakpoints()) {
    follow_piece(step, begin, breakpoint);
    begin = breakpoint;
  }
  follow_piece(step, begin, step.to.t);
}

void ContactPeaks::follow_piece(const time::AcceptedStep& step, double begin, double end) {
  const std::size_t count = values_.size();
  for (int k = 0; k <= kSamples; ++k) {
    const double t = k == kSamples ? end : begin + (end - begin) * k / kSamples;
    if (t <= step.from.t)
      probes_->evaluate(step.from, values_);
    else
      probes_->evaluate(step, t, values_, Probes::View::contacts);
    now_ = values_;
    for (std::size_t i = 0; i < count; ++i) {
      const Sampled sample{t, std::abs(now_[i])};
      auto& [before, last] = last_[i];
      largest_[i] = std::max(largest_[i], sample.value);
      const bool is_top = k >= 2 && last.value >= before.value && last.value >= sample.value && last.value > 0.0;
      if (is_top && last.value > kNearPeak * largest_[i]) {
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
}

void ContactPeaks::add_to(std::map<std::string, double>& peaks) const {
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    double& peak = peaks[probes_->columns()[i]];
    peak = std::max(peak, largest_[i]);
  }
}

}  // namespace butee::record
