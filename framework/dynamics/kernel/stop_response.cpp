#include "butee/dynamics/kernel/stop_response.hpp"

#include <algorithm>

#include "butee/linalg/kernel/dense.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/dynamics/kernel/stop_response.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::dynamics::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using linalg::kernel::kChunk;
using Tag = hn::CappedTag<double, kChunk>;
using Register = hn::Vec<Tag>;
constexpr Index kWidth = hn::MaxLanes(Tag());

/// End, speed and middle for the stops of one register.
struct Response {
  Register end, speed, middle;

  HWY_INLINE Response() : end(hn::Zero(Tag())), speed(end), middle(end) {}

  /// Adds the response to moment k of a force.
  HWY_INLINE void add(const StopForce& stop, std::size_t k, Index begin) {
    const double* column = stop.columns.values + static_cast<Index>(3 * k) * stop.columns.rows + begin;
    const Register factor = hn::Set(Tag(), stop.force[k]);
    for (Register* sum : {&end, &speed, &middle}) {
      *sum = hn::MulAdd(hn::LoadU(Tag(), column), factor, *sum);
      column += stop.columns.rows;
    }
  }

  HWY_INLINE void add_to(const Motion& motion, Index begin) const {
    add_to(motion.end + begin, end);
    add_to(motion.speed + begin, speed);
    add_to(motion.middle + begin, middle);
  }

 private:
  static HWY_INLINE void add_to(double* to, Register sum) { hn::StoreU(hn::Add(hn::LoadU(Tag(), to), sum), Tag(), to); }
};

double add_force(const StopForce& stop, double speed_weight, std::span<const Index> chunks, const Motion& motion) {
  Register largest = hn::Zero(Tag());
  const Register weight = hn::Set(Tag(), speed_weight);
  for (const Index chunk : chunks)
    for (Index begin = chunk; begin < chunk + kChunk; begin += kWidth) {
      Response response;
      for (std::size_t k = 0; k < 3; ++k) response.add(stop, k, begin);
      response.add_to(motion, begin);
      const Register change =
          hn::MulAdd(weight, hn::Abs(response.speed), hn::Add(hn::Abs(response.end), hn::Abs(response.middle)));
      largest = hn::Max(largest, change);
    }
  // A NaN may be lost in comparisons; the force reveals it.
  return hn::GetLane(hn::MaxOfLanes(Tag(), largest)) + 0.0 * (stop.force[0] + stop.force[1] + stop.force[2]);
}

/// Adds the responses to the first moments of the forces.
template <std::size_t kMoments>
void add_moments(std::span<const StopForce> stops, std::span<const Index> chunks, const Motion& motion) {
  for (const Index chunk : chunks)
    for (Index begin = chunk; begin < chunk + kChunk; begin += kWidth) {
      // Separate sums, so that no addition waits for the one before.
      Response responses[kMoments];
      for (const StopForce& stop : stops)
        for (std::size_t k = 0; k < kMoments; ++k) responses[k].add(stop, k, begin);
      for (const Response& response : responses) response.add_to(motion, begin);
    }
}

void add_forces(std::span<const StopForce> stops, std::span<const Index> chunks, const Motion& motion) {
  const bool is_ramp =
      std::all_of(stops.begin(), stops.end(), [](const StopForce& stop) { return stop.force[2] == 0.0; });
  if (is_ramp)
    add_moments<2>(stops, chunks, motion);
  else
    add_moments<3>(stops, chunks, motion);
}

}  // namespace

const StopResponse* stop_response_kernels() {
  static constexpr StopResponse kKernels = {&add_force, &add_forces};
  return &kKernels;
}

}  // namespace butee::dynamics::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::dynamics::kernel {

BUTEE_KERNELS(stop_response_kernels);

const StopResponse& stop_response() {
  return *BUTEE_KERNEL(stop_response_kernels)();
}

}  // namespace butee::dynamics::kernel
#endif
