#include "integrators/automatic.hpp"

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
#include "integrators/exponential.hpp"
#include "integrators/methods.hpp"
#include "integrators/rodas4.hpp"

namespace butee::integrators {

Choice choose(const solve::Dynamics& dynamics) {
  using Method = Choice::Method;
  const Index n = dynamics.size(), most = solve::ModalSystem::kAllModes;
  const std::string size = std::to_string(n) + " DOFs";
  if (n > most) return {Method::rodas4, size + " are too many to take all their modes"};
  if (n > 1 && dynamics.system().dashpots.size() > 0) return {Method::rodas4, "dashpots couple the modes"};
  if (dynamics.stop_count() == 0) return {Method::exponential, "there are no stops, so that it is exact at any step"};
  return {Method::exponential, size + " have all their modes, and the stops alone are left to approximate"};
}

std::unique_ptr<time::Integrator> make_automatic(solve::Dynamics& dynamics, double tolerance) {
  const Choice choice = choose(dynamics);
  std::unique_ptr<time::Integrator> integrator;
  std::string name;
  if (choice.method == Choice::Method::exponential) {
    name = "exponential";
    integrator = make_exponential(dynamics, {tolerance, 6, 0});
  } else {
    name = "rodas4";
    integrator = std::make_unique<Rodas4>(dynamics, tolerance);
  }
  integrator->set_choice(name + " with tolerance " + to_short_text(tolerance) + ": " + choice.why);
  return integrator;
}

time::IntegratorType auto_type() {
  return {"auto",
          {"AUTO"},
          "looks at the scene and takes the method that suits it; the default",
          {LocalErrorControl::parameter(1e-4)},
          kUnconditional,
          [](const config::Parameters& p, solve::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return make_automatic(dynamics, p.number("tolerance"));
          },
          {},
          false,
          true};
}

}  // namespace butee::integrators
