#include "integrators/exponential/node_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/dynamics/external_forces.hpp"

namespace butee::integrators {
namespace {

using time::State;

constexpr Index kCount = StepNodes::kCount, kEnd = StepNodes::kEnd;
constexpr int kMostSweeps = 25;
/// Convergence is too slow if more than kPatience sweeps together do not reduce the change by a sweep to this fraction
/// of the smallest one before.
constexpr double kContraction = 0.6;
constexpr int kPatience = 4;
/// The smallest scale of a velocity in the weights of the sweeps, as a fraction of the largest.
constexpr double kLeastScale = 1e-3;
/// The largest displacement within a step, and that of the polynomial through the nodes, over the sum of the modes'
/// amplitudes at the nodes, at most: the polynomial reaches 3.12 times the largest value at the nodes (its Lebesgue
/// constant), the modes by little more than that value.
constexpr double kBetweenNodes = 3.2;
/// A scale that grows by less in a step counts as constant.
constexpr double kSettledScale = 0.5;
/// Changes of a force below this fraction of it are rounding errors.
constexpr double kRounding = 1e-13;
/// The rounding error of a displacement at a node, relative to the largest one: that of a sum over many modes. A stiff
/// contact multiplies it.
constexpr double kRoundingOfPlace = 16.0 * std::numeric_limits<double>::epsilon();
/// The rounding error of the polynomial between the nodes, likewise. Its coefficients lose further digits.
constexpr double kRoundingOfCrossing = 256.0 * kRoundingOfPlace;
/// The same for the effect of contacts on the end of a step; the polynomials' coefficients lose
/// further digits.
constexpr double kRoundingOfEnd = 1e-12;

}  // namespace

NodeForces::NodeForces(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes)
    : dynamics_(dynamics),
      modes_(modes),
      varying_(dynamics.system(), modes.reference_speed()),
      dofs_(dynamics, modes, varying_.dofs()),
      need_velocity_(dofs_.need_velocity() || varying_.need_velocity()),
      borders_(dynamics.stops()),
      errors_(dynamics, dofs_),
      active_(modes),
      scales_(dynamics.system()),
      discontinuities_(dynamics.load_discontinuities()) {
  instant_.x = instant_.v = instant_.force = Vector::Zero(dynamics.size());
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i)
      if (const auto& law = obstacles->group_of(i).law; law != nullptr && inner_border(*law) > 0.0)
        inner_borders_.emplace_back(i, inner_border(*law));
  const Index p = modes.count();
  free_ = nodes_ = polynomial_ = missed_ = Lanes::Zero(2 * p, Lanes::ColsAtCompileTime);
  end_ = error_ = Vector::Zero(2 * p);
}

double NodeForces::unresolved(const State& from, const double* z, const ModalLoads& loads, double h) const {
  auto [sum, scale] = loads.resolution(h, dofs_.reach());
  const Index p = modes_.count();
  const Eigen::Map<const Eigen::ArrayXd> re(z, p), im(z + p, p);
  const Eigen::ArrayXd amplitude = dofs_.reach() * (re.square() + im.square()).sqrt(), turn = modes_.speed() * h;
  // A mode that follows its force does not turn: |dz/dt|/|lambda| is its distance from the place where it would rest.
  // Where a load or its slope jumps, the forces of the step before are not those of this one, and a force that bends
  // while a stop is open moves light masses on the way between the nodes.
  Eigen::VectorXd rate = Eigen::Map<const Eigen::MatrixXd>(z + 2 * p, 2 * p, kCount).rowwise().sum();
  loads.add_harmonic_rate(from.t, rate);
  rate.head(p).array() += modes_.decay() * re - modes_.turn() * im;
  rate.tail(p).array() += modes_.decay() * im + modes_.turn() * re;
  const bool turns = dofs_.acts_apart() || std::binary_search(discontinuities_.begin(), discontinuities_.end(), from.t);
  for (Index k = 0; k < p; ++k) {
    const double speed = modes_.speed()[k],
                 turning = turns || speed == 0.0
                               ? amplitude[k]
                               : dofs_.reach()[k] * std::sqrt(rate[k] * rate[k] + rate[p + k] * rate[p + k]) / speed;
    sum += std::min(amplitude[k], turning) * StepNodes::missed_part(turn[k]);
  }
  scale = std::max(scale, (amplitude * turn.min(1.0)).maxCoeff());
  const auto scales = LocalErrorControl::scales_x(from);
  for (const Index dof : dofs_.all()) scale = std::max(scale, scales[dof]);
  return scale > 0.0 ? sum / scale : 0.0;
}

