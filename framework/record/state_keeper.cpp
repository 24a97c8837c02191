#include "butee/record/state_keeper.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <numeric>

#include "butee/core/error.hpp"
#include "butee/record/file.hpp"
#include "butee/time/contact_events.hpp"

namespace butee::record {

StateKeeper::StateKeeper(std::vector<double> times, dynamics::Dynamics& dynamics)
    : dynamics_(dynamics),
      times_(std::move(times)),
      all_(times_.empty() ? 0 : static_cast<std::size_t>(dynamics.size())) {
  std::iota(all_.begin(), all_.end(), Index{0});
}

model::SavedMotion StateKeeper::motion_at(const time::State& state) const {
  return {state.t, state.x, state.v, time::contact_memory(dynamics_, state)};
}

void StateKeeper::start(const time::State& state) {
  kept_.clear();
  if (!times_.empty() && times_.front() == state.t) kept_.push_back(motion_at(state));
}

void StateKeeper::step(const time::AcceptedStep& step) {
  for (; kept_.size() < times_.size() && times_[kept_.size()] <= step.to.t;) {
    const double t = times_[kept_.size()];
    time::State state = t < step.to.t ? step.from : step.to;
    if (t < step.to.t) {
      // Contacts change at the ends of steps only.
      step.motion.interpolate(t, all_, {{state.x.data(), all_.size()}, {state.v.data(), all_.size()}, {}});
      state.t = t;
    }
    kept_.push_back(motion_at(state));
  }
}

double StateKeeper::next_instant(double t) const {
  const auto next = std::upper_bound(times_.begin(), times_.end(), t);
  return next == times_.end() ? std::numeric_limits<double>::infinity() : *next;
}

void StateKeeper::save(ByteWriter& to) const {
  to.put(static_cast<std::uint64_t>(kept_.size()));
  for (const model::SavedMotion& motion : kept_) {
    to.put(motion.t);
    to.put(motion.x);
    to.put(motion.v);
    to.put(motion.contact);
  }
}

void StateKeeper::restore(ByteReader& from) {
  kept_.resize(from.count(sizeof(double)));
  for (model::SavedMotion& motion : kept_) {
    from.take(motion.t);
    from.take(motion.x);
    from.take(motion.v);
    from.take(motion.contact);
  }
}

void StateKeeper::write(const std::string& path, const time::State& last) const {
  const model::System& system = dynamics_.system();
  require(system.model != nullptr, "states of an assembled model");
  model::SavedMotions saved(system.model->nodes, system.dofs);
  saved.in_space = model::moves_apart(system.model->bases);
  saved.has_base = !system.model->bases.empty();
  saved.contacts = model::contact_names(*system.model, system.dofs);
  saved.motions = kept_;
  if (saved.motions.empty() || saved.motions.back().t < last.t) saved.motions.push_back(motion_at(last));
  // Other scenes start from motion relative to the base.
  for (model::SavedMotion& motion : saved.motions) {
    motion.x -= motion_with_base(*system.model, system.dofs, 0, motion.t);
    motion.v -= motion_with_base(*system.model, system.dofs, 1, motion.t);
  }
  const std::vector<std::byte> bytes = to_bytes(saved);
  File file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.write(bytes) < bytes.size() || !file.close())
    throw RunError(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace butee::record
