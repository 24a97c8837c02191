#include "integrators/small_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

/// A Kelvin-Voigt stop on one displacement with the law and shape of the contact type `stop`.
bool is_linear_stop(const model::ObstacleGroup& group) {
  using Kind = model::ImpactDamping::Kind;
  return group.kind == "stop" && group.directions.size() == 1 && group.shape != nullptr && group.law != nullptr &&
         group.law->is_piecewise_linear() && group.friction.rule == model::Friction::Rule::none &&
         (group.damping.kind == Kind::kelvin_voigt || group.damping.kind == Kind::none);
}

}  // namespace

std::string SmallSystem::obstacle_to(dynamics::Dynamics& dynamics) {
  const model::System& system = dynamics.system();
  if (system.size() > kMostDofs)
    return std::to_string(system.size()) + " DOFs are more than the " + std::to_string(kMostDofs) +
           " that piecewise takes";
  if (!system.is_symmetric || system.rotation != nullptr)
    return "shafts turn, or bearings or given matrices have cross terms, so that the matrices are not symmetric";
  for (const model::FreeStops& stops : system.stops) {
    if (!stops.law->is_piecewise_linear()) return "piecewise needs stops with law = \"linear\"";
    if (stops.play.has_both() && stops.play.gap < 0.0)
      return "the force of a stop with two sides and a negative gap jumps";
  }
  for (const model::FreeObstacles& obstacles : system.obstacles)
    if (!is_linear_stop(*obstacles.group))
      return "piecewise takes stops with law = \"linear\", elastic or with Kelvin-Voigt dissipation, without friction, "
             "and no rings, planes or friction supports";
  for (const model::FreeLoad& load : system.loads)
    if (!load.in_time->harmonic() && !load.in_time->is_piecewise_parabolic())
      return "a load is neither harmonic nor made of straight lines or parabolas in time";
  if (system.damping.mass_proportional < 0.0 || system.damping.stiffness_proportional < 0.0)
    return "damping is negative, so that motions grow without bound";
  return {};
}

SmallSystem::SmallSystem(dynamics::Dynamics& dynamics) {
  if (const std::string why = obstacle_to(dynamics); !why.empty()) throw InputError("integrator.type: " + why);
  const model::System& system = dynamics.system();
  const Index n = system.size();
  mass = Eigen::MatrixXd(system.mass).cast<long double>();
  stiffness = Eigen::MatrixXd(system.stiffness).cast<long double>();
  damping.resize(n, n);
  Vector column(n);
  for (Index i = 0; i < n; ++i) {
    dynamics.damping_force(Vector::Unit(n, i), column);
    damping.col(i) = column.cast<long double>();
  }
  if (!system.damping.is_modal() && system.dashpots.size() == 0)
    damping = static_cast<long double>(system.damping.mass_proportional) * mass +
              static_cast<long double>(system.damping.stiffness_proportional) * stiffness;
  add_stops(dynamics);
  add_loads(system);
}

void SmallSystem::add_stops(dynamics::Dynamics& dynamics) {
  const dynamics::ElasticStops& contact = dynamics.stops();
  for (Index i = 0; i < contact.size(); ++i) {
    LinearStop stop{contact.dof_a(i), contact.dof_b(i), contact.play_of(i).gap, contact.law_of(i).closed_stiffness()};
    stop.positive = contact.play_of(i).has_positive();
    stop.negative = contact.play_of(i).has_negative();
    stop.always_closed = stop.positive && stop.negative && stop.gap == 0.0;
    stops.push_back(stop);
  }
  for (const model::FreeObstacles& obstacles : dynamics.system().obstacles) {
    const model::ObstacleGroup& group = *obstacles.group;
    const model::ContactShape::Form form = group.shape->form();
    for (const model::FreeObstacles::Ends& ends : obstacles.ends) {
      LinearStop stop{ends.a[0], ends.b[0], form.distance, group.law->closed_stiffness()};
      if (group.damping.kind == model::ImpactDamping::Kind::kelvin_voigt) stop.damping = group.damping.coefficient;
      stop.pulls = group.damping.pulls;
      const bool has_both = form.kind == model::ContactShape::Form::Kind::circle;
      stop.positive = has_both || form.place[0] > 0.0;
      stop.negative = has_both || form.place[0] < 0.0;
      stops.push_back(stop);
    }
  }
}

void SmallSystem::add_loads(const model::System& system) {
  const Index n = system.size();
  cosine.resize(n, 0);
  sine.resize(n, 0);
  for (const model::FreeLoad& load : system.loads) {
    const auto harmonic = load.in_time->harmonic();
    if (!harmonic || harmonic->angular_frequency == 0.0) {
      others_.push_back(&load);
      continue;
    }
    const auto found = std::find(frequencies.begin(), frequencies.end(), harmonic->angular_frequency);
    const auto j = found - frequencies.begin();
    if (found == frequencies.end()) {
      frequencies.push_back(harmonic->angular_frequency);
      for (LongMatrix* part : {&cosine, &sine}) {
        part->conservativeResize(n, j + 1);
        part->col(j).setZero();
      }
    }
    const long double amplitude = harmonic->amplitude, phase = harmonic->phase;
    for (std::size_t i = 0; i < load.dofs.size(); ++i) {
      const long double weight = static_cast<long double>(load.weights[i]) * amplitude;
      cosine(load.dofs[i], j) += weight * std::cos(phase);
      sine(load.dofs[i], j) -= weight * std::sin(phase);
    }
  }
}

bool SmallSystem::add_polynomials(double t, Eigen::MatrixXd& force) const {
  for (const model::FreeLoad* load : others_) {
    std::array<double, 3> coefficients{};
    load->in_time->taylor(t, 1.0, coefficients);
    for (std::size_t i = 0; i < load->dofs.size(); ++i)
      for (Index k = 0; k < 3; ++k)
        force(load->dofs[i], k) += load->weights[i] * coefficients[static_cast<std::size_t>(k)];
  }
  return !others_.empty();
}

}  // namespace butee::integrators
