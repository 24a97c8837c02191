#pragma once

#include "one_step_map.hpp"

namespace butee::app::stability {

/// Properties from the eigenvalues of a one-step map; empty if undefined.
struct Properties {
  std::optional<double> radius;        ///< the largest |lambda|
  std::optional<double> damping;       ///< the damping ratio of the discrete motion minus the true one
  std::optional<double> period_error;  ///< period of the discrete motion over the true one, minus 1
};

/// From the pair lambda = e^(-zeta' w' h +- i w'_d h): numerical damping zeta' - zeta and period error
/// w_d/w'_d - 1. The period error is defined only for steps below half a period. `ratio` is zeta.
Properties properties_of(const Eigen::Matrix3d& map, double h_omega, double ratio);

/// Stability limit of a one-step map: found by increasing the step from small values, then by bisection.
struct Limit {
  enum class Kind {
    found,      ///< stable up to `value`
    unbounded,  ///< stable up to `value`, the largest step tested
    no_map      ///< stable for all steps that have a map, up to `value` (0: no step has a map)
  };
  Kind kind;
  double value;
  std::string why;  ///< reason for no_map
};

/// The largest step tested, in h omega or h c/m.
inline constexpr double kLargestStep = 1e3;
/// Allowance for rounding in a spectral radius above 1: kStable, plus kRounding times the norm of the map,
/// which is large for long steps.
inline constexpr double kStable = 1e-9, kRounding = 1e-10;

Limit find_limit(OneStepMap& map);

/// One point of a curve. The oscillator's omega is 1 rad/s, so that h = h omega.
struct Sample {
  double h_omega = 0.0;
  double ratio = 0.0;       ///< damping ratio
  double stop_ratio = 0.0;  ///< k_c/k
  Properties properties;
};

/// The complete results for one method.
struct Analysis {
  std::string method, parameters, choice;
  double declared_stability, declared_damping;
  Limit undamped;                ///< in h omega, on the imaginary axis
  Limit dashpot;                 ///< in h c/m of a mass with a dashpot alone, on the negative real axis
  std::vector<Limit> damped;     ///< in h omega, by damping ratio
  std::vector<Limit> with_stop;  ///< in h omega of the open oscillator, by k_c/k
  std::vector<Sample> curves;    ///< by damping ratio
  std::vector<Sample> stops;     ///< by k_c/k

  bool has_map() const { return undamped.kind != Limit::Kind::no_map || undamped.value > 0.0; }
};

struct Request {
  std::vector<std::string> settings;
  std::vector<double> ratios, stop_ratios;
};

Analysis analyse(const plugin::Catalogue& catalogue, const std::string& method, const Request& request);

}  // namespace butee::app::stability