bool NodeForces::stays_apart(const double* z) const {
  const Index p = modes_.count();
  const Eigen::Map<const Eigen::ArrayXd> re(z, p), im(z + p, p);
  return kBetweenNodes * (dofs_.reach() * (re.square() + im.square()).sqrt()).sum() < dofs_.clearance();
}

bool NodeForces::stays_apart() const {
  const Index p = modes_.count();
  Lane sum = Lane::Zero();
  for (Index k = 0; k < p; ++k)
    sum += dofs_.reach()[k] * (lane_of<8>(nodes_, k).square() + lane_of<8>(nodes_, p + k).square()).sqrt();
  return kBetweenNodes * sum.head(kCount).maxCoeff() < dofs_.clearance();
}

void NodeForces::find_forces(double t, double h, Index node) {
  auto& [x, v, force] = instant_;
  for (Index k = 0; k < active_.count(); ++k) {
    const Index dof = active_.dofs[static_cast<std::size_t>(k)];
    x[dof] = moved_(k, node);
    if (need_velocity_) v[dof] = moved_velocity_(k, node);
    force[dof] = 0.0;
  }
  dynamics_.add_contact_force(x, force);
  if (!sides_.empty()) keep_sides(x, force);
  const double now = t + StepNodes::kPlaces[static_cast<std::size_t>(node)] * h;
  dynamics_.add_obstacle_force(now, x, v, force);
  // A step may end where the acceleration of the rotation jumps.
  if (!varying_.dofs().empty()) {
    ++dynamics_.counters().force_evaluations;
    varying_.add(node == kEnd ? dynamics::just_before(now) : now, x, v, force);
  }
  for (Index k = 0; k < active_.count(); ++k) forces_(k, node) = force[active_.dofs[static_cast<std::size_t>(k)]];
}

void NodeForces::find_forces(double t, double h) {
  active_.superposition.displacements(nodes_, row_);
  moved_.rightCols(kCount - 1) = row_.middleCols<kCount - 1>(1);
  if (need_velocity_) {
    active_.superposition.velocities(nodes_, row_);
    moved_velocity_.rightCols(kCount - 1) = row_.middleCols<kCount - 1>(1);
  }
  for (Index j = 1; j < kCount; ++j) find_forces(t, h, j);
}

void NodeForces::move(const StepResponse& response, const StepNodes::Matrix& coefficients) {
  coefficients_.setZero(active_.count(), Lanes::ColsAtCompileTime);
  coefficients_.leftCols<kCount>() = forces_.lazyProduct(coefficients);
  active_.superposition.modal_forces(coefficients_, polynomial_);
  nodes_ = free_;
  response.add_force(polynomial_, nodes_);
}

void NodeForces::find_scales(const State& from, double h) {
  const double time = dofs_.highest_frequency() > 0.0 ? 1.0 / dofs_.highest_frequency() : h;
  scale_x_ = LocalErrorControl::scales_x(from);
  scale_v_ = LocalErrorControl::scales_v(from);
  work_ = time * from.a;
  scales_.raise(work_, scale_v_);
  work_ = time * scale_v_;
  scales_.raise(work_, scale_x_);
}

double NodeForces::change(double h) const {
  double largest = 0.0;
  const double place = kRoundingOfPlace * moved_.cwiseAbs().maxCoeff();
  for (Index k = 0; k < active_.count(); ++k) {
    const auto now = forces_.row(k), before = forces_before_.row(k);
    const double difference = (now - before).cwiseAbs().maxCoeff();
    if (std::isnan(difference)) return difference;
    const Index dof = active_.dofs[static_cast<std::size_t>(k)];
    if (difference <= std::max(kRounding * now.cwiseAbs().maxCoeff(), place * dofs_.stiffness(dof))) continue;
    const double change = h * dofs_.inverse_mass(dof) * difference;
    largest =
        std::max({largest, change / std::max(scale_v_[dof], change), h * change / std::max(scale_x_[dof], h * change)});
  }
  return largest;
}

