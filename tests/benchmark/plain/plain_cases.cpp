#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "plain.hpp"

namespace plain {
namespace {

constexpr std::array<Method, 7> kMethods = {Method::kRk41, Method::kRk42, Method::kRk43, Method::kNm1,
                                            Method::kNm2,  Method::kNmm1, Method::kNmm2};
constexpr std::array<const char*, 7> kMethodNames = {"RK4-1", "RK4-2", "RK4-3", "NM1", "NM2", "NMM1", "NMM2"};
constexpr int kElements = 34;
constexpr double kTwoPi = 6.283185307179586;

/// The parameters of a case in the paper's tables.
struct Parameters {
  double rk42_tolerance, shrink, grow;
  double rk43_tolerance, safety;
  double newton_tolerance, nm2_target, nmm2_target;
};

Parameters parameters_of(const Case& chosen) {
  if (chosen.name == "oscillator" && chosen.time_step == 1e-5) return {1e-5, 1.1, 1.01, 1e-4, 0.5, 1e-9, 1e-4, 5e-5};
  if (chosen.name == "oscillator") return {1e-5, 1.12, 1.01, 5e-5, 0.5, 1e-9, 5e-5, 5e-5};
  if (chosen.name == "beam3") return {1e-2, 1.1, 2.0, 1e-3, 0.9, 1e-7, 1e-3, 1e-3};
  if (chosen.name == "beam4") return {1e-7, 1.1, 2.0, 1e-7, 0.55, 1e-7, 4e-5, 4e-5};
  return {1e-1, 1.1, 1.01, 1e-1, 0.9, 1e-7, 1e-2, 1e-2};
}

/// Adds an element matrix of the DOFs (u_1, theta_1, u_2, theta_2) to the pinned beam, which lacks the first
/// and the last u.
template <typename Real>
void add_element(Band<Real>& a, int element, const Real (&entries)[4][4]) {
  const int last = 2 * kElements;  // number of the last u before the two are removed
  const auto place = [last](int dof) { return dof == 0 || dof == last ? -1 : dof < last ? dof - 1 : dof - 2; };
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const int row = place(2 * element + i), column = place(2 * element + j);
      if (row >= 0 && column >= 0) a.add(row, column, entries[i][j]);
    }
}

template <typename Real>
ProblemOf<Real> make_oscillator() {
  ProblemOf<Real> p;
  p.mass = p.damping = p.stiffness = Band<Real>(1);
  p.mass.add(0, 0, 100);
  p.damping.add(0, 0, 50);
  p.stiffness.add(0, 0, Real(1e9));
  p.stops = {0};
  p.gap = Real(4e-4);
  p.contact_stiffness = Real(1e10);
  p.amplitude = 201240;
  p.angular_frequency = Real(1256.6);
  return p;
}

template <typename Real>
ProblemOf<Real> make_beam(Real contact_stiffness, Real amplitude, Real angular_frequency) {
  const Real young_modulus = Real(2.03e11), density = 7900, outer = Real(0.06), inner = Real(0.04);
  const Real pi = std::acos(Real(-1));
  const Real l = Real(35) / kElements;
  const Real area = pi * (outer * outer - inner * inner);
  const Real second_moment = pi / 4 * (outer * outer * outer * outer - inner * inner * inner * inner);
  const Real k = young_modulus * second_moment / (l * l * l);
  const Real m = density * area * l / 420;
  const Real element_stiffness[4][4] = {{12 * k, 6 * l * k, -12 * k, 6 * l * k},
                                        {6 * l * k, 4 * l * l * k, -6 * l * k, 2 * l * l * k},
                                        {-12 * k, -6 * l * k, 12 * k, -6 * l * k},
                                        {6 * l * k, 2 * l * l * k, -6 * l * k, 4 * l * l * k}};
  const Real element_mass[4][4] = {{156 * m, 22 * l * m, 54 * m, -13 * l * m},
                                   {22 * l * m, 4 * l * l * m, 13 * l * m, -3 * l * l * m},
                                   {54 * m, 13 * l * m, 156 * m, -22 * l * m},
                                   {-13 * l * m, -3 * l * l * m, -22 * l * m, 4 * l * l * m}};
  ProblemOf<Real> p;
  p.mass = p.damping = p.stiffness = Band<Real>(2 * kElements);
  for (int e = 0; e < kElements; ++e) {
    add_element(p.stiffness, e, element_stiffness);
    add_element(p.mass, e, element_mass);
  }
  for (std::size_t k_lower = 0; k_lower < p.mass.lower.size(); ++k_lower)
    for (int i = 0; i < p.size(); ++i) p.damping.lower[k_lower][i] = Real(0.03) * p.mass.lower[k_lower][i];
  for (int node = 1; node < kElements; ++node) p.stops.push_back(2 * node - 1);
  p.gap = Real(0.01);
  p.contact_stiffness = contact_stiffness;
  p.amplitude = amplitude;
  p.angular_frequency = angular_frequency;
  p.loaded = 2 * 17 - 1;
  p.observed = 2 * 8 - 1;
  return p;
}

}  // namespace

