#include "integrators/exponential/collocation_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace butee::integrators {
namespace {

using time::State;

constexpr Index kCount = StepNodes::kCount;
/// Allowed interpolation error of modes in outputs between nodes, as a fraction of the tolerance.
constexpr double kOutput = 0.05;
constexpr double kMostTurn = FastModes::kMostTurn;
/// For the work of forces a step is divided into at least kPartsOfPower parts, in which modes turn by at most
/// kTurnOfPower rad. Gauss' rule with five points then integrates power, which turns twice as fast, with an error of
/// at most (5!)^4/(11 (10!)^3) (2 kTurnOfPower)^10 = 2.4e-5 of it.
constexpr double kTurnOfPower = 3.0, kPartsOfPower = 2.0;
/// The largest distance of neighbouring nodes, as a fraction of the step.
constexpr double kLongestPart = 0.24;
/// The largest number of breakpoints in a step. They are as dense as the fastest motion of the whole step requires;
/// shorter steps need fewer once it has decayed.
constexpr double kMostBreakpoints = 4096.0;
/// The factor by which the next step may be longer than this one, at most, as far as fast motion is known.
constexpr double kMostGrowth = 8.0;

}  // namespace

NodeTraces::NodeTraces(const dynamics::DampedModes& modes, const std::vector<Index>& contacts)
    : modes_(modes), contacts_(contacts), superposition_(modes) {
  const Index n = modes.displacement().cols();
  is_of_contact_.resize(static_cast<std::size_t>(n));
  superposition_.choose(contacts);
  if (superposition_.goes_by_natural_modes())
    for (const Index dof : contacts) is_of_contact_[static_cast<std::size_t>(dof)] = true;
  for (Traces* traces : {&x_, &v_}) {
    traces->found.resize(static_cast<std::size_t>(n));
    traces->at_nodes.resize(kCount, n);
  }
}

NodeTraces::Trace NodeTraces::of(Index dof, Traces& traces, const Eigen::MatrixXd& shapes, Superpose superpose,
                                 const Lanes& nodes) {
  if (traces.found[static_cast<std::size_t>(dof)]) return std::as_const(traces.at_nodes).col(dof);
  if (is_of_contact_[static_cast<std::size_t>(dof)]) {
    (superposition_.*superpose)(nodes, rows_);
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      traces.found[static_cast<std::size_t>(contacts_[i])] = true;
      traces.at_nodes.col(contacts_[i]) = lane_of<8>(rows_, static_cast<Index>(i)).head<kCount>();
    }
  } else {
    traces.found[static_cast<std::size_t>(dof)] = true;
    // Separate sums of real and imaginary parts, so that one addition need not wait for the other.
    const Index p = nodes.rows() / 2;
    const double *const re = shapes.col(dof).data(), *const im = re + p;
    Lane sum_re = Lane::Zero(), sum_im = Lane::Zero();
    for (Index k = 0; k < p; ++k) {
      sum_re += re[k] * lane_of<8>(nodes, k);
      sum_im += im[k] * lane_of<8>(nodes, p + k);
    }
    traces.at_nodes.col(dof) = (sum_re + sum_im).head<kCount>();
  }
  return std::as_const(traces.at_nodes).col(dof);
}

CollocationOutputs::CollocationOutputs(const dynamics::DampedModes& modes, const ModalLoads& loads,
                                       const std::vector<Index>& contacts, double tolerance, Index memory_begin)
    : modes_(modes),
      loads_(loads),
      tolerance_(tolerance),
      memory_begin_(memory_begin),
      fast_(modes, tolerance),
      traces_(modes, contacts),
      fast_motion_(modes, loads.harmonic()) {
  last_.z.setZero(2 * modes.count());
}

void CollocationOutputs::accept(double begin, double end, const Lanes& nodes) {
  begin_ = begin;
  end_ = end;
  nodes_ = &nodes;
  traces_.reset();
  last_.instant = std::numeric_limits<double>::quiet_NaN();
  batch_.times.clear();
  for (Breakpoints& breakpoints : breakpoints_) breakpoints.is_known = false;
  slow_.reset();
}

void CollocationOutputs::reset() {
  end_ = std::numeric_limits<double>::quiet_NaN();
}

