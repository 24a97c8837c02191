#pragma once

#include "one_step_map.hpp"

namespace butee::app::stability {

/// What the eigenvalues of a one-step map say. Empty where there is no such thing.
struct Properties {
  std::optional<double> radius;        ///< the largest |lambda|
  std::optional<double> damping;       ///< the damping ratio of the discrete motion, less the true one
  std::optional<double> period_error;  ///< period of the discrete motion over the true one, less 1
};

/// Of the pair lambda = e^(-zeta' w' h +- i w'_d h): numerical damping zeta' - zeta and period error w_d/w'_d - 1, the
/// latter only for steps below half a period, beyond which a period has no meaning. `ratio` is zeta.
Properties properties_of(const Eigen::Matrix3d& map, double h_omega, double ratio);

/// How far a one-step map is stable: found by going up from small steps and then by bisection.
struct Limit {
  enum class Kind {
    found,      ///< stable up to `value`
    unbounded,  ///< stable up to `value`, the largest step that was tried
    no_map      ///< stable as far as there is a map, up to `value` (0: there is none at all)
  };
  Kind kind;
  double value;
  std::string why;  ///< of no_map
};

/// The largest step that was tried, in h omega or h c/m.
inline constexpr double kLargestStep = 1e3;
/// A radius that exceeds 1 by less is rounding, and more of it in the large entries of long steps (times their norm).
inline constexpr double kStable = 1e-9, kRounding = 1e-10;

Limit find_limit(OneStepMap& map);

/// One point of a curve: the oscillator's omega is 1 rad/s, so that h is h omega.
struct Sample {
  double h_omega = 0.0;
  double ratio = 0.0;       ///< damping ratio
  double stop_ratio = 0.0;  ///< k_c/k
  Properties properties;
};

/// All that is found out about one method.
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
