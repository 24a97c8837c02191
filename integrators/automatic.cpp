#include "integrators/automatic.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
#include "integrators/active_part.hpp"
#include "integrators/dormand_prince.hpp"
#include "integrators/exact.hpp"
#include "integrators/exponential/exponential.hpp"
#include "integrators/exponential/varying_forces.hpp"
#include "integrators/extrapolation.hpp"
#include "integrators/fastest_rates.hpp"
#include "integrators/methods.hpp"
#include "integrators/piecewise.hpp"
#include "integrators/rodas4.hpp"

namespace butee::integrators {

namespace {

/// Up to this number of DOFs the modes are computed within a millisecond.
constexpr Index kSmall = 96;

struct Cost {
  double exponential, rodas4;  ///< s
};

/// Estimated cost of a run to `end_time`, to about a factor of two. Step counts and times per step
/// were measured on beams of 68 to 600 DOFs with a stop at every node, from 3 ms to 0.3 s at a
/// tolerance of 1e-3. Another machine changes all of them by about the same factor.
Cost estimate(dynamics::Dynamics& dynamics, double tolerance, double end_time) {
  const auto& contact = dynamics.stops();
  const model::System& system = dynamics.system();
  const Vector stiffness = contact.closed_stiffness();
  double square = 0.0;
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)})
      if (dof >= 0) square = std::max(square, stiffness[i] / system.mass.coeff(dof, dof));
  const double n = static_cast<double>(dynamics.size()), m = static_cast<double>(contact.size());
  const double turns = std::sqrt(square) * end_time, finer = std::pow(1e-3 / tolerance, 0.25);
  const double modes = 8e-10 * n * n * n;
  return {modes + (30.0 + 0.8 * turns * finer) * 5e-10 * n * n,
          (0.8 * n + 4.0 * turns) * finer * (6e-8 * n + 1.1e-11 * m * m * m)};
}

/// Up to this number of DOFs the closed form between two changes of contact costs less than steps;
/// the limit is higher for tight tolerances (plugins/auto/run-times.md).
constexpr Index kFew = 4, kFewAtTight = 6;
constexpr double kTight = 1e-5;
/// From this tolerance on steps of low order suffice (plugins/auto/run-times.md).
constexpr double kLoose = 1e-4;

/// True for few DOFs with linear stops whose contact states have modes. If damping does not couple
/// modes, all contact states have them; otherwise those with none, one or all stops closed are
/// checked.
bool suits_piecewise(dynamics::Dynamics& dynamics, double tolerance, double end_time) {
  const Index contacts = dynamics.contact_count();
  if (dynamics.size() > (tolerance <= kTight ? kFewAtTight : kFew) || contacts == 0 ||
      !SmallSystem::obstacle_to(dynamics).empty())
    return false;
  try {
    const SmallSystem system(dynamics);
    std::vector<bool> closed(system.stops.size(), false);
    const ContactStateFlow open(system, closed, end_time);
    if (dynamics.size() == 1 || !dynamics.has_damping()) return true;
    for (std::size_t i = 0; i < closed.size(); ++i) {
      closed.assign(closed.size(), false);
      closed[i] = true;
      const ContactStateFlow one(system, closed, end_time);
    }
    closed.assign(closed.size(), true);
    const ContactStateFlow all(system, closed, end_time);
  } catch (const RunError&) {
    return false;
  }
  return true;
}

/// True if a load has one value throughout a run.
bool is_constant(const model::TimeFunction& load, double end_time) {
  if (const auto harmonic = load.harmonic()) return harmonic->amplitude == 0.0 || harmonic->angular_frequency == 0.0;
  // A parabola with three equal values is a constant.
  return load.is_piecewise_parabolic() && load.discontinuities().empty() && load.value(0.0) == load.value(end_time) &&
         load.value(0.0) == load.value(0.5 * end_time);
}

