#pragma once

#include <string>
#include <vector>

#include <butee/scene/assembly.hpp>

#include "apps/conformance/check.hpp"

namespace butee::conformance {

/// A scene under test, assembled with its method.
class Bench {
 public:
  /// Reads `scene` with `overrides` such as "integrator.tolerance=1e-8". Throws InputError if the scene is
  /// refused.
  Bench(const plugin::Catalogue& catalogue, const std::string& scene, const std::vector<std::string>& overrides = {});

  const model::System& system() const { return assembly_.system; }
  dynamics::Dynamics& dynamics() { return assembly_.dynamics; }
  time::Integrator& integrator() { return *assembly_.integrator; }
  time::Simulation& simulation() { return assembly_.simulation; }
  /// The free DOF u of the node named by a selector.
  Index dof(const std::string& selector) const;
  /// The scene's initial state, completed by the method.
  time::State initial_state();

 private:
  scene::Scene scene_;
  scene::Assembly assembly_;
};

/// The table [integrator] for the subject.
std::string integrator_table(const Subject& subject, double time_step, double end_time);
/// The table [integrator] for one of butee's own methods with these TOML lines.
std::string integrator_table(const std::string& name, const std::string& keys, double time_step, double end_time);

/// A short pinned beam of `elements` elements that strikes its stops early. `law` and `damping` are TOML
/// lines.
std::string rattling_beam(int elements, const std::string& law, const std::string& damping);
/// The beam of most checks, with the subject's method and law: 2000 steps of kStep, s, up to kEnd.
std::string rattling_beam(const Subject& subject);
inline constexpr double kStep = 1e-5, kEnd = 2e-2;

/// Contact laws for the beam: a smooth one, and one with a slope discontinuity.
inline constexpr const char* kBentLaw = "law = \"arctan\"\nstiffness = 1e6\nregularization = 1e5\n";
inline constexpr const char* kLinearLaw = "law = \"linear\"\nstiffness = 1e6\n";
/// kBentLaw, or kLinearLaw for methods that refuse smooth laws.
std::string contact_law(const Subject& subject);
/// False if the method refuses the scene; methods for few DOFs refuse large scenes.
bool takes(const Subject& subject, const std::string& scene);
inline constexpr const char* kRayleighDamping = "mass_proportional = 0.5\nstiffness_proportional = 1e-5\n";

/// Overrides with which an adaptive method accepts every step, so that it takes equal steps: the loosest
/// tolerance that its declaration allows.
std::vector<std::string> accept_all(const Subject& subject);

}  // namespace butee::conformance
