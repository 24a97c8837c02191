#include "butee/dynamics/kernel/stop_response.hpp"

#include <cmath>

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

  HWY_INLINE void add(const StopForce& stop, Index begin) {
    const double* column = stop.columns.values + begin;
    for (const double force : stop.force) {
      const Register factor = hn::Set(Tag(), force);
      for (Register* sum : {&end, &speed, &middle}) {
        *sum = hn::MulAdd(hn::LoadU(Tag(), column), factor, *sum);
        column += stop.columns.rows;
      }
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
  Register largest = hn::Zero(Tag()), all = hn::Zero(Tag());
  const Register weight = hn::Set(Tag(), speed_weight);
  for (const Index chunk : chunks)
    for (Index begin = chunk; begin < chunk + kChunk; begin += kWidth) {
      Response response;
      response.add(stop, begin);
      response.add_to(motion, begin);
      const Register change =
          hn::MulAdd(weight, hn::Abs(response.speed), hn::Add(hn::Abs(response.end), hn::Abs(response.middle)));
      largest = hn::Max(largest, change);
      all = hn::Add(all, change);
    }
  // A NaN may be lost in comparisons; the sum reveals it.
  const double sum = hn::GetLane(hn::SumOfLanes(Tag(), all));
  return std::isfinite(sum) ? hn::GetLane(hn::MaxOfLanes(Tag(), largest)) : sum;
}

void add_forces(std::span<const StopForce> stops, std::span<const Index> chunks, const Motion& motion) {
  for (const Index chunk : chunks)
    for (Index begin = chunk; begin < chunk + kChunk; begin += kWidth) {
      Response response;
      for (const StopForce& stop : stops) response.add(stop, begin);
      response.add_to(motion, begin);
    }
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
