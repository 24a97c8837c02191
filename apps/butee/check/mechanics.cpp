#include "mechanics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/SparseCholesky>
#include <butee/dynamics/frequencies.hpp>
#include <butee/linalg/general_factor.hpp>

namespace butee::app::check {
namespace {

using Factor = Eigen::SimplicialLDLT<SparseMatrix>;

/// If a scene has more stops, this many evenly spaced ones are examined.
constexpr Index kMostSamples = 200;
/// A pivot below this fraction of its diagonal entry counts as zero.
constexpr double kSingular = 1e-13;
constexpr int kInstants = 1000;
/// A load with at least this many reversals in the second half of the run counts as oscillating.
constexpr int kTurnsOfOscillation = 2;

bool is_regular(const SparseMatrix& matrix, Factor& factor) {
  factor.compute(matrix);
  if (factor.info() != Eigen::Success) return false;
  const Vector diagonal = factor.permutationP() * Vector(matrix.diagonal());
  return (factor.vectorD().array() > kSingular * diagonal.array()).all();
}

/// K^-1, if the structure has no rigid motion.
class Compliance {
 public:
  explicit Compliance(const model::System& system) {
    if (system.stiffness_is_symmetric) {
      exists_ = is_regular(system.stiffness, symmetric_);
    } else {
      general_.emplace(system.stiffness, counters_);
      exists_ = general_->factorize(system.stiffness);
    }
  }
  bool exists() const { return exists_; }
  Vector times(Vector force) {
    if (!general_) return symmetric_.solve(force);
    general_->solve(force);
    return force;
  }

 private:
  Factor symmetric_;
  linalg::Counters counters_;
  std::optional<linalg::GeneralFactor> general_;
  bool exists_ = false;
};

/// One stop, ring or plane: where it acts, and whether a displacement closes it.
class Stop {
 public:
  Stop(const model::System& system, const model::FreeStops& group, std::size_t i)
      : law_(group.law),
        play_(&group.play),
        a_{group.a[i], kGround},
        b_{group.b[i], kGround},
        turns_(acts_on_rotation(system, group)) {}
  Stop(const model::ObstacleGroup& group, const model::FreeObstacles::Ends& ends)
      : law_(group.law.get()), shape_(group.shape.get()), a_{ends.a[0], ends.a[1]}, b_{ends.b[0], ends.b[1]} {
    turns_ = !group.directions.empty() && is_rotation(group.directions.front());
    const model::ContactShape::Form form = shape_->form();
    is_round_ = form.kind == model::ContactShape::Form::Kind::circle;
    if (form.kind == model::ContactShape::Form::Kind::line) direction_ = form.place;
  }

  bool turns() const { return turns_; }
  double stiffness() const { return law_->closed_stiffness(); }
  double gap() const { return play_ != nullptr ? play_->gap : 0.0 - shape_->at({0.0, 0.0}).penetration; }
  /// The displacement towards it, or of any direction in a ring.
  double size_of(const Vector& x) const { return towards(x).norm(); }
  /// The largest one during an oscillation a cos p + b sin p: half the larger axis of its ellipse.
  double size_of(const Vector& a, const Vector& b) const {
    const Eigen::Vector2d at_a = towards(a), at_b = towards(b);
    const double mean = 0.5 * (at_a.squaredNorm() + at_b.squaredNorm());
    return std::sqrt(mean + std::hypot(mean - at_b.squaredNorm(), at_a.dot(at_b)));
  }
  bool is_shut(const Vector& x) const {
    const Eigen::Vector2d d = displacement(x);
    return (play_ != nullptr ? play_->penetration(d[0]) : shape_->at(d).penetration) > 0.0;
  }
  /// A unit force on it, in the first direction of a ring.
  Vector unit(Index size) const {
    Vector s = Vector::Zero(size);
    for (std::size_t k = 0; k < 2; ++k) {
      if (a_[k] >= 0) s[a_[k]] += direction_[static_cast<Index>(k)];
      if (b_[k] >= 0) s[b_[k]] -= direction_[static_cast<Index>(k)];
    }
    return s;
  }

 private:
  static constexpr Index kGround = model::FreeStops::kGround;

