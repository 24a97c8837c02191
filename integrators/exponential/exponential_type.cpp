// The parameters of the method `exponential`, and the choice between its forms.
#include <algorithm>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/frequencies.hpp"
#include "integrators/exponential/exponential.hpp"
#include "integrators/exponential/modal_collocation.hpp"
#include "integrators/local_error.hpp"
#include "integrators/methods.hpp"

namespace butee::integrators {
namespace {

/// Text for the user that describes a truncated basis of modes.
std::string describe_basis(const dynamics::ModalSystem& modal, Index dofs) {
  std::string text = "exponential with the lowest " + std::to_string(modal.size() - modal.static_count()) + " of " +
                     std::to_string(dofs) + " modes";
  if (modal.static_count() > 0)
    text +=
        " and " + std::to_string(modal.static_count()) + " static shapes: the omitted modes contribute up to " +
        to_short_text(100.0 * modal.truncation()) +
        " % of the static displacement at a stop or load; the static shapes include this part for forces slower than " +
        to_short_text(modal.highest_mode()) +
        " rad/s, and the error for faster forces does not depend on the tolerance";
  else
    text += ": the contribution of the others is omitted at any tolerance";
  return text + "; give more modes, or use another type, if this error is too large";
}

std::unique_ptr<time::Integrator> make_collocation(dynamics::Dynamics& dynamics, const ExponentialOptions& options) {
  auto integrator =
      std::make_unique<ModalCollocation>(dynamics, Goal{options.tolerance, options.run_time}, options.most_coupled);
  const double smallest = integrator->smallest_tolerance();
  if (options.tolerance >= smallest) return integrator;
  const std::string cause =
      ", since some modes are almost parallel, as for free or critically damped motion with dashpots, or far faster "
      "than others";
  throw ToleranceBelowRounding(
      smallest > LocalErrorControl::kLargestTolerance
          ? "integrator.type: exponential cannot run this scene: rounding exceeds the error bound of any tolerance" +
                cause
          : "integrator.tolerance: must be at least " + to_short_text(smallest) +
                " for exponential here: below it rounding exceeds the error bound" + cause);
}

}  // namespace

bool needs_collocation(const model::System& system) {
  return !system.is_symmetric || system.rotation != nullptr || !system.obstacles.empty() ||
         (system.dashpots.size() > 0 && (system.size() > 1 || system.dashpots.coeff(0, 0) < 0.0)) ||
         std::any_of(system.loads.begin(), system.loads.end(), VaryingForces::contains);
}

std::unique_ptr<time::Integrator> make_exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options) {
  if (dynamics.stop_count() > 0 && options.tolerance < kSmallestWithStops)
    throw InputError("integrator.tolerance: must be at least " + to_short_text(kSmallestWithStops) +
                     " for exponential with stops: below it the errors of many impacts exceed the error bound");
  if (needs_collocation(dynamics.system())) return make_collocation(dynamics, options);
  try {
    if (SingleStep::can_take(dynamics)) return std::make_unique<Exponential<SingleStep>>(dynamics, options);
    auto integrator = std::make_unique<Exponential<ExponentialStep>>(dynamics, options);
    const dynamics::ModalSystem& modal = dynamics.modal(options.modes);
    if (!modal.is_complete()) integrator->set_choice(describe_basis(modal, dynamics.size()));
    return integrator;
  } catch (const dynamics::UnstableStiffness&) {
    if (dynamics.size() > dynamics::DampedModes::kMost) throw;
    auto integrator = make_collocation(dynamics, options);
    integrator->set_choice("damped modes, since the stiffness has a negative eigenvalue");
    return integrator;
  }
}

time::IntegratorType exponential_type() {
  return {
      .name = "exponential",
      .aliases = {"EXP"},
      .summary = "exact linear part, mode by mode; stops by projection of their force; adaptive",
      .parameters = {LocalErrorControl::parameter(1e-4, 1e-10),
                     config::integer("modes",
                                     "the number of lowest modes; 0: all up to 600 DOFs, 300 above, with static shapes")
                         .at_least(0)
                         .or_else(std::int64_t{0})},
      .finds_first_step = true,
      .contacts = time::ContactSupport::without_rigid,
      .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
        return make_exponential(dynamics, {.tolerance = p.number("tolerance"),
                                           .run_time = p.number("end_time"),
                                           .modes = static_cast<Index>(p.integer("modes"))});
      }};
}

}  // namespace butee::integrators