/// True if the structure starts in its static position and nothing moves it away: steps may have any length, but those
/// of methods that follow closed stops have the periods of these.
bool stays_static(dynamics::Dynamics& dynamics, double end_time) {
  const model::System& system = dynamics.system();
  const model::Model* model = system.model;
  return dynamics.stop_count() > 0 && model != nullptr && model->starts_static && model->initial_velocity.empty() &&
         model->bases.empty() && system.rotation == nullptr && system.obstacles.empty() &&
         std::all_of(system.loads.begin(), system.loads.end(),
                     [&](const model::FreeLoad& load) { return is_constant(*load.in_time, end_time); });
}

/// True if the force of a stop jumps in the middle of its gap.
bool has_jump(dynamics::Dynamics& dynamics) {
  const dynamics::ElasticStops& contact = dynamics.stops();
  for (Index i = 0; i < contact.size(); ++i)
    if (contact.play_of(i).has_both() && contact.law_of(i).asymptotic_force() > 0.0) return true;
  return false;
}

/// Whether damped modes are worth their cost, beside a run by rodas4. All costs in s, to a factor of two, were measured
/// on pipes of 136 to 560 DOFs in rings (plugins/auto/run-times.md); another machine changes all of them by about the
/// same factor.
class DampedModesBudget {
 public:
  DampedModesBudget(dynamics::Dynamics& dynamics, double tolerance, double end_time)
      : size_(dynamics.size()), most_(kPart * cost_of_rodas4(dynamics, tolerance, end_time)) {}

  /// True if it covers the natural modes.
  bool suffices() const {
    return size_ <= kQuick || (size_ <= dynamics::DampedModes::kMost && kOfNatural * cube(size_) < most_);
  }
  bool covers(double cost) const { return cost < most_; }
  /// The largest number of coupled modes whose damped modes it covers.
  Index most_coupled() const {
    return static_cast<Index>(
        std::clamp(std::cbrt(most_ / kOfCoupled), static_cast<double>(kQuick), static_cast<double>(kMostCoupled)));
  }

 private:
  /// Up to this number of DOFs the modes are always computed, in 0.1 s.
  static constexpr Index kQuick = 140;
  /// s over the cube of the number of DOFs, and over that of the number of coupled modes.
  static constexpr double kOfNatural = 1.5e-9, kOfCoupled = 1.7e-8;
  /// Chosen: without contact rodas4 is faster than estimated; the damped modes of a block take 1.1 s at most.
  static constexpr double kPart = 0.3;
  static constexpr Index kMostCoupled = 400;

  static double cube(Index n) { return std::pow(static_cast<double>(n), 3.0); }
  /// 1.4 steps for each radian of the fastest DOF at a tolerance of 1e-3.
  static double cost_of_rodas4(dynamics::Dynamics& dynamics, double tolerance, double end_time) {
    const double radians = fastest_rates(dynamics).open * end_time, finer = std::pow(1e-3 / tolerance, 0.25);
    return 1.4 * radians * finer * 3e-7 * static_cast<double>(dynamics.size());
  }

  Index size_;
  double most_;  ///< s
};

/// True if a body that the regularised friction of a support holds creeps at a rate far above that of the structure:
/// all methods but L-stable ones then take steps of that rate (plugins/auto/run-times.md).
bool creeps(const FastestRates& rates, double tolerance) {
  // The steps of rodas4, of order 4, shorten with the tolerance; those of exponential, of order 10, hardly do.
  constexpr double kCreeps = 20.0, kLoosest = 1e-3;
  return rates.friction > kCreeps * std::pow(kLoosest / std::min(kLoosest, tolerance), 0.25) * rates.open;
}

/// True if a body may move around within a contact: a ring.
bool has_ring(const dynamics::Obstacles& obstacles) {
  using Form = model::ContactShape::Form;
  for (Index i = 0; i < obstacles.size(); ++i) {
    const model::ObstacleGroup& group = obstacles.group_of(i);
    if (group.shape == nullptr || group.directions.size() != 2) continue;
    if (const Form form = group.shape->form(); form.kind == Form::Kind::circle && form.sense > 0.0) return true;
  }
  return false;
}