std::optional<Index> CollocationOutputs::node_at(const State& from, const State& to, double t) const {
  if (!holds(from, to)) return std::nullopt;
  for (Index j = 0; j < kCount; ++j)
    if (t == from.t + StepNodes::kPlaces[static_cast<std::size_t>(j)] * (to.t - from.t)) return j;
  return std::nullopt;
}

void CollocationOutputs::divide_modes(const State& from, const State& to) {
  if (slow_) return;
  const Index p = modes_.count();
  const double h = to.t - from.t;
  // Slow modes are interpolated by the polynomial through the nodes, with an error of StepNodes::kMiss (|lambda| h)^7
  // of their amplitude, unless loads or contact forces are faster.
  const double allowed = kOutput * tolerance_ * least_growth(from, to),
               most = std::pow(allowed / StepNodes::kMiss, 1.0 / 7.0) / h;
  Index slow = 0;
  if (loads_.highest_frequency() <= most)
    while (slow < p && modes_.speed()[slow] <= most && is_polynomial(slow, h, modal(from), modal(to), allowed)) ++slow;
  slow_ = fast_begin_ = slow;
  while (fast_begin_ < p && modes_.speed()[fast_begin_] * h < FastMotion::kLeast) ++fast_begin_;
  if (!fast_motion_.begin(from.t, h, modal(from), modal(to) + 2 * p, fast_begin_)) fast_begin_ = p;
}

bool CollocationOutputs::is_polynomial(Index mode, double h, const double* begin, const double* end,
                                       double allowed) const {
  const Index p = modes_.count();
  const std::complex<double> lambda{modes_.decay()[mode], modes_.turn()[mode]};
  const auto at = [p, mode](const double* z) { return std::complex<double>{z[mode], z[p + mode]}; };
  // The coefficients of the Taylor series of the motion, up to that of s^7.
  std::complex<double> coefficient = at(begin);
  for (Index r = 0; r < kCount; ++r)
    coefficient = (h / static_cast<double>(r + 1)) * (lambda * coefficient + at(end + 2 * p * (r + 1)));
  const double least = StepNodes::kProduct / allowed;
  return least * least * std::norm(coefficient) <= std::max(std::norm(at(begin)), std::norm(at(end)));
}

void CollocationOutputs::move_to(const State& from, const State& to, double place, Eigen::Ref<Eigen::VectorXd> z) {
  const Index p = modes_.count();
  const double h = to.t - from.t;
  Index slow = 0;
  if (holds(from, to)) {
    divide_modes(from, to);
    slow = *slow_;
    const auto weights = StepNodes::lagrange(place);
    z.head(slow).noalias() = nodes_->topLeftCorner(slow, kCount) * weights;
    z.segment(p, slow).noalias() = nodes_->middleRows(p, slow).leftCols<kCount>() * weights;
  }
  if (slow == p) return;
  const double *const begin = modal(from), *const forces = modal(to) + 2 * p;
  const Index fast = holds(from, to) ? fast_begin_ : p;
  if (fast < p) fast_motion_.move(place, z);
  if (slow < fast) PlaceResponse(modes_, loads_.harmonic(), place, h, slow, fast).move(from.t, begin, forces, z);
}

void CollocationOutputs::find_rate(double t, double place, const double* forces,
                                   const Eigen::Ref<const Eigen::VectorXd>& z, Eigen::VectorXd& rate) const {
  const Index p = modes_.count();
  const Eigen::Map<const Eigen::MatrixXd> polynomial(forces, 2 * p, kCount);
  rate.resize(2 * p);
  rate.head(p).array() = modes_.decay() * z.head(p).array() - modes_.turn() * z.tail(p).array();
  rate.tail(p).array() = modes_.decay() * z.tail(p).array() + modes_.turn() * z.head(p).array();
  double power = 1.0;
  for (Index r = 0; r < kCount; ++r, power *= place) rate += power * polynomial.col(r);
  loads_.add_harmonic_rate(t, rate);
}

void CollocationOutputs::find(const State& from, const State& to, double t, Eigen::Ref<Eigen::VectorXd> z) {
  const double place = (t - from.t) / (to.t - from.t);
  if (const auto node = node_at(from, to, t))
    z = nodes_->col(*node);
  else if (place <= 0.0)
    z = Eigen::Map<const Eigen::VectorXd>(modal(from), z.size());
  else
    move_to(from, to, place, z);
}