  Eigen::Vector2d towards(const Vector& x) const {
    return is_round_ ? displacement(x) : Eigen::Vector2d(direction_.dot(displacement(x)), 0.0);
  }
  Eigen::Vector2d displacement(const Vector& x) const {
    Eigen::Vector2d d = {0.0, 0.0};
    for (std::size_t k = 0; k < 2; ++k)
      d[static_cast<Index>(k)] = (a_[k] >= 0 ? x[a_[k]] : 0.0) - (b_[k] >= 0 ? x[b_[k]] : 0.0);
    return d;
  }

  const model::ContactLaw* law_;
  const model::FreePlay* play_ = nullptr;       ///< of an elastic stop
  const model::ContactShape* shape_ = nullptr;  ///< of any other
  std::array<Index, 2> a_, b_;
  Eigen::Vector2d direction_ = {1.0, 0.0};
  bool is_round_ = false;
  bool turns_ = false;  ///< it acts on a rotation
};

std::vector<Stop> stops_of(const model::System& system) {
  std::vector<Stop> stops;
  for (const model::FreeStops& group : system.stops)
    for (std::size_t i = 0; i < group.size(); ++i) stops.emplace_back(system, group, i);
  for (const model::FreeObstacles& obstacles : system.obstacles)
    if (obstacles.group->shape != nullptr && obstacles.group->law != nullptr)
      for (const model::FreeObstacles::Ends& ends : obstacles.ends) stops.emplace_back(*obstacles.group, ends);
  return stops;
}

/// The largest absolute value of a load until the end of the run.
double amplitude(const model::TimeFunction& function, double end_time) {
  double largest = 0.0;
  for (int i = 0; i <= kInstants; ++i) largest = std::max(largest, std::abs(function.value(end_time * i / kInstants)));
  return largest;
}

Vector pattern(const model::FreeLoad& load, Index size) {
  Vector force = Vector::Zero(size);
  for (std::size_t i = 0; i < load.dofs.size(); ++i) force[load.dofs[i]] += load.weights[i];
  return force;
}

/// The lasting part of a load. A load that settles (constants, ramps): its end value. A load that fluctuates
/// in the second half of the run (random tables, wave records): its mean there, reduced in absolute value by
/// the standard deviation down to 0 at least, because larger fluctuations open a stop again. A harmonic load:
/// 0.
double lasting_part(const model::TimeFunction& function, double end_time) {
  if (const auto harmonic = function.harmonic(); harmonic && harmonic->angular_frequency > 0.0) return 0.0;
  const double middle = 0.5 * end_time;
  std::vector<double> instants = function.discontinuities();
  std::erase_if(instants, [&](double t) { return !(t > middle && t < end_time); });
  for (int i = 0; i <= kInstants; ++i) instants.push_back(middle + (end_time - middle) * i / kInstants);
  std::sort(instants.begin(), instants.end());
  double area = 0.0, squares = 0.0, slope = 0.0, before = function.value(middle);
  int turns = 0;
  for (std::size_t i = 1; i < instants.size(); ++i) {
    const double value = function.value(instants[i]), change = value - before;
    const double length = instants[i] - instants[i - 1];
    area += 0.5 * (before + value) * length;
    squares += (before * before + before * value + value * value) / 3.0 * length;
    if (change * slope < 0.0) ++turns;
    if (change != 0.0) slope = change;
    before = value;
  }
  if (turns < kTurnsOfOscillation) return before;
  const double mean = area / (end_time - middle), variance = squares / (end_time - middle) - mean * mean;
  return std::copysign(std::max(0.0, std::abs(mean) - std::sqrt(std::max(0.0, variance))), mean);
}

void add_statics(const model::System& system, Compliance& compliance, const std::vector<Stop>& stops, double end_time,
                 Mechanics& result) {
  if (system.loads.empty() || stops.empty()) return;
  Vector largest = Vector::Zero(static_cast<Index>(stops.size()));
  Vector constant = Vector::Zero(system.size());
  std::map<double, std::pair<Vector, Vector>> oscillations;  // by angular frequency
  for (const model::FreeLoad& load : system.loads) {
    const Vector moved = compliance.times(pattern(load, system.size()));
    constant += lasting_part(*load.in_time, end_time) * moved;
    if (const auto harmonic = load.in_time->harmonic()) {
      auto& [a, b] = oscillations.try_emplace(harmonic->angular_frequency, 0.0 * moved, 0.0 * moved).first->second;
      a += harmonic->amplitude * std::cos(harmonic->phase) * moved;
      b += harmonic->amplitude * std::sin(harmonic->phase) * moved;
      continue;
    }
    const double size = amplitude(*load.in_time, end_time);
    for (std::size_t i = 0; i < stops.size(); ++i) largest[static_cast<Index>(i)] += size * stops[i].size_of(moved);
  }
  for (const auto& [frequency, moved] : oscillations)
    for (std::size_t i = 0; i < stops.size(); ++i)
      largest[static_cast<Index>(i)] += stops[i].size_of(moved.first, moved.second);
  for (std::size_t i = 0; i < stops.size(); ++i) {
    std::optional<double>& of_kind = (stops[i].turns() ? result.rotations : result.displacements)->static_deflection;
    of_kind = std::max(of_kind.value_or(0.0), largest[static_cast<Index>(i)]);
  }
  result.closed_by_constants =
      std::count_if(stops.begin(), stops.end(), [&](const Stop& stop) { return stop.is_shut(constant); });
}

}  // namespace

Mechanics mechanics_of(const model::System& system, double end_time) {
  Mechanics result;
  const std::vector<Stop> stops = stops_of(system);
  if (stops.empty()) return result;
  Compliance compliance(system);
  result.shortest_contact = dynamics::shortest_impact(system);
  const auto stride = std::max<std::size_t>(1, stops.size() / kMostSamples);
  for (std::size_t i = 0; i < stops.size(); i += stride) {
    const Stop& stop = stops[i];
    const Vector unit = stop.unit(system.size());
    const double k = stop.stiffness();
    if (compliance.exists()) {
      const double ratio = k * unit.dot(compliance.times(unit));
      result.least_ratio = std::min(result.least_ratio.value_or(ratio), ratio);
      result.largest_ratio = std::max(result.largest_ratio.value_or(ratio), ratio);
    }
    ++result.sampled;
  }
  for (const Stop& stop : stops) {
    std::optional<Mechanics::Play>& of_kind = stop.turns() ? result.rotations : result.displacements;
    if (!of_kind) of_kind = {.smallest_gap = stop.gap(), .static_deflection = {}};
    of_kind->smallest_gap = std::min(of_kind->smallest_gap, stop.gap());
    result.closed_at_start += stop.is_shut(system.initial_displacement) ? 1 : 0;
  }
  if (compliance.exists()) add_statics(system, compliance, stops, end_time, result);
  return result;
}

bool acts_on_rotation(const model::System& system, const model::FreeStops& stops) {
  return is_rotation(system.dofs.free()[static_cast<std::size_t>(std::max(stops.a[0], stops.b[0]))].kind);
}

std::optional<ResidualPull> residual_pull(const model::System& system) {
  Vector force = Vector::Zero(system.size());
  std::optional<ResidualPull> largest;
  for (const auto& stops : system.stops) {
    const double pull = (stops.play.has_positive() ? 1.0 : -1.0) * stops.law->asymptotic_force();
    if (pull == 0.0 || stops.size() == 0) continue;
    if (!largest) largest = {.stops = &stops, .displacement = {}};
    for (std::size_t i = 0; i < stops.size(); ++i) {
      if (stops.a[i] >= 0) force[stops.a[i]] += pull;
      if (stops.b[i] >= 0) force[stops.b[i]] -= pull;
    }
  }
  if (!largest) return largest;
  Compliance compliance(system);
  if (!compliance.exists()) return largest;
  const Vector moved = compliance.times(force);
  largest->displacement = 0.0;
  for (const auto& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i) {
      const double displacement =
          std::abs((stops.a[i] >= 0 ? moved[stops.a[i]] : 0.0) - (stops.b[i] >= 0 ? moved[stops.b[i]] : 0.0));
      if (displacement * largest->stops->play.gap > *largest->displacement * stops.play.gap)
        largest = {.stops = &stops, .displacement = displacement};
    }
  return largest;
}

}  // namespace butee::app::check
