#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace butee::test {

/// One of the seven methods, with parameters for a relative accuracy of about 1e-5 on an oscillator of 20
/// rad/s.
struct Method {
  std::string name;
  std::vector<std::string> settings;

  std::vector<std::string> overrides() const {
    std::vector<std::string> all = {"integrator.type=" + name};
    for (const std::string& setting : settings) all.push_back("integrator." + setting);
    return all;
  }
};

inline std::ostream& operator<<(std::ostream& stream, const Method& method) {
  return stream << method.name;
}

inline std::vector<Method> all_methods() {
  const std::string fine = "time_step=1e-4", target = "target_error=3e-7";
  const std::vector<std::string> newton = {"residual_tolerance=1e-11", "increment_tolerance=1e-11",
                                           "max_iterations=20"};
  std::vector<std::string> newmark = newton, adaptive = newton;
  newmark.push_back(fine);
  adaptive.insert(adaptive.end(), {fine, target});
  return {{"rk4", {"time_step=1e-3"}},
          {"rk4_fixed_factors", {"time_step=1e-4", "tolerance=1e-10", "shrink=1.1", "grow=1.01"}},
          {"rk4_error_scaled", {"time_step=1e-4", "tolerance=1e-10", "safety=0.9"}},
          {"newmark", newmark},
          {"newmark_adaptive", adaptive},
          {"newmark_modified", {fine}},
          {"newmark_modified_adaptive", {fine, target}}};
}

}  // namespace butee::test
