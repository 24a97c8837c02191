// Of ExponentialStep: what open stops of a regularised law pull.
#include <cmath>

#include "integrators/exponential_step.hpp"

namespace butee::integrators {

using Eigen::ArrayXd;
using solve::StepFlow;

bool ExponentialStep::is_steady(StepFlow& flow, Index stop) const {
  const FarPull& pull = pulls_[static_cast<std::size_t>(stop)];
  const double mobility = std::abs(derived(flow, stop).coupling[0][0]);
  return pull.unfelt(w_[stop], w_new_[stop], reach_[stop], mobility, steps_of(scale_, flow.h())) <=
         kUnfeltPull * output_tolerance_ * scale_.displacement;
}

void ExponentialStep::add_far_forces(StepFlow& flow) {
  if (far_.empty()) return;
  const double h = flow.h(), steps = steps_of(scale_, h), felt = kUnfeltPull * output_tolerance_ * scale_.displacement;
  jumping_.clear();
  force_[0].setZero();
  for (const Index i : far_) {
    const auto place = static_cast<std::size_t>(i);
    const StopPath path(w_[i], h * wv_[i], w_new_[i], h * wv_new_[i], 0.0);
    const ForceMoments pull = stops_[place].far_force(path);
    force_[0][i] = pull[0];
    if (pull[1] == 0.0 || pulls_[place].largest() * std::abs(derived(flow, i).coupling[0][0]) * steps <= felt) continue;
    if (jumping_.empty()) force_[1].setZero(), force_[2].setZero();
    force_[1][i] = pull[1];
    force_[2][i] = pull[2];
    jumping_.push_back(i);
  }
  add_moments(flow, far_, 0);
  for (int k = 1; k < (jumping_.empty() ? 0 : 3); ++k) add_moments(flow, jumping_, k);
  if (!reachable_.empty()) q_half_ += sums_[0] * flow.half.force_q(0);
  find_stops();
}

void ExponentialStep::add_moments(const StepFlow& flow, const std::vector<Index>& stops, int k) {
  ArrayXd& sum = sums_[static_cast<std::size_t>(k)];
  modal_.stop_shapes().force(stops, force_[static_cast<std::size_t>(k)].data(), sum.data());
  q_new_ += sum * flow.whole.force_q(k);
  v_new_ += sum * flow.whole.force_v(k);
}

}  // namespace butee::integrators