std::span<const Case> cases() {
  static const std::array<Case, 7> all = {{{"oscillator", 1e-5, 0.2},
                                           {"oscillator", 1e-6, 0.2},
                                           {"beam1", 1e-5, 1.0},
                                           {"beam2", 1e-5, 1.0},
                                           {"beam3", 1e-5, 1.0},
                                           {"beam4", 1e-5, 0.3},
                                           {"beam4", 1e-5, 1.0}}};
  return all;
}

std::span<const Method> methods() {
  return kMethods;
}
std::string to_string(Method method) {
  return kMethodNames[static_cast<std::size_t>(method)];
}
std::string to_string(Law law) {
  return law == Law::kArctan ? "arctan" : "linear";
}

Method method_of(const std::string& name) {
  const auto found = std::find(kMethodNames.begin(), kMethodNames.end(), name);
  if (found == kMethodNames.end()) throw std::invalid_argument("no method " + name);
  return static_cast<Method>(found - kMethodNames.begin());
}

Law law_of(const std::string& name) {
  if (name == "arctan") return Law::kArctan;
  if (name == "linear") return Law::kLinear;
  throw std::invalid_argument("no law " + name + ": arctan or linear");
}

template <typename Real>
ProblemOf<Real> make_problem(const std::string& name, Law law) {
  const auto made = [&name]() -> ProblemOf<Real> {
    if (name == "oscillator") return make_oscillator<Real>();
    if (name == "beam1") return make_beam<Real>(1e6, 300, kTwoPi);
    if (name == "beam2") return make_beam<Real>(1e7, 300, kTwoPi);
    if (name == "beam3") return make_beam<Real>(1e6, 30000, 10 * kTwoPi);
    if (name == "beam4") return make_beam<Real>(1e7, 30000, 10 * kTwoPi);
    throw std::invalid_argument("no case " + name + ": oscillator, beam1, beam2, beam3 or beam4");
  };
  ProblemOf<Real> problem = made();
  problem.law = law;
  problem.regularization = Real(7e7);
  return problem;
}
template ProblemOf<double> make_problem<double>(const std::string&, Law);
template ProblemOf<long double> make_problem<long double>(const std::string&, Law);

Options make_options(const Case& chosen, Method method) {
  const Parameters table = parameters_of(chosen);
  Options options;
  options.time_step = chosen.time_step;
  options.end_time = chosen.end_time;
  options.tolerance = method == Method::kRk42 ? table.rk42_tolerance : table.rk43_tolerance;
  options.shrink = table.shrink;
  options.grow = table.grow;
  options.safety = table.safety;
  options.newton_tolerance = table.newton_tolerance;
  options.target_error = method == Method::kNm2 ? table.nm2_target : table.nmm2_target;
  return options;
}

}  // namespace plain
