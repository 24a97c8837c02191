#pragma once

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test {

/// Some methods do not complete a step that they reject; these overrides make them accept every step.
inline std::vector<std::string> accept_all(const MethodCase& method) {
  if (method.name.rfind("rk4_", 0) == 0) return {"integrator.tolerance=1e30"};
  if (method.name == "rodas4" || method.name == "extrapolation8") return {"integrator.tolerance=0.1"};
  return {};
}

/// The states after count/samples, 2 count/samples ... count equal steps from the scene's initial state,
/// without step-size control. An adaptive method thus shows the order of its formula like a fixed-step
/// method.
inline std::vector<time::State> equal_steps(SceneRun& run, double h, int count, int samples = 1) {
  std::vector<time::State> seen;
  time::State from, to;
  from.x = run.system().initial_displacement;
  from.v = run.system().initial_velocity;
  run.integrator().start(from);
  for (int i = 1; i <= count; ++i) {
    EXPECT_EQ(run.integrator().step(from, {h, i * h}, to).status, time::StepStatus::ok);
    std::swap(from, to);
    if (i % (count / samples) == 0) seen.push_back(from);
  }
  return seen;
}

/// The methods with a known order of a single step.
inline std::vector<MethodCase> cases_with_step_order() {
  std::vector<MethodCase> cases = method_cases();
  std::erase_if(cases, [](const MethodCase& method) { return method.step_order() == 0.0; });
  return cases;
}

}  // namespace butee::test
