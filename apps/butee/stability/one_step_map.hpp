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
  double stop = 0.0;       ///< k_c, N/m, of an always closed linear stop without a gap on both sides; 0: no stop
};

/// The linear map of the state (x, v, a) of an oscillator over one step of length h, measured: the method
/// takes a single step (time::Step::single) from several states. The acceleration belongs to the state
/// because some methods carry their own; for other methods it adds an eigenvalue of zero.
///
/// Error control is ignored: a step that it would reject is accepted. There is no map if the method does not
/// complete the step, fails, or is not linear in the state.
class OneStepMap {
 public:
  /// `settings` are keys of [integrator] in the form of --set: "beta = 0.3" as "integrator.beta=0.3".
  /// Required parameters that are not given take their recommended first value. Throws InputError.
  OneStepMap(const plugin::Catalogue& catalogue, const std::string& method, const std::vector<std::string>& settings,
             const Oscillator& oscillator);

  /// Empty if there is no map; refusal() then gives the reason. Units: x in m, v in m sqrt((k+k_c)/m), a in m
  /// (k+k_c)/m.
  std::optional<Eigen::Matrix3d> at(double h);
  const std::string& refusal() const { return refusal_; }

  const time::IntegratorType& type() const { return type_; }
  /// The parameters as TOML: "beta = 0.25, gamma = 0.5"
  const std::string& parameters() const { return parameters_; }
  /// the choice reported by `auto`; empty for other methods
  const std::string& choice() const { return assembly_->integrator->choice(); }

 private:
  std::optional<Eigen::Vector3d> step(const Eigen::Vector3d& from, double h);

  plugin::Catalogue catalogue_;
  time::IntegratorType type_;
  double rate_;  ///< scale of velocities, 1/s
  std::unique_ptr<scene::Scene> session_;
  std::unique_ptr<scene::Assembly> assembly_;
  std::string parameters_, refusal_;
};

}  // namespace butee::app::stability
