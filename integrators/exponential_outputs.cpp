// Of ExponentialStep: what outputs within and at the ends of a step take.
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/exponential_step.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {
namespace {

using dynamics::StepFlow;
using Eigen::ArrayXd;

/// A step between outputs is rounded to so many bits of the time, so that equal intervals are equal: the last three.
constexpr int kSameBits = 50;
constexpr double kForever = std::numeric_limits<double>::infinity();

double rounded(double h, double t_end) {
  const double unit = std::ldexp(1.0, std::ilogb(t_end) - kSameBits);
  return h > unit ? std::round(h / unit) * unit : h;
}

}  // namespace

Trial ExponentialStep::attempt_until(double t) {
  const double h = t - knots_.last();
  return attempt(modal_.odd(has_stops() ? h : rounded(h, t)), t);
}

double ExponentialStep::time_to_stop() const {
  double time = kForever;
  for (Index i = 0; i < static_cast<Index>(stops_.size()); ++i) {
    if (wv_[i] > 0.0 && off_upper_[i] == 0.0) time = std::min(time, (borders_[i] - w_[i]) / wv_[i]);
    if (wv_[i] < 0.0 && off_lower_[i] == 0.0) time = std::min(time, (borders_[i] + w_[i]) / -wv_[i]);
  }
  return time;
}

bool ExponentialStep::is_smooth(const StepFlow& flow) {
  const double square = flow.h() * flow.h() * kQuintic;
  const double allowed = output_tolerance_ * reached_.displacement;
  const double bound =
      load_swing_ + ((flow.swing_q * q_.abs() + flow.swing_v * v_.abs()) * (square * squares_).min(1.0)).sum();
  unsmooth_ = bound > 0.0 ? bound / allowed : 0.0;
  if (unsmooth_ <= 1.0 && !is_strongly_damped_) return true;
  propagate(flow.half, knots_.steps(), 0.5 * (knots_.last() + end_), q_half_, &v_half_);
  modal_.stop_shapes().displacement(q_half_.data(), v_half_.data(), path_.middle.data(), path_.speed.data());
  const double h = flow.h(), t = knots_.last();
  find_accelerations(t, q_, v_, a_);
  find_accelerations(t + h, q_new_, v_new_, excess_);
  const Index m = modal_.stop_count();
  const double of_middle =
      (path_.middle - 0.5 * (w_ + w_new_) - (5.0 / 32.0 * h) * (wv_ - wv_new_) - (h * h / 64.0) * (a_ + excess_))
          .head(m)
          .abs()
          .maxCoeff();
  const double of_speed =
      (h * path_.speed - 1.875 * (w_new_ - w_) + (0.4375 * h) * (wv_ + wv_new_) - (h * h / 32.0) * (excess_ - a_))
          .head(m)
          .abs()
          .maxCoeff();
  const double miss = std::max(of_middle, kOddPart * of_speed);
  unsmooth_ = miss > 0.0 ? miss / allowed : 0.0;
  if (unsmooth_ > 1.0) {
    middle_knot_ = t + 0.5 * h;
    unsmooth_ /= kHalved;
  }
  return unsmooth_ <= 1.0;
}

void ExponentialStep::find_accelerations(double t, const ArrayXd& q, const ArrayXd& v, ArrayXd& a) {
  sums_[0] = -squares_ * q - 2.0 * modal_.decay() * v;
  modal_.add_load(t, sums_[0]);
  if (has_far_forces_) sums_[0] += pull_sum_;
  modal_.stop_shapes().displacement(sums_[0].data(), a.data());
}

void ExponentialStep::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  return knots_.interpolate(times, dofs, out);
}

