#pragma once

#include <span>
#include <string>
#include <vector>

#include "band.hpp"

// Beams and an oscillator between elastic stops, hand-written as a reference to check and time other
// programs.
namespace plain {

enum class Law { kArctan, kLinear };
enum class Method { kRk41, kRk42, kRk43, kNm1, kNm2, kNmm1, kNmm2 };

/// M a + C v + K x = F(t) + F_c(x), F(t) = amplitude cos(angular_frequency t) on the loaded DOF, at rest at t = 0.
template <typename Real>
struct ProblemOf {
  Band<Real> mass, damping, stiffness;
  std::vector<int> stops;  // DOFs with a stop
  Law law = Law::kArctan;
  Real gap = 0, contact_stiffness = 0, regularization = 0;
  Real amplitude = 0, angular_frequency = 0;
  int loaded = 0;     // DOF
  int observed = -1;  // a second recorded DOF; negative: none

  int size() const { return mass.size(); }
};
using Problem = ProblemOf<double>;

/// Time step, end time and the parameters of all methods; each method reads only its own.
struct Options {
  double time_step = 1e-5, end_time = 1.0;
  double tolerance = 0, shrink = 0, grow = 0, safety = 0;    // RK4-2, RK4-3
  double newton_tolerance = 1e-7;                            // NM1, NM2
  int max_iterations = 10;                                   // NM1, NM2
  double target_error = 0, band_low = 0.5, band_high = 4.0;  // NM2, NMM2
  double beta = 0.25, gamma = 0.5;                           // all Newmark methods
  std::vector<double> samples;                               // output instants of u, ascending
};

struct Result {
  long steps = 0, rejected = 0, newton = 0, newton_failures = 0;
  double u_end = 0, v_end = 0;    // of the loaded DOF
  double peak_u = 0, peak_v = 0;  // its largest |u| and |v| over t = 0 and all accepted steps
  std::vector<double> u_samples;  // u of the loaded DOF at options.samples, cubic between the steps
  double seconds = 0;             // of the integration alone
  bool completed = true;          // false: the step fell below its lower limit
};

/// Integrates from rest to options.end_time.
Result run(const Problem& problem, Method method, const Options& options);

/// A case of the paper with the parameters of its table; beam4 occurs with two end times.
struct Case {
  std::string name;
  double time_step, end_time;
};
std::span<const Case> cases();
std::span<const Method> methods();
std::string to_string(Method method);
std::string to_string(Law law);
/// Throw std::invalid_argument.
Method method_of(const std::string& name);
Law law_of(const std::string& name);

template <typename Real>
ProblemOf<Real> make_problem(const std::string& name, Law law);
Options make_options(const Case& chosen, Method method);

/// A row of a reference solution: the loaded and the observed DOF.
struct ReferenceRow {
  long double t, u0, v0, fc0, u1, v1, fc1;
};
/// Solves the piecewise linear problem (law = linear) by Taylor series, with every contact change located.
struct Reference {
  std::vector<ReferenceRow> rows;  // at 0, interval, ... count intervals
  long changes = 0;                // number of contact changes
};
Reference solve_reference(const ProblemOf<long double>& problem, long double interval, int count);

}  // namespace plain