void CollocationOutputs::find(const State& from, const State& to, double t, bool wants_rate) {
  const bool is_held = holds(from, to);
  if (!is_held || last_.instant != t) {
    last_.instant = is_held ? t : std::numeric_limits<double>::quiet_NaN();
    last_.has_rate = false;
    find(from, to, t, last_.z);
  }
  if (!wants_rate || last_.has_rate) return;
  last_.has_rate = true;
  find_rate(t, (t - from.t) / (to.t - from.t), modal(to) + last_.z.size(), last_.z, last_.rate);
}

void CollocationOutputs::interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                                     time::Interpolated out) {
  find(from, to, t, !out.a.empty());
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (!out.x.empty()) out.x[i] = modes_.displacement().col(dofs[i]).dot(last_.z);
    if (!out.v.empty()) out.v[i] = modes_.velocity().col(dofs[i]).dot(last_.z);
    if (!out.a.empty()) out.a[i] = modes_.velocity().col(dofs[i]).dot(last_.rate);
  }
}

void CollocationOutputs::interpolate_all(const State& from, const State& to, std::span<const double> times,
                                         std::span<const Index> dofs, time::Interpolated out) {
  const Index p = modes_.count(), count = static_cast<Index>(times.size());
  // Several observers ask for the motion at the breakpoints, one after the other.
  if (!holds(from, to) || !std::ranges::equal(batch_.times, times)) {
    batch_.times.assign(times.begin(), times.end());
    if (batch_.z.cols() < count) batch_.z.resize(2 * p, 2 * count);
    for (Index j = 0; j < count; ++j) find(from, to, times[static_cast<std::size_t>(j)], batch_.z.col(j));
  }
  if (!holds(from, to)) batch_.times.clear();
  const auto rows = static_cast<Index>(dofs.size());
  bool are_all = rows == modes_.displacement().cols();
  for (Index i = 0; i < rows && are_all; ++i) are_all = dofs[static_cast<std::size_t>(i)] == i;
  const auto fill = [&](std::span<double> values, const Eigen::MatrixXd& shapes, const auto& motion) {
    if (values.empty()) return;
    Eigen::Map<Eigen::MatrixXd> all(values.data(), rows, count);
    if (are_all) {
      all.noalias() = shapes.transpose() * motion;
      return;
    }
    for (Index i = 0; i < rows; ++i)
      all.row(i).noalias() = shapes.col(dofs[static_cast<std::size_t>(i)]).transpose() * motion;
  };
  const auto z = batch_.z.leftCols(count);
  fill(out.x, modes_.displacement(), z);
  fill(out.v, modes_.velocity(), z);
  if (out.a.empty()) return;
  const double* const forces = modal(to) + 2 * p;
  const auto place_of = [&](double t) { return (t - from.t) / (to.t - from.t); };
  if (are_all) {
    Eigen::MatrixXd rates(2 * p, count);
    for (Index j = 0; j < count; ++j) {
      const double t = times[static_cast<std::size_t>(j)];
      find_rate(t, place_of(t), forces, z.col(j), last_.rate);
      rates.col(j) = last_.rate;
    }
    last_.instant = std::numeric_limits<double>::quiet_NaN();
    return fill(out.a, modes_.velocity(), rates);
  }
  const std::size_t loads = loads_.harmonic().size();
  phases_.clear();
  for (const double t : times)
    for (const HarmonicLoad& load : loads_.harmonic())
      phases_.push_back({std::cos(load.angular_frequency * t), std::sin(load.angular_frequency * t)});
  for (Index i = 0; i < rows; ++i) {
    const DofAcceleration acceleration(modes_, loads_, dofs[static_cast<std::size_t>(i)], forces);
    for (std::size_t j = 0; j < times.size(); ++j)
      out.a[j * dofs.size() + static_cast<std::size_t>(i)] = acceleration.at(
          place_of(times[j]), batch_.z.col(static_cast<Index>(j)), std::span(phases_).subspan(j * loads, loads));
  }
}

