#include "integrators/automatic.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
#include "integrators/active_part.hpp"
#include "integrators/exponential.hpp"
#include "integrators/methods.hpp"
#include "integrators/rodas4.hpp"

namespace butee::integrators {

namespace {

/// Systems up to this size have their modes within a millisecond.
constexpr Index kSmall = 96;

struct Cost {
  double exponential, rodas4;  ///< s
};

/// What a run to `end_time` would cost, to a factor of two or so. Step counts and times a step were measured on beams
/// of 68 to 600 DOFs with a stop at every node, from 3 ms to 0.3 s at a tolerance of 1e-3; other machines differ in all
/// of them alike.
Cost estimate(solve::Dynamics& dynamics, double tolerance, double end_time) {
  const auto& contact = dynamics.contact();
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

std::unique_ptr<time::Integrator> make_rodas4(solve::Dynamics& dynamics, const Goal& goal) {
  return std::make_unique<Rodas4>(dynamics, goal);
}

}  // namespace

Choice choose(solve::Dynamics& dynamics, double tolerance, double end_time) {
  using Method = Choice::Method;
  const Index n = dynamics.size(), most = solve::ModalSystem::kAllModes;
  const std::string size = std::to_string(n) + " DOFs";
  if (n > most) return {Method::rodas4, size + " are too many to take all their modes"};
  if (n > 1 && dynamics.system().dashpots.size() > 0) return {Method::rodas4, "dashpots couple the modes"};
  if (dynamics.stop_count() == 0) return {Method::exponential, "there are no stops, so that it is exact at any step"};
  if (n > kSmall) {
    const Cost cost = estimate(dynamics, tolerance, end_time);
    if (cost.rodas4 < cost.exponential)
      return {Method::rodas4, "the modes of " + size + " would take longer than so short a run"};
  }
  return {Method::exponential, size + " have all their modes, and the stops alone are left to approximate"};
}

std::unique_ptr<time::Integrator> make_automatic(solve::Dynamics& dynamics, double tolerance, double end_time) {
  const Choice choice = choose(dynamics, tolerance, end_time);
  const std::string with = " with tolerance " + to_short_text(tolerance);
  std::unique_ptr<time::Integrator> integrator;
  std::string what;
  if (choice.method == Choice::Method::exponential) {
    what = "exponential" + with;
    integrator = make_exponential(dynamics, {tolerance, 6, 0});
  } else if (ActivePart::can_take(dynamics, tolerance)) {
    what = "rodas4" + with + " on the part that moves";
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
          .summary = "looks at the scene and takes the method that suits it; the default",
          .parameters = {LocalErrorControl::parameter(1e-4, 1e-10)},
          .finds_first_step = true,
          .make = [](const config::Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return make_automatic(dynamics, p.number("tolerance"), p.number("end_time"));
          }};
}

}  // namespace butee::integrators