std::span<const time::EnergyAt> ExponentialStep::energies(std::span<const double> instants) {
  if (!has_stops()) return {};
  const auto at = [&](std::size_t knot) {
    return ModalEnergy::Knot{knots_.time(knot), knots_.q(knot), knots_.v(knot), knots_.phases(knot)};
  };
  energy_.begin(at(0), instants);
  for (std::size_t knot = 1; knot <= knots_.steps(); ++knot) {
    // Flights are as long as quintics allow, and the cubics of the energies need half of that.
    if (knots_.forces(knot - 1).touched.empty()) {
      const ModalKnots::Modes middle = knots_.middle_of(knot - 1);
      modal_.stop_shapes().displacement(middle.q, excess_.data());
      energy_.go_on({middle.t, middle.q, middle.v, middle.phases}, excess_.data(), false);
    }
    energy_.go_on(at(knot), knots_.w(knot), knot == knots_.steps());
  }
  return energy_.told();
}

// Without contact the energy of a mode grows by the work of its load alone: sqrt(v^2 + omega^2 q^2) by less than the
// integral of |f|. Higher derivatives follow from q'' = f - omega^2 q - 2 delta q'.
void ExponentialStep::find_bounds_from(std::size_t knot) {
  if (modal_bounds_.knot == knot) return;
  modal_bounds_.knot = knot;
  const double t = knots_.time(knot), h = knots_.time(knot + 1) - t;
  std::array<ArrayXd, 5> load;  // of f and its derivatives
  for (ArrayXd& bound : load) bound.setZero(modal_.size());
  for (const dynamics::ModalHarmonic& harmonic : modal_.harmonics()) {
    double factor = 1.0;
    for (ArrayXd& bound : load) {
      bound += factor * (harmonic.cosine.square() + harmonic.sine.square()).sqrt();
      factor *= harmonic.angular_frequency;
    }
  }
  for (const dynamics::ModalSystem::OtherLoad& other : modal_.other_loads()) {
    // Of the parabola through three values.
    const double f0 = other.in_time->value(t), f1 = other.in_time->value(t + 0.5 * h), f2 = other.in_time->value(t + h);
    const double bend = 4.0 * std::abs(f0 - 2.0 * f1 + f2);
    load[0] += (std::max({std::abs(f0), std::abs(f1), std::abs(f2)}) + 0.125 * bend) * other.shape.abs();
    load[1] += (std::abs(f2 - f0) + bend) / h * other.shape.abs();
    load[2] += bend / (h * h) * other.shape.abs();
  }
  const ArrayXd& omega = modal_.frequencies();
  const ArrayXd decay = 2.0 * modal_.decay();
  const Eigen::Map<const ArrayXd> q(knots_.q(knot), modal_.size()), v(knots_.v(knot), modal_.size());
  auto& of = modal_bounds_.of;
  of[1] = (v.square() + squares_ * q.square()).sqrt() + h * load[0];
  of[0] = (omega * h > 1.0).select(of[1] / omega, q.abs() + h * of[1]);
  of[2] = load[0] + omega * (omega * of[0]).min(of[1]) + decay * of[1];
  for (std::size_t k = 3; k < of.size(); ++k) of[k] = load[k - 2] + squares_ * of[k - 2] + decay * of[k - 1];
}

void ExponentialStep::departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
  find_bounds_from(knots_.before(begin));
  const double h = end - begin;
  const QuinticError error = quintic_error(h, 1.0);
  const auto& of = modal_bounds_.of;
  // A quintic is within what the sums of its Hermite functions and their derivatives make of the motion at both ends,
  // and so is what it departs from the motion by, of whatever length.
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto shape = modal_.shape_rows().col(dofs[i]).array().abs();
    if (!out.x.empty())
      out.x[i] = (shape * (error.x * of[6]).min(2.0 * of[0] + 0.4 * h * of[1] + 0.035 * h * h * of[2])).sum();
    if (!out.v.empty()) out.v[i] = (shape * (error.v * of[6]).min(5.0 * of[1] + 0.3 * h * of[2])).sum();
    if (!out.a.empty()) out.a[i] = (shape * (error.a * of[6]).min(18.0 / h * of[1] + 3.0 * of[2])).sum();
  }
}

}  // namespace butee::integrators