NodeForces::Outcome NodeForces::find(const State& from, const StepResponse& response, double settled) {
  if (active_.find(dynamics_, varying_.dofs()))
    for (AtNodes* rows : {&forces_, &moved_, &moved_velocity_, &weights_}) rows->resize(active_.count(), kCount);
  error_.setZero();
  if (active_.count() == 0) {
    polynomial_.setZero();
    missed_.setZero();
    nodes_ = free_;
    return finished();
  }
  const double t = from.t, h = response.h();
  start(from, h);
  acceleration_.begin(forces_.size());
  find_scales(from, h);
  find_weights(from);
  double least = std::numeric_limits<double>::infinity();
  int best = 0;
  for (int round = 0; round < kMostSweeps; ++round) {
    move(response, StepNodes::with_middle());
    forces_before_ = forces_;
    find_forces(t, h);
    const double now = change(h);
    if (std::isnan(now)) return Outcome::not_finite;
    if (now <= settled) {
      estimate(t, response);
      return finished();
    }
    if (now < kContraction * least) {
      least = now;
      best = round;
    }
    if (round - best > kPatience) return Outcome::diverged;
    acceleration_.accelerate(forces_before_, forces_, weights_);
  }
  return Outcome::diverged;
}

NodeForces::Outcome NodeForces::finished() {
  end_ = nodes_.col(kEnd);
  return std::isfinite(nodes_.lpNorm<1>()) ? Outcome::converged : Outcome::not_finite;
}

void NodeForces::find_weights(const State& from) {
  const auto scale = LocalErrorControl::scales_v(from);
  double largest = 0.0;
  for (const Index dof : active_.dofs) largest = std::max(largest, scale[dof]);
  for (Index k = 0; k < active_.count(); ++k) {
    const Index dof = active_.dofs[static_cast<std::size_t>(k)];
    const double speed = std::max(scale[dof], kLeastScale * largest), inverse_mass = dofs_.inverse_mass(dof);
    weights_.row(k).setConstant(speed > 0.0 && inverse_mass > 0.0 ? inverse_mass / speed : 1.0);
  }
}

void NodeForces::start(const State& from, double h) {
  for (Index k = 0; k < active_.count(); ++k) {
    const Index dof = active_.dofs[static_cast<std::size_t>(k)];
    moved_(k, 0) = from.x[dof];
    moved_velocity_(k, 0) = from.v[dof];
  }
  if (!borders_.jumping().empty()) find_sides(from, h);
  instant_.x.setZero();
  instant_.v.setZero();
  find_forces(from.t, 0.0, 0);
  for (Index j = 1; j < kCount; ++j) forces_.col(j) = forces_.col(0);
}

void NodeForces::find_sides(const State& from, double h) {
  const double s = StepNodes::kPlaces[1] * h;
  const dynamics::ElasticStops& stops = dynamics_.stops();
  sides_.clear();
  for (const Index i : borders_.jumping()) {
    const auto of = [a = stops.dof_a(i), b = stops.dof_b(i)](const Vector& y) {
      return (a >= 0 ? y[a] : 0.0) - (b >= 0 ? y[b] : 0.0);
    };
    const double start = of(from.x);
    sides_.push_back(StopBorders::side_of_step(start, start + s * (of(from.v) + 0.5 * s * of(from.a))));
  }
}

void NodeForces::keep_sides(const Vector& x, Vector& force) const {
  for (std::size_t j = 0; j < sides_.size(); ++j) {
    const Index i = borders_.jumping()[j], a = dynamics_.stops().dof_a(i), b = dynamics_.stops().dof_b(i);
    const double more = borders_.continuation(i, sides_[j], (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0));
    if (a >= 0) force[a] += more;
    if (b >= 0) force[b] -= more;
  }
}

void NodeForces::estimate(double t, const StepResponse& response) {
  kept_nodes_ = nodes_;
  kept_polynomial_ = polynomial_;
  const AtNodes moved = moved_;
  errors_.find({t, response.h(), active_, forces_, moved_, moved_velocity_, modes_, nodes_.col(kEnd)});
  move(response, StepNodes::without_middle());
  // This hardly moves the end if the linear part is slow; the response of the contacts to it makes
  // the difference visible.
  find_forces(t, response.h());
  move(response, StepNodes::without_middle());
  error_ = nodes_.col(kEnd) - kept_nodes_.col(kEnd);
  // The polynomials with and without the value in the middle have the same integral; the error of
  // this integral is added separately.
  for (Index k = 0; k < active_.count(); ++k)
    error_ += errors_.of_impulse()[k] * modes_.input().col(active_.dofs[static_cast<std::size_t>(k)]);
  // In equilibrium only rounding errors remain.
  if (error_.norm() <= kRoundingOfEnd * (kept_nodes_.col(kEnd) - free_.col(kEnd)).norm()) error_.setZero();
  missed_ = polynomial_ - kept_polynomial_;
  nodes_.swap(kept_nodes_);
  polynomial_.swap(kept_polynomial_);
  moved_ = moved;
}