/// True if `exponential` supports the scene with damped modes.
bool suits_collocation(dynamics::Dynamics& dynamics, const FastestRates& rates, double tolerance) {
  const model::System& system = dynamics.system();
  if (!needs_collocation(system) || creeps(rates, tolerance)) return false;
  // If the speed of turning parts varies, all their DOFs take part in the sweeps of each step; rodas4 is faster if
  // damping leaves its steps to the slow modes (apps/models/rotor.toml: 1.4 times).
  if (system.rotation != nullptr && rates.damping > rates.open) return false;
  for (Index i = 0; i < dynamics.stop_count(); ++i)
    if (!dynamics.stops().law_of(i).is_silent_while_open()) return false;
  for (const model::FreeObstacles& obstacles : system.obstacles)
    if (obstacles.group->friction.rule == model::Friction::Rule::rigid ||
        (obstacles.group->law != nullptr && !obstacles.group->law->is_silent_while_open()))
      return false;
  return std::all_of(system.loads.begin(), system.loads.end(), [](const model::FreeLoad& load) {
    return load.in_time->harmonic() || load.in_time->is_piecewise_parabolic() || VaryingForces::contains(load);
  });
}

/// A method that follows every frequency by steps of high order, for tolerances at which others need many more steps.
/// exact takes 2 to 3 rad of the fastest mode a step, extrapolation8 less and the less the tighter the tolerance.
/// Times in s for each radian and DOF, to a factor of three, from the pipes and beams of plugins/auto/run-times.md. A
/// structure whose fastest DOFs are at rest may be cheaper by rodas4, so that only runs of seconds are taken.
class HighOrder {
 public:
  HighOrder(dynamics::Dynamics& dynamics, Goal goal)
      : dynamics_(dynamics),
        goal_(goal),
        work_(static_cast<double>(dynamics.size()) * fastest_rates(dynamics).any() * goal.run_time) {}

  bool is_wanted() const { return goal_.tolerance <= kTightest; }

  /// Null if it would take long, or refuses the scene.
  std::unique_ptr<time::Integrator> exact() const {
    if (kOfExact * work_ > kMost) return nullptr;
    try {
      return std::make_unique<Exact>(dynamics_, Exact::kOrder, Exact::kSeriesTolerance);
    } catch (const InputError&) {
      return nullptr;
    }
  }
  std::unique_ptr<time::Integrator> extrapolation8() const {
    return kOfExtrapolation * work_ > kMost ? nullptr : std::make_unique<Extrapolation>(dynamics_, goal_);
  }

 private:
  /// Chosen: at 1e-7 rodas4 and exact take about as long where the fastest modes hardly move.
  static constexpr double kTightest = 1e-7;
  static constexpr double kOfExact = 2e-7, kOfExtrapolation = 1e-6, kMost = 3.0;

  dynamics::Dynamics& dynamics_;
  Goal goal_;
  double work_;
};

/// An explicit method. Impacts move the fastest modes of a structure, so that implicit methods have to follow them as
/// well, at a multiple of the cost per step, unless damping leaves their steps to the slow modes.
Choice explicit_method(dynamics::Dynamics& dynamics, double tolerance, std::string why) {
  const bool is_small = dynamics.size() <= kFew && tolerance >= kLoose;
  return {is_small ? Choice::Method::dopri5 : Choice::Method::extrapolation8, std::move(why)};
}

/// For contacts in the plane, with dissipation or friction, that `exponential` does not treat.
Choice choose_for_obstacles(dynamics::Dynamics& dynamics, const FastestRates& rates, double tolerance) {
  using Method = Choice::Method;
  if (dynamics.obstacles()->has_rigid_friction())
    return {Method::dopri5, "contacts stick rigidly; it locates the changes, and implicit methods cannot treat them"};
  if (dynamics::has_infinite_slope(*dynamics.obstacles()))
    return explicit_method(dynamics, tolerance, "the slope of a contact's dissipation is infinite where it closes");
  if (creeps(rates, tolerance))
    return {Method::rodas4, "friction supports hold bodies that creep, and its steps may exceed the time of that"};
  const std::string contacts = "contacts act in the plane, with dissipation or friction, ";
  if (rates.damping > rates.open)
    return {Method::rodas4, contacts + "and damping leaves the steps of an implicit method to the slow modes"};
  if (dynamics.size() > dynamics::ModalSystem::kAllModes)
    return {Method::rodas4, contacts + "and most of a large structure hardly moves"};
  return explicit_method(dynamics, tolerance, contacts + "and keep the fastest modes in motion");
}

