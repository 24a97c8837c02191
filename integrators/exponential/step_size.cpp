#include "integrators/exponential/step_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {
namespace {

/// Number of indices by which a longer step without contact is reduced if a stop comes near its
/// gap.
constexpr int kIndicesToStop = 3;

/// The highest index whose step does not exceed `time`, s.
int index_below(double time) {
  if (!(time > 0.0)) return std::numeric_limits<int>::min();
  return time < 1e30 ? static_cast<int>(std::floor(2.0 * std::log2(time))) : std::numeric_limits<int>::max();
}

/// The lowest index whose step is not shorter than `time`, s.
int index_above(double time) {
  return static_cast<int>(std::ceil(2.0 * std::log2(time)));
}

/// Number of indices by which the step is reduced if the error is `ratio` times its bound; the
/// error falls with the fifth power of h.
int indices_down(double ratio) {
  constexpr double kPower = 5.0, kMost = 8.0;
  return ratio > 1.0 ? static_cast<int>(std::clamp(std::floor(2.0 / kPower * std::log2(ratio)), 1.0, kMost)) : 1;
}

}  // namespace

int StepSizeControl::indices_up(double part) {
  constexpr double kAim = 0.4, kMost = 8.0;
  if (part <= 0.0) return static_cast<int>(kMost);
  return static_cast<int>(std::clamp(std::floor(std::log2(kAim / part) / 3.0), 0.0, kMost));
}

int StepSizeControl::next_index(double time_to_contact) const {
  return std::clamp(index_below(time_to_contact), index_, next_index());
}

void StepSizeControl::accept(const Outcome& outcome, bool on_grid) {
  is_contact_free_ = outcome.is_contact_free;
  if (!is_contact_free_) {
    longer_ = kLonger;
    if (on_grid && outcome.contact.is_below_growth_limit()) ++index_;
  } else if (on_grid) {
    longer_ += indices_up(outcome.interpolation_error);
  }
}

StepSizeControl::Retry StepSizeControl::reject(const Outcome& outcome, int index, bool on_grid, double h) {
  if (outcome.is_contact_free) {
    const int shorter = (on_grid ? index : index_above(h)) - 1;
    longer_ = shorter - index_;
    return {shorter, false};
  }
  if (on_grid && index > index_) return {std::max(index_, index - kIndicesToStop), false};
  const int shorter = (on_grid ? index : index_above(h)) - indices_down(outcome.contact.ratio());
  index_ = std::min(index_, shorter);
  return {shorter, true};
}

void StepSizeControl::load(const Memory& memory) {
  index_ = static_cast<int>(memory.index);
  is_contact_free_ = memory.is_contact_free != 0.0;
  longer_ = static_cast<int>(memory.longer);
}

}  // namespace butee::integrators