double NodeForces::inner_error(const State& from, const State& to) const {
  const auto begin = LocalErrorControl::scales_v(from), end = LocalErrorControl::scales_v(to);
  double largest = 0.0;
  for (Index k = 0; k < active_.count(); ++k) {
    const Index dof = active_.dofs[static_cast<std::size_t>(k)];
    double scale = begin[dof];
    // A scale that grows in the step, as at a start from rest, is taken at the first node behind the start. The error
    // before it is smaller, as it begins at 0.
    if (scale < kSettledScale * end[dof]) {
      const double early = need_velocity_ ? moved_velocity_(k, 1) : modes_.velocity().col(dof).dot(nodes_.col(1));
      scale = std::min(std::max({scale, kLeastScale * end[dof], std::abs(early)}), end[dof]);
    }
    if (scale > 0.0) largest = std::max(largest, errors_.within()[k] / scale);
  }
  return largest;
}

void NodeForces::end_at(double part, double t, const double* z, const double* loads, const PlaceResponse& response) {
  Lane powers = Lane::Zero();
  powers[0] = 1.0;
  for (Index r = 1; r < kCount; ++r) powers[r] = part * powers[r - 1];
  for (Lanes* all : {&polynomial_, &missed_})
    for (Index k = 0; k < all->rows(); ++k) lane_of<8>(*all, k) *= powers;
  response.move(t, z, loads, end_);
  add_response(response, polynomial_, end_);
  error_.setZero();
  add_response(response, missed_, error_);
}

void NodeForces::add_response(const PlaceResponse& response, const Lanes& polynomial, Eigen::VectorXd& out) {
  columns_ = polynomial.leftCols<kCount>();
  response.add_force(columns_.data(), out);
}

void NodeForces::find_nodes(double t, const double* loads, const StepResponse& response) {
  const Eigen::VectorXd begin = nodes_.col(0);
  response.move(t, begin.data(), loads, free_);
  nodes_ = free_;
  response.add_force(polynomial_, nodes_);
}

StepNodes::Row NodeForces::displacement_of(Index stop) const {
  StepNodes::Row motion = StepNodes::Row::Zero();
  const dynamics::ElasticStops& stops = dynamics_.stops();
  if (stops.dof_a(stop) >= 0) motion += moved_.row(active_.place(stops.dof_a(stop)));
  if (stops.dof_b(stop) >= 0) motion -= moved_.row(active_.place(stops.dof_b(stop)));
  return motion;
}

double NodeForces::first_contact_change(double t, double h, const CrossingRange& range, bool is_still) {
  // At rest on a border, for example where a static load just closes a stop, rounding crosses it again and again.
  const double part = is_still ? LocalErrorControl::kStill : kRoundingOfCrossing,
               rounding = moved_.size() > 0 ? part * moved_.cwiseAbs().maxCoeff() : 0.0;
  CrossingRange search{range.begin, range.last, rounding};
  for (Index i = 0; i < dynamics_.stops().size(); ++i)
    search.last = borders_.first_crossing(i, displacement_of(i) * StepNodes::with_middle(), search);
  for (const auto& [contact, border] : inner_borders_)
    if (dynamics_.obstacles()->phase(contact).touches())
      search.last = StepNodes::first_crossing(penetration_of(contact, t, h) * StepNodes::with_middle(), border, search);
  return search.last;
}

StepNodes::Row NodeForces::penetration_of(Index obstacle, double t, double h) {
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  StepNodes::Row penetration;
  for (Index node = 0; node < kCount; ++node) {
    for (const auto& side : {obstacles.ends_of(obstacle).a, obstacles.ends_of(obstacle).b})
      for (const Index dof : side) {
        if (dof < 0) continue;
        instant_.x[dof] = moved_(active_.place(dof), node);
        if (need_velocity_) instant_.v[dof] = moved_velocity_(active_.place(dof), node);
      }
    const double now = t + StepNodes::kPlaces[static_cast<std::size_t>(node)] * h;
    penetration[node] = obstacles.forces(obstacle, now, instant_.x, instant_.v).penetration;
  }
  return penetration;
}

}  // namespace butee::integrators
