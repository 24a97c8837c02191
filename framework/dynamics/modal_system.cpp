#include "butee/dynamics/modal_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/core/error.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "butee/dynamics/static_shapes.hpp"

namespace butee::dynamics {
namespace {

/// Damping couples the modes if an off-diagonal entry exceeds this fraction of the largest;
/// rounding of proportional damping is far below it.
constexpr double kUncoupled = 1e-9;
constexpr std::size_t kOddFlows = 6;

Modes find_modes(const model::System& system, Index count) {
  if (count == 0) count = system.size() <= ModalSystem::kAllModes ? system.size() : ModalSystem::kAllModes / 2;
  count = std::min(count, system.size());
  auto modes = lowest_modes(system, count);
  if (!modes)
    throw InputError("the " + std::to_string(count) +
                     " lowest modes could not be computed; ask for another number of modes, or take another method");
  return std::move(*modes);
}

/// A column with unit forces for every stop, and one for every load.
Eigen::MatrixXd forces_of(const model::System& system) {
  std::vector<Vector> columns;
  for (const model::FreeStops& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i) {
      Vector& force = columns.emplace_back(Vector::Zero(system.size()));
      if (stops.a[i] >= 0) force[stops.a[i]] += 1.0;
      if (stops.b[i] >= 0) force[stops.b[i]] -= 1.0;
    }
  for (const model::FreeLoad& load : system.loads) {
    Vector& force = columns.emplace_back(Vector::Zero(system.size()));
    for (std::size_t i = 0; i < load.dofs.size(); ++i) force[load.dofs[i]] += load.weights[i];
  }
  Eigen::MatrixXd all(system.size(), static_cast<Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) all.col(static_cast<Index>(j)) = columns[j];
  return all;
}

}  // namespace

ModalSystem::ModalSystem(Dynamics& dynamics, Index count) {
  const model::System& system = dynamics.system();
  if (!system.is_symmetric)
    throw InputError(
        "integrator.type: shafts turn, or bearings or given matrices have cross terms in this scene, so that its "
        "matrices are not "
        "symmetric and it lacks the real modes that this method requires");
  Modes modes = find_modes(system, count);
  if (modes.frequencies.size() < system.size()) add_static(system, modes);
  frequencies_ = modes.frequencies.array();
  shapes_ = std::move(modes.shapes);
  rows_ = shapes_.transpose();
  weighted_ = system.mass * shapes_;
  if (shapes_.rows() <= linalg::DenseProduct::kMostRows) fast_shapes_ = linalg::DenseProduct(shapes_);
  find_decay(dynamics);
  project_loads(dynamics);
  if (dynamics.stop_count() > 0) project_stops(dynamics.stops());
}

void ModalSystem::add_static(const model::System& system, Modes& modes) {
  const Index modes_alone = modes.frequencies.size();
  auto count = static_cast<Index>(system.loads.size());
  for (const model::FreeStops& stops : system.stops) count += static_cast<Index>(stops.size());
  if (count == 0) return;
  const Vector shares = count <= kMostStaticShapes ? add_static_shapes(system, forces_of(system), modes) : Vector();
  static_count_ = modes.frequencies.size() - modes_alone;
  if (shares.size() > 0) truncation_ = shares.maxCoeff();
}

void ModalSystem::find_decay(Dynamics& dynamics) {
  const model::Damping& damping = dynamics.system().damping;
  decay_ = 0.5 * (damping.mass_proportional + damping.stiffness_proportional * frequencies_.square());
  if (!damping.is_modal() && dynamics.system().dashpots.size() == 0) return;
  Eigen::MatrixXd product(shapes_.rows(), size());
  for (Index i = 0; i < size(); ++i) dynamics.damping_force(shapes_.col(i), product.col(i));
  const Eigen::MatrixXd modal = shapes_.transpose() * product;
  decay_ = 0.5 * modal.diagonal().array();
  const double largest = modal.cwiseAbs().maxCoeff();
  const Eigen::MatrixXd beside = modal - Eigen::MatrixXd(modal.diagonal().asDiagonal());
  if (beside.cwiseAbs().maxCoeff() > kUncoupled * largest)
    throw InputError(
        "integrator.type: the dashpots couple the modes of this scene, which then have no closed-form solution; write "
        "the damping as [damping] mass_proportional, stiffness_proportional or "
        "modal");
}

void ModalSystem::project_loads(const Dynamics& dynamics) {
  for (const model::FreeLoad& load : dynamics.system().loads) {
    Eigen::ArrayXd shape = Eigen::ArrayXd::Zero(size());
    for (std::size_t i = 0; i < load.dofs.size(); ++i) shape += load.weights[i] * rows_.col(load.dofs[i]).array();
    const auto harmonic = load.in_time->harmonic();
    if (!harmonic && !load.in_time->is_piecewise_parabolic())
      throw InputError(
          "integrator.type: a load of this scene is neither harmonic nor made of straight lines or parabolas in time, "
          "such as the unbalance of a run-up or the smooth curve of a [base] displacement table beside frame = "
          "\"space\" "
          "or [[base]] nodes, so its response has no closed form");
    if (!harmonic) {
      other_loads_.push_back({load.in_time, std::move(shape)});
      continue;
    }
    auto found = std::find_if(harmonics_.begin(), harmonics_.end(), [&](const ModalHarmonic& other) {
      return other.angular_frequency == harmonic->angular_frequency;
    });
    if (found == harmonics_.end()) {
      const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(size());
      found = harmonics_.insert(harmonics_.end(), {harmonic->angular_frequency, zero, zero});
    }
    found->cosine += harmonic->amplitude * std::cos(harmonic->phase) * shape;
    found->sine -= harmonic->amplitude * std::sin(harmonic->phase) * shape;
  }
}

void ModalSystem::replace_loads(const Dynamics& dynamics) {
  harmonics_.clear();
  other_loads_.clear();
  project_loads(dynamics);
  // Propagators contain the harmonics and data that methods derived from the laws.
  grid_.clear();
  odd_.clear();
  oldest_ = 0;
}

void ModalSystem::project_stops(const ElasticStops& contact) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(size(), contact.size());
  for (Index i = 0; i < contact.size(); ++i) {
    if (contact.dof_a(i) >= 0) shapes.col(i) += rows_.col(contact.dof_a(i));
    if (contact.dof_b(i) >= 0) shapes.col(i) -= rows_.col(contact.dof_b(i));
  }
  stop_shapes_ = StopShapes(std::move(shapes));
}