std::unique_ptr<time::Integrator> make_rodas4(dynamics::Dynamics& dynamics, const Goal& goal) {
  return std::make_unique<Rodas4>(dynamics, goal);
}

/// Null if it refuses the scene, with the reason.
std::unique_ptr<time::Integrator> exponential_or_reason(dynamics::Dynamics& dynamics, const ExponentialOptions& options,
                                                        std::string& reason) {
  try {
    return make_exponential(dynamics, options);
  } catch (const ToleranceBelowRounding&) {
    reason = "rounding in the modes exceeds the tolerance";
  } catch (const InputError& error) {
    reason = error.what();
    if (const std::string key = "integrator.type: "; reason.starts_with(key)) reason.erase(0, key.size());
  }
  return nullptr;
}

}  // namespace

Choice choose(dynamics::Dynamics& dynamics, double tolerance, double end_time) {
  using Method = Choice::Method;
  const Index n = dynamics.size(), most = dynamics::ModalSystem::kAllModes;
  const std::string size = std::to_string(n) + (n == 1 ? " DOF" : " DOFs");
  if (suits_piecewise(dynamics, tolerance, end_time))
    return {Method::piecewise, size + " with linear stops, so that the motion between impacts is known in closed form"};
  if (stays_static(dynamics, end_time))
    return {Method::rodas4, "the structure stays in its static position, where steps of any length are right"};
  const FastestRates rates = fastest_rates(dynamics);
  const bool is_singular = dynamics.obstacles() != nullptr && dynamics::has_infinite_slope(*dynamics.obstacles());
  // Where a slope is infinite, collocation takes more steps than explicit methods if there is no fast motion beside it.
  // In a ring a rotor may whirl on and on, which takes explicit methods far longer (plugins/auto/run-times.md).
  if (is_singular && n <= kFewAtTight && !has_ring(*dynamics.obstacles()))
    return choose_for_obstacles(dynamics, rates, tolerance);
  const bool is_too_tight = dynamics.stop_count() > 0 && tolerance < kSmallestWithStops;
  const char* const too_tight = "the tolerance is below the smallest one of exponential with stops";
  if (suits_collocation(dynamics, rates, tolerance) && DampedModesBudget(dynamics, tolerance, end_time).suffices()) {
    if (is_too_tight && is_singular) return choose_for_obstacles(dynamics, rates, tolerance);
    if (is_too_tight) return {Method::rodas4, too_tight};
    return {Method::exponential, "the linear part is exact in its damped modes, and only contacts are approximated"};
  }
  if (dynamics.obstacles() != nullptr) return choose_for_obstacles(dynamics, rates, tolerance);
  if (!dynamics.system().is_symmetric)
    return {Method::rodas4,
            "shafts turn, or bearings or given matrices have cross terms, so that the matrices are not symmetric"};
  if (n > most) return {Method::rodas4, size + " are too many for all their modes"};
  if (n > 1 && dynamics.system().dashpots.size() > 0) return {Method::rodas4, "dashpots couple the modes"};
  for (const model::FreeLoad& load : dynamics.system().loads)
    if (!load.in_time->harmonic() && !load.in_time->is_piecewise_parabolic())
      return {Method::rodas4, "a load is neither harmonic nor made of straight lines or parabolas in time"};
  if (dynamics.stop_count() == 0) return {Method::exponential, "there are no stops, so that it is exact at any step"};
  if (is_too_tight) return {Method::rodas4, too_tight};
  if (n > kSmall) {
    const Cost cost = estimate(dynamics, tolerance, end_time);
    // The estimate for rodas4 is that of motion without fast modes, which a pulse or an impact may set in motion.
    if (cost.rodas4 < cost.exponential && !DampedModesBudget(dynamics, tolerance, end_time).covers(cost.exponential))
      return {Method::rodas4, "the modes of " + size + " would take longer to compute than this short run"};
  }
  return {Method::exponential, "all modes of " + size + " are used; only the stops are approximated"};
}

