#include "butee/record/energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "butee/core/quadrature.hpp"
#include "butee/dynamics/external_forces.hpp"

namespace butee::record {
namespace {

/// The estimated error of the work by the coarser rule in a piece (Interpolation::other), relative to the largest
/// energy.
constexpr double kGoodWork = 1e-12;
constexpr int kMostHalvingsOfWork = 12;
/// The same for what a fast decay at the start of a step may hide, and the halvings that resolve any decay.
constexpr double kGoodLayer = 1e-8;
constexpr int kMostHalvingsOfLayer = 48;

Energy energy_of(const time::State& state, dynamics::Dynamics& dynamics, const model::BaseEnergy& base) {
  Vector force(dynamics.size());
  Energy energy;
  dynamics.inertia_force(state.v, force);
  energy.kinetic = 0.5 * state.v.dot(force);
  dynamics.elastic_force(state.x, force);
  energy.strain = 0.5 * state.x.dot(force);
  if (dynamics.stop_count() > 0) {
    Vector w(dynamics.stop_count());
    dynamics.stops().displacement(state.x, w);
    energy.contact = dynamics.stops().energy(w);
  }
  if (dynamics.obstacles() != nullptr) {
    energy.in_obstacles = dynamics.obstacles()->energy(state.t, state.x, state.v);
    energy.contact += energy.in_obstacles;
  }
  const model::BaseEnergy::Parts of_base = base.at(state.t, state.x, state.v);
  energy.kinetic += of_base.kinetic;
  energy.strain += of_base.strain;
  energy.of_supports = of_base.kinetic + of_base.strain;
  return energy;
}

}  // namespace

Energy energy_of(const time::State& state, dynamics::Dynamics& dynamics) {
  return energy_of(state, dynamics, model::BaseEnergy(dynamics.system()));
}

EnergyRecorder::EnergyRecorder(dynamics::Dynamics& dynamics, CsvWriter* writer, std::optional<OutputTimes> times)
    : dynamics_(dynamics),
      all_(static_cast<std::size_t>(dynamics.size())),
      base_(dynamics.system()),
      has_drive_(!dynamics.system().stiffness_is_symmetric || dynamics.system().rotation != nullptr),
      needs_x_(has_drive_ || dynamics.obstacles() != nullptr || !base_.is_empty()),
      middle_(dynamics.size()),
      middle_x_(needs_x_ ? dynamics.size() : 0),
      force_(middle_),
      writer_(writer),
      times_(times) {
  std::iota(all_.begin(), all_.end(), Index{0});
}

EnergyRecorder::Power EnergyRecorder::power(double t, const Vector& x, const Vector& v) {
  Power power{};
  dynamics_.external_force(t, force_);
  power.of_loads = v.dot(force_);
  if (dynamics_.has_damping()) {
    dynamics_.damping_force(v, force_);
    power.of_damping = v.dot(force_);
  }
  if (has_drive_) {
    // The work of the skew part of K, (K - K^T)/2, that is of the drive of turning parts and of
    // cross terms of bearings.
    dynamics_.elastic_force(x, force_);
    const double forward = v.dot(force_);
    dynamics_.elastic_force(v, force_);
    power.of_loads -= 0.5 * (forward - x.dot(force_));
  }
  if (!base_.is_empty()) {
    const double damping = base_.at(t, x, v).damping;
    power.of_damping += damping;
    power.of_loads += damping;
  }
  if (dynamics_.obstacles() != nullptr) {
    dynamics_.contact_forces(t, x, v, contacts_);
    for (const dynamics::ContactForces& now : contacts_) {
      power.of_contacts += now.normal * now.rate + now.friction * now.slip_speed;
      power.of_loads += now.friction * now.surface;  // power of the drive that turns the body or moves the surface
    }
  }
  return power;
}

void EnergyRecorder::start(const time::State& state) {
  now_ = energy_of(state, dynamics_, base_);
  first_total_ = now_.total();
  largest_ = now_.size();
  first_stored_ = now_.in_obstacles;
  first_of_supports_ = now_.of_supports;
  work_ = dissipated_ = into_obstacles_ = 0.0;
  last_ = power(state.t, state.x, state.v);
}

void EnergyRecorder::find_due(const time::AcceptedStep& step) {
  due_.clear();
  if ((writer_ == nullptr && other_ == nullptr) || !times_) return;
  times_->visit(step, [&](double t) {
    if (t == step.from.t)
      write_row(t);
    else
      due_.push_back(t);
  });
}

void EnergyRecorder::step(const time::AcceptedStep& step) {
  find_due(step);
  auto is_due = [due = std::span<const double>(due_)](double t) mutable {
    const std::size_t before = due.size();
    while (!due.empty() && due.front() <= t) due = due.subspan(1);
    return due.size() < before;
  };
  // Methods tell the energies of the free degrees of freedom.
  const std::span<const time::EnergyAt> told =
      base_.is_empty() ? step.motion.energies(due_) : std::span<const time::EnergyAt>{};
  const double work = work_, dissipated = dissipated_;
  for (const time::EnergyAt& at : told) {
    now_ = {at.kinetic, at.strain, at.contact};
    work_ = work + at.work;
    dissipated_ = dissipated + at.dissipated;
    largest_ = std::max(largest_, now_.size());
    if (is_due(at.t)) write_row(at.t);
  }
  if (!told.empty()) return;
  double begin = step.from.t;
  if (dynamics_.loads_jump(begin)) last_ = power(begin, step.from.x, step.from.v);
  for (const double instant : ends_of_pieces(step)) {
    add_piece(step, begin, instant);
    begin = instant;
    if (!is_due(instant)) continue;
    look_within(step, instant);
    write_row(instant);
  }
  add_piece(step, begin, step.to.t);
  now_ = energy_of(step.to, dynamics_, base_);
  largest_ = std::max(largest_, now_.size());
  if (is_due(step.to.t)) write_row(step.to.t);
}

bool EnergyRecorder::uses_gauss(const time::AcceptedStep& step) const {
  // Contact forces may jump at the ends of pieces. The power of v C v along a quintic is of degree 8.
  const time::Interpolation kind = step.motion.interpolation();
  return dynamics_.obstacles() != nullptr || kind == time::Interpolation::quintic ||
         kind == time::Interpolation::near_quintic;
}

const std::vector<double>& EnergyRecorder::ends_of_pieces(const time::AcceptedStep& step) {
  const auto found = step.motion.breakpoints(uses_gauss(step) ? time::Detail::power : time::Detail::velocities);
  ends_.assign(found.begin(), found.end());
  if (!uses_gauss(step) && step.motion.interpolation() == time::Interpolation::cubic) return ends_;
  for (const double t : due_)
    if (t > step.from.t && t < step.to.t) ends_.push_back(t);
  if (step.motion.interpolation() == time::Interpolation::other) {
    if (!discontinuities_) discontinuities_ = dynamics_.load_discontinuities();
    ends_.insert(ends_.end(), std::upper_bound(discontinuities_->begin(), discontinuities_->end(), step.from.t),
                 std::lower_bound(discontinuities_->begin(), discontinuities_->end(), step.to.t));
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
  return ends_;
}

void EnergyRecorder::look_within(const time::AcceptedStep& step, double t) {
  Vector x(dynamics_.size()), v(dynamics_.size());
  const auto span = [](Vector& vector) { return std::span(vector.data(), static_cast<std::size_t>(vector.size())); };
  step.motion.interpolate(t, all_, {span(x), span(v), {}});
  time::State state;
  state.t = t;
  state.x = std::move(x);
  state.v = std::move(v);
  now_ = energy_of(state, dynamics_, base_);
  largest_ = std::max(largest_, now_.size());
}

EnergyRecorder::Power EnergyRecorder::power_within(const time::AcceptedStep& step, double t) {
  if (t == step.to.t) return power(dynamics_.loads_jump(t) ? dynamics::just_before(t) : t, step.to.x, step.to.v);
  const auto span = [](Vector& vector) { return std::span(vector.data(), static_cast<std::size_t>(vector.size())); };
  step.motion.interpolate(t, all_, {needs_x_ ? span(middle_x_) : std::span<double>{}, span(middle_), {}});
  return power(t, middle_x_, middle_);
}

template <class Points>
void EnergyRecorder::find_powers(const time::AcceptedStep& step, const Points& points) {
  constexpr auto kPoints = static_cast<Index>(std::tuple_size_v<Points>);
  std::array<double, std::tuple_size_v<Points>> instants{};
  std::transform(points.begin(), points.end(), instants.begin(), [](const auto& point) { return point.t; });
  const auto span = [](auto& matrix) { return std::span(matrix.data(), static_cast<std::size_t>(matrix.size())); };
  v_at_.resize(dynamics_.size(), kPoints);
  if (needs_x_) x_at_.resize(dynamics_.size(), kPoints);
  step.motion.interpolate(instants, all_, {needs_x_ ? span(x_at_) : std::span<double>{}, span(v_at_), {}});
  powers_.clear();
  for (Index k = 0; k < kPoints; ++k) {
    middle_ = v_at_.col(k);
    if (needs_x_) middle_x_ = x_at_.col(k);
    powers_.push_back(power(instants[static_cast<std::size_t>(k)], middle_x_, middle_));
  }
}

EnergyRecorder::Power EnergyRecorder::gauss(const time::AcceptedStep& step, double begin, double end) {
  const auto points = gauss_points(begin, end);
  find_powers(step, points);
  Power sum{};
  for (std::size_t k = 0; k < points.size(); ++k) sum += points[k].weight * powers_[k];
  return sum;
}

void EnergyRecorder::add(const Power& done) {
  work_ += done.of_loads;
  dissipated_ += done.of_damping;
  into_obstacles_ += done.of_contacts;
}

void EnergyRecorder::add_halved(const time::AcceptedStep& step, double begin, double end, int halvings) {
  const auto points = kronrod_points(begin, end);
  find_powers(step, points);
  Power sum{}, coarse{}, continued{};  // the last: the polynomial through the points, continued to `begin`
  for (std::size_t k = 0; k < points.size(); ++k) {
    sum += points[k].weight * powers_[k];
    coarse += points[k].coarse_weight * powers_[k];
  }
  const double miss = std::max(std::abs(sum.of_loads - coarse.of_loads), std::abs(sum.of_damping - coarse.of_damping));
  // The energy that a fast decay may hide before the first point. Fast decays begin with a step.
  double layer = 0.0;
  if (begin == step.from.t) {
    for (std::size_t k = 0; k < points.size(); ++k) continued += lagrange_at(begin, points, k) * powers_[k];
    const Power first = power(begin, step.from.x, step.from.v);
    layer = (points.front().t - begin) *
            std::max(std::abs(first.of_damping - continued.of_damping), std::abs(first.of_loads - continued.of_loads));
  }
  // For a start from rest the piece itself is the only reference.
  const double size = std::max(largest_, std::abs(sum.of_loads) + std::abs(sum.of_damping));
  const bool is_coarse = (miss > kGoodWork * size && halvings < kMostHalvingsOfWork) ||
                         (layer > kGoodLayer * size && halvings < kMostHalvingsOfLayer);
  const double middle = 0.5 * (begin + end);
  // Steps may end within rounding of an instant; there the points coincide.
  if (!is_coarse || !(begin < middle && middle < end)) return add(sum);
  add_halved(step, begin, middle, halvings + 1);
  add_halved(step, middle, end, halvings + 1);
}

void EnergyRecorder::add_piece(const time::AcceptedStep& step, double begin, double end) {
  if (step.motion.interpolation() == time::Interpolation::other) return add_halved(step, begin, end, 0);
  if (uses_gauss(step)) return add(gauss(step, begin, end));
  const double h = end - begin;
  const Power middle = power_within(step, 0.5 * (begin + end)), last = power_within(step, end);
  const Power done = (h / 6.0) * last_ + (4.0 / 6.0 * h) * middle + (h / 6.0) * last;
  add(done);
  last_ = last;
}

std::vector<std::string> EnergyRecorder::columns() {
  return {"t", "kinetic", "strain", "contact", "work", "dissipated"};
}

void EnergyRecorder::write_row(double t) {
  const std::array<double, 6> row = {t, now_.kinetic, now_.strain, now_.contact, work(), dissipated()};
  if (writer_ != nullptr) writer_->row(row);
  if (other_ != nullptr) other_->append_row(row);
}

void EnergyRecorder::finish() {
  if (writer_ != nullptr) writer_->flush();
}

void EnergyRecorder::save(ByteWriter& to) const {
  for (const double number :
       {last_.of_loads, last_.of_damping, now_.kinetic, now_.strain, now_.contact, first_total_, largest_, work_,
        dissipated_, into_obstacles_, first_stored_, now_.in_obstacles, first_of_supports_, now_.of_supports})
    to.put(number);
  if (times_) times_->save(to);
  to.put(writer_ != nullptr ? writer_->position() : std::uint64_t{0});
}

void EnergyRecorder::restore(ByteReader& from) {
  for (double* number : {&last_.of_loads, &last_.of_damping, &now_.kinetic, &now_.strain, &now_.contact, &first_total_,
                         &largest_, &work_, &dissipated_, &into_obstacles_, &first_stored_, &now_.in_obstacles,
                         &first_of_supports_, &now_.of_supports})
    from.take(*number);
  if (times_) times_->restore(from);
  const auto position = from.take<std::uint64_t>();
  if (writer_ != nullptr) writer_->go_back(position);
}

double EnergyRecorder::balance_error() const {
  return largest_ > 0.0 ? (now_.total() - first_total_ + dissipated() - work()) / largest_ : 0.0;
}

}  // namespace butee::record
