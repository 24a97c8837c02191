// Of ExponentialStep: what open stops of a regularised law pull.
#include <algorithm>
#include <cmath>

#include "integrators/exponential_step.hpp"

namespace butee::integrators {

using dynamics::StepFlow;
using Eigen::ArrayXd;

bool ExponentialStep::is_steady(StepFlow& flow, Index stop) const {
  const FarPull& pull = pulls_[static_cast<std::size_t>(stop)];
  const double mobility = std::abs(flow.mobilities()[stop]);
  return pull.unfelt(w_[stop], w_new_[stop], reach_[stop], mobility, steps_of(reached_, flow.h())) <= felt(flow.h());
}

void ExponentialStep::find_steady(StepFlow& flow) {
  const Index m = modal_.stop_count();
  const auto shift = pull_sizes_.head(m) * flow.mobilities().abs();
  largest_shift_ = shift.maxCoeff();
  largest_felt_shift_ = (shift / shares_.head(m)).maxCoeff();
  // What is at rest and free is soon as fast as the pull makes it.
  reached_.speed = std::max(reached_.speed, 2.0 * largest_shift_ / flow.h());
  const double steps = steps_of(reached_, flow.h()), most = felt(flow.h());
  const auto w0 = w_.head(m), w1 = w_new_.head(m);
  const auto part = bends_.head(m) / (gaps_.head(m) - reach_.head(m));
  is_steady_.head(m) =
      w0 * w1 > 0.0 && w0.abs().min(w1.abs()) > shift && shift * part.square() * (steps * steps / 3.0) <= most;
}

double ExponentialStep::error_of_pull(StepFlow& flow, Index stop) const {
  const double bulge = std::abs(bulge_[stop]), on_the_way = std::abs(path_.end[stop] - w_[stop]);
  if (bulge == 0.0) return 0.0;
  const double part = bulge < on_the_way ? bulge / on_the_way : 1.0;
  return 2.0 * part * pulls_[static_cast<std::size_t>(stop)].largest() * std::abs(flow.mobilities()[stop]) *
         steps_of(reached_, flow.h());
}

bool ExponentialStep::place_pull(StepFlow& flow) {
  const Index m = modal_.stop_count();
  const double steps = steps_of(reached_, flow.h()), most = felt(flow.h());
  // Not even if every stop pulled to the other side.
  if (2.0 * largest_felt_shift_ * steps * steps <= most) return false;
  excess_ = 0.5 * (w_ + w_new_);
  contact_.force(excess_.head(m).matrix(), stop_forces_);
  for (const Index i : reachable_) stop_forces_[i] = 0.0;
  const auto moves = (stop_forces_ - pull_).array().abs() * flow.mobilities().abs() / shares_.head(m);
  if (moves.maxCoeff() * steps * steps <= most) return false;
  pull_.swap(stop_forces_);
  sums_[0] = pull_sum_;
  modal_.stop_shapes().force(far_, pull_.data(), pull_sum_.data());
  q_new_ += (pull_sum_ - sums_[0]) * flow.whole.force_q(0);
  v_new_ += (pull_sum_ - sums_[0]) * flow.whole.force_v(0);
  find_stops();
  return true;
}

void ExponentialStep::add_jumps(StepFlow& flow) {
  const double h = flow.h(), steps = steps_of(reached_, h), most = felt(h);
  jumping_.clear();
  jumps_.clear();
  if (largest_shift_ * steps <= most) return;
  for (const Index i : far_) {
    const double aside = kBump * h * (std::abs(wv_[i]) + std::abs(wv_new_[i]));
    if (std::min(w_[i], w_new_[i]) > aside || std::max(w_[i], w_new_[i]) < -aside) continue;
    const auto place = static_cast<std::size_t>(i);
    if (pulls_[place].largest() * std::abs(flow.mobilities()[i]) * steps <= most) continue;
    if (jumping_.empty())
      for (ArrayXd& force : force_) force.setZero();
    const ForceMoments pull = stops_[place].far_force({w_[i], h * wv_[i], w_new_[i], h * wv_new_[i], 0.0});
    for (std::size_t k = 0; k < 3; ++k) force_[k][i] = pull[k] - (k == 0 ? pull_[i] : 0.0);
    jumping_.push_back(i);
    jumps_.push_back(pull);
  }
  if (jumping_.empty()) return;
  for (int k = 0; k < 3; ++k) {
    add_moments(flow, jumping_, k);
    jump_sums_[static_cast<std::size_t>(k)] = sums_[static_cast<std::size_t>(k)];
  }
  find_stops();
}

void ExponentialStep::add_moments(const StepFlow& flow, const std::vector<Index>& stops, int k) {
  ArrayXd& sum = sums_[static_cast<std::size_t>(k)];
  modal_.stop_shapes().force(stops, force_[static_cast<std::size_t>(k)].data(), sum.data());
  q_new_ += sum * flow.whole.force_q(k);
  v_new_ += sum * flow.whole.force_v(k);
  if (!reachable_.empty() || middle_knot_ > 0.0) add_to_half(flow.half, static_cast<std::size_t>(k));
}

void ExponentialStep::add_to_half(const dynamics::ModalFlow& half, std::size_t k) {
  const ArrayXd& sum = sums_[k];
  const auto add = [&](ArrayXd& to, const auto& by) {
    // P_k of the step, written in those of its first half.
    if (k == 0) to += sum * by(0);
    if (k == 1) to += 0.5 * sum * (by(1) - by(0));
    if (k == 2) to += sum * (0.25 * by(2) - 0.75 * by(1));
  };
  add(q_half_, [&](int j) { return half.force_q(j); });
  if (middle_knot_ > 0.0) add(v_half_, [&](int j) { return half.force_v(j); });
}

}  // namespace butee::integrators