void CollocationOutputs::trace(const State& from, const State& to, double t, std::span<const Index> dofs,
                               time::Interpolated out) {
  if (!holds(from, to) || !out.a.empty()) return interpolate(from, to, t, dofs, out);
  const double h = to.t - from.t, place = (t - from.t) / h;
  const auto [values, begin_slope, end_slope] = StepNodes::hermite(place);
  const auto at = [&](const auto& of_nodes, double begin, double end) {
    return values.dot(of_nodes) + h * (begin_slope * begin + end_slope * end);
  };
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Index dof = dofs[i];
    if (!out.x.empty()) out.x[i] = at(traces_.displacement(dof, *nodes_), from.v[dof], to.v[dof]);
    if (!out.v.empty()) out.v[i] = at(traces_.velocity(dof, *nodes_), from.a[dof], to.a[dof]);
  }
}

Eigen::ArrayXd CollocationOutputs::free_amplitudes(const State& from, const State& to) {
  const Index p = modes_.count();
  Eigen::ArrayXd amplitudes = Eigen::ArrayXd::Zero(p);
  if (holds(from, to)) {
    divide_modes(from, to);
    if (fast_begin_ < p) {
      amplitudes.tail(p - fast_begin_) =
          fast_motion_.amplitudes() * ((to.t - from.t) * modes_.decay().tail(p - fast_begin_)).max(0.0).exp();
      return amplitudes;
    }
  }
  // |dz/dt|/|lambda| is the amplitude of a mode's rotation about its quasi-static response.
  Eigen::VectorXd rate;
  for (const double place : {0.0, 1.0}) {
    const State& at = place > 0.0 ? to : from;
    find_rate(at.t, place, modal(to) + 2 * p, Eigen::Map<const Eigen::VectorXd>(modal(at), 2 * p), rate);
    amplitudes = amplitudes.max((rate.head(p).array().square() + rate.tail(p).array().square()).sqrt());
  }
  // Rigid motion does not turn.
  return (modes_.speed() > 0.0).select(amplitudes / modes_.speed(), 0.0);
}

CollocationOutputs::Longest CollocationOutputs::longest(const State& from, const State& to) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  const double h = to.t - from.t, turns = kMostBreakpoints * kMostTurn, slow = turns / (kMostGrowth * h);
  if (std::max(fast_.highest(), loads_.highest_frequency()) <= slow) return {kUnlimited, kUnlimited};
  const Eigen::ArrayXd here = free_amplitudes(from, to), next = here * (h * modes_.decay()).min(0.0).exp();
  const auto longest_for = [&](const Eigen::ArrayXd& amplitudes) {
    const double fastest = fast_.find(from, to, slow, amplitudes, time::Detail::accelerations);
    return turns / std::max(loads_.highest_frequency(), fastest);
  };
  return {longest_for(here), longest_for(next)};
}

std::span<const double> CollocationOutputs::breakpoints(const State& from, const State& to, time::Detail detail) {
  auto& [is_known, all] = breakpoints_[static_cast<std::size_t>(detail)];
  if (holds(from, to) && is_known) return all;
  is_known = holds(from, to);
  const bool for_power = detail == time::Detail::power;
  const double h = to.t - from.t, slow = for_power ? kTurnOfPower * kPartsOfPower / h : kMostTurn / (kLongestPart * h);
  double fastest = std::max(slow, loads_.highest_frequency());
  if (fast_.highest() > fastest) fastest = fast_.find(from, to, fastest, free_amplitudes(from, to), detail);
  if (for_power) {
    const int parts = static_cast<int>(std::ceil(fastest * h / kTurnOfPower));
    all.clear();
    for (int i = 1; i < parts; ++i) all.push_back(from.t + h * i / parts);
    return all;
  }
  const int parts = static_cast<int>(std::ceil(fastest / slow));
  all.clear();
  for (std::size_t j = 0; j + 1 < StepNodes::kPlaces.size(); ++j) {
    const double begin = from.t + StepNodes::kPlaces[j] * h, end = from.t + StepNodes::kPlaces[j + 1] * h;
    if (j > 0) all.push_back(begin);
    for (int i = 1; i < parts; ++i) all.push_back(begin + (end - begin) * i / parts);
  }
  return all;
}

}  // namespace butee::integrators
