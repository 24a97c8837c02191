#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <butee/scene/assembly.hpp>

namespace butee::app::stability {

/// 1 kg on a spring and a dashpot, m x'' + c x' + (k + k_c) x = 0.
struct Oscillator {
  double stiffness = 1.0;  ///< k, N/m
  double damping = 0.0;    ///< c, N s/m
  double stop = 0.0;       ///< k_c, N/m, of a linear stop without a gap on both sides, always closed; 0: no stop
};

/// What a method makes of the state (x, v, a) of an oscillator in one step of h, measured: the method itself takes a
/// single step (time::Step::single) from each of three unit states. The acceleration belongs to the state since some
/// methods carry one of their own; of all others it adds an eigenvalue of zero.
///
/// Error control has no say: a step that it would reject is taken as it is. There is no map where the method does not
/// go over the whole step, fails, or is not linear in the state.
class OneStepMap {
 public:
  /// `settings` are keys of [integrator], "beta = 0.3" as --set writes them: "integrator.beta=0.3". Required parameters
  /// that are not among them get the value that is recommended to try first. Throws InputError.
  OneStepMap(const plugin::Catalogue& catalogue, const std::string& method, const std::vector<std::string>& settings,
             const Oscillator& oscillator);

  /// Nothing where there is no map; then refusal() says why. Lengths count in m, velocities in m sqrt((k+k_c)/m).
  std::optional<Eigen::Matrix3d> at(double h);
  const std::string& refusal() const { return refusal_; }

  const time::IntegratorType& type() const { return type_; }
  /// The parameters as TOML: "beta = 0.25, gamma = 0.5"
  const std::string& parameters() const { return parameters_; }
  /// What the method says of its own choice, of `auto`; else empty.
  const std::string& choice() const { return assembly_->integrator->choice(); }

 private:
  std::optional<Eigen::Vector3d> step(const Eigen::Vector3d& from, double h);

  plugin::Catalogue catalogue_;
  time::IntegratorType type_;
  double rate_;  ///< by which velocities are scaled, 1/s
  std::unique_ptr<scene::Scene> session_;
  std::unique_ptr<scene::Assembly> assembly_;
  std::string parameters_, refusal_;
};

}  // namespace butee::app::stability