std::unique_ptr<time::Integrator> make_automatic(dynamics::Dynamics& dynamics, double tolerance, double end_time) {
  Choice choice = choose(dynamics, tolerance, end_time);
  const std::string with = " with tolerance " + to_short_text(tolerance);
  std::unique_ptr<time::Integrator> integrator;
  if (choice.method == Choice::Method::exponential) {
    std::string reason;
    integrator =
        exponential_or_reason(dynamics,
                              {.tolerance = tolerance,
                               .run_time = end_time,
                               .most_coupled = DampedModesBudget(dynamics, tolerance, end_time).most_coupled()},
                              reason);
    if (integrator == nullptr) {
      choice.method = dynamics.obstacles() == nullptr
                          ? Choice::Method::rodas4
                          : choose_for_obstacles(dynamics, fastest_rates(dynamics), tolerance).method;
      choice.why = reason;
    } else if (!integrator->choice().empty()) {
      choice.why = integrator->choice();
    }
  }
  const HighOrder high(dynamics, {tolerance, end_time});
  const bool takes_steps = choice.method == Choice::Method::rodas4 || choice.method == Choice::Method::dopri5 ||
                           choice.method == Choice::Method::extrapolation8;
  // Where damping leaves the steps of rodas4 to slow motion they are long at any tolerance, unless the force of a stop
  // jumps.
  const FastestRates rates = fastest_rates(dynamics);
  const bool is_damped = choice.method == Choice::Method::rodas4 &&
                         (rates.damping > rates.open || creeps(rates, tolerance)) && !has_jump(dynamics);
  if (high.is_wanted() && takes_steps && !is_damped && !stays_static(dynamics, end_time)) {
    if ((integrator = high.exact()) != nullptr)
      choice.method = Choice::Method::exact;
    else if (choice.method == Choice::Method::rodas4 && (integrator = high.extrapolation8()) != nullptr)
      choice.method = Choice::Method::extrapolation8;
    if (integrator != nullptr) choice.why += "; steps of high order suit the tolerance";
  }
  std::string what;
  if (choice.method == Choice::Method::exponential) {
    what = "exponential" + with;
  } else if (choice.method == Choice::Method::piecewise) {
    what = "piecewise";
    integrator = std::make_unique<Piecewise>(dynamics, end_time);
  } else if (choice.method == Choice::Method::exact) {
    what = "exact";
  } else if (choice.method == Choice::Method::extrapolation8) {
    what = "extrapolation8" + with;
    if (integrator == nullptr) integrator = std::make_unique<Extrapolation>(dynamics, Goal{tolerance, end_time});
  } else if (choice.method == Choice::Method::dopri5) {
    what = "dopri5" + with;
    integrator = std::make_unique<DormandPrince>(dynamics, Goal{tolerance, end_time});
  } else if (ActivePart::can_take(dynamics, tolerance)) {
    what = "rodas4" + with + " on the moving part";
    integrator = std::make_unique<ActivePart>(dynamics, Goal{tolerance, end_time}, make_rodas4);
  } else {
    what = "rodas4" + with;
    integrator = make_rodas4(dynamics, {tolerance, end_time});
  }
  integrator->set_choice(what + ": " + choice.why);
  return integrator;
}

time::IntegratorType auto_type() {
  return {.name = "auto",
          .aliases = {"AUTO"},
          .summary = "chooses a method for the scene; the default",
          .parameters = {LocalErrorControl::parameter(1e-4, 1e-10)},
          .finds_first_step = true,
          .contacts = time::ContactSupport::all,
          .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return make_automatic(dynamics, p.number("tolerance"), p.number("end_time"));
          }};
}

}  // namespace butee::integrators