void ModalSystem::to_modal(ConstVectorRef x, Eigen::Ref<Eigen::VectorXd> q) const {
  q.noalias() = weighted_.transpose() * x;
}

void ModalSystem::to_physical(const double* q, VectorRef x) const {
  if (!fast_shapes_.empty()) return fast_shapes_.multiply(q, x.data());
  x.noalias() = shapes_ * Eigen::Map<const Vector>(q, size());
}

void ModalSystem::add_load(double t, Eigen::Ref<Eigen::ArrayXd> r) const {
  for (const ModalHarmonic& harmonic : harmonics_) {
    const double angle = harmonic.angular_frequency * t;
    r += std::cos(angle) * harmonic.cosine + std::sin(angle) * harmonic.sine;
  }
  for (const OtherLoad& load : other_loads_) r += load.in_time->value(t) * load.shape;
}

double ModalSystem::grid_step(int level) {
  const int whole = level >= 0 ? level / 2 : -((1 - level) / 2);
  const double step = std::ldexp(1.0, whole);
  return level % 2 == 0 ? step : step * std::numbers::sqrt2;
}

const ModalPropagator& ModalSystem::raw_propagator(int level) {
  if (const auto& known = grid_[level].raw) return *known;
  const double h = grid_step(level);
  auto flow = h > ModalPropagator::longest_series(frequencies_, decay_, harmonics_)
                  ? std::make_unique<ModalPropagator>(raw_propagator(level - 2).doubled())
                  : std::make_unique<ModalPropagator>(frequencies_, decay_, harmonics_, h);
  return *(grid_[level].raw = std::move(flow));
}

ModalPropagator ModalSystem::refined_propagator(int level) {
  ModalPropagator flow = raw_propagator(level);
  flow.refine(frequencies_, decay_);
  return flow;
}

ContactPropagator& ModalSystem::propagator(int level) {
  std::unique_ptr<ContactPropagator>& step = grid_[level].step;
  if (!step) {
    ModalPropagator half = refined_propagator(level - 2);
    step = std::make_unique<ContactPropagator>(refined_propagator(level), std::move(half), stop_shapes_, frequencies_,
                                               harmonics_);
  }
  return *step;
}

ContactPropagator& ModalSystem::odd(double h) {
  for (const auto& known : odd_)
    if (known->h() == h) return *known;
  if (odd_.size() < kOddFlows) {
    oldest_ = odd_.size();
    odd_.emplace_back();
  }
  ModalPropagator half(frequencies_, decay_, harmonics_, 0.5 * h), whole = half.doubled();
  half.refine(frequencies_, decay_);
  whole.refine(frequencies_, decay_);
  std::unique_ptr<ContactPropagator>& slot = odd_[oldest_];
  slot = std::make_unique<ContactPropagator>(std::move(whole), std::move(half), stop_shapes_, frequencies_, harmonics_);
  oldest_ = (oldest_ + 1) % kOddFlows;
  return *slot;
}

}  // namespace butee::dynamics
