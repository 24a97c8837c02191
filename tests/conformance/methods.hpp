#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace butee::test {

/// One method with the data that the suite needs, and keys with which it runs.
struct MethodCase {
  std::string name;
  std::string keys;  ///< TOML lines of [integrator] in addition to time_step and end_time
  double order;      ///< order for smooth problems, in x and v; 0 for adaptive methods
  /// Order of an adaptive method's formula with equal steps; 0 if the suite does not test it.
  double order_of_equal_steps = 0.0;

  bool is_implicit = false;    ///< factorizes a matrix for each step size
  bool takes_dashpots = true;  ///< accepts dashpots that couple the modes
  bool takes_smooth_laws = true;
  bool is_for_few_dofs = false;

  double step_order() const { return order > 0.0 ? order : order_of_equal_steps; }
};

inline void PrintTo(const MethodCase& method, std::ostream* out) {
  *out << method.name;
}

/// Every method of the catalogue; a test checks that the list is complete.
inline std::vector<MethodCase> method_cases() {
  const std::string newton = "residual_tolerance = 1e-13\nincrement_tolerance = 1e-13\nmax_iterations = 20\n";
  std::vector<MethodCase> all = {{"exact", "", 0.0},
                                 {"piecewise", "", 0.0, 0.0, false, true, false, true},
                                 {"exponential", "tolerance = 1e-6\n", 0.0, 0.0, false, false},
                                 {"rk4", "", 4.0},
                                 {"newmark", newton, 2.0, 0.0, true},
                                 {"newmark_modified", "", 2.0, 0.0, true},
                                 {"rk4_fixed_factors", "tolerance = 1e-7\nshrink = 1.5\ngrow = 1.5\n", 0.0, 4.0},
                                 {"rk4_error_scaled", "tolerance = 1e-7\nsafety = 0.9\n", 0.0, 4.0},
                                 {"newmark_adaptive", newton + "target_error = 1e-5\n", 0.0, 2.0, true},
                                 {"newmark_modified_adaptive", "target_error = 1e-5\n", 0.0, 2.0, true}};
  for (const std::string name : {"generalized_alpha", "hht_alpha", "bathe", "discrete_gradient"}) {
    all.push_back({name, "", 2.0, 0.0, true});
    all.push_back({name + "_adaptive", "tolerance = 1e-4\n", 0.0, 2.0, true});
  }
  all.push_back({"auto", "tolerance = 1e-6\n", 0.0, 0.0, false, true});
  all.push_back({"rodas4", "tolerance = 1e-5\n", 0.0, 4.0, true});
  all.push_back({"dopri5", "tolerance = 1e-5\n", 0.0, 5.0});
  all.push_back({"extrapolation8", "tolerance = 1e-6\n", 0.0, 8.0});
  all.push_back({"central_differences", "", 2.0});
  all.push_back({"central_differences_adaptive", "tolerance = 1e-4\n", 0.0, 2.0});
  return all;
}

}  // namespace butee::test
