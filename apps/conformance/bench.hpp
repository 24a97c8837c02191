#pragma once

#include <string>
#include <vector>

#include <butee/scene/assembly.hpp>

#include "apps/conformance/check.hpp"

namespace butee::conformance {

/// A scene that a check looks at, assembled with the method it names.
class Bench {
 public:
  /// Reads `scene`; with `overrides` such as "integrator.tolerance=1e-8". Throws InputError where it is refused.
  Bench(const plugin::Catalogue& catalogue, const std::string& scene, const std::vector<std::string>& overrides = {});

  const model::System& system() const { return assembly_.system; }
  dynamics::Dynamics& dynamics() { return assembly_.dynamics; }
  time::Integrator& integrator() { return *assembly_.integrator; }
  time::Simulation& simulation() { return assembly_.simulation; }
  /// The free DOF u of a selector that names one node.
  Index dof(const std::string& selector) const;
  /// The scene's initial state, completed by the method.
  time::State initial_state();

 private:
  scene::Scene scene_;
  scene::Assembly assembly_;
};

/// "[integrator]" for the subject.
std::string integrator_table(const Subject& subject, double time_step, double end_time);
/// The same for a method of butee's own with these TOML lines.
std::string integrator_table(const std::string& name, const std::string& keys, double time_step, double end_time);

/// A short pinned beam of `elements` elements that strikes its stops at once. `law` and `damping` are TOML lines.
std::string rattling_beam(int elements, const std::string& law, const std::string& damping);

/// Laws for it: one that its motion resolves, and one with a kink.
inline constexpr const char* kBentLaw = "law = \"arctan\"\nstiffness = 1e6\nregularization = 1e5\n";
inline constexpr const char* kLinearLaw = "law = \"linear\"\nstiffness = 1e6\n";
/// The first, or the second of methods that take no smooth law.
std::string contact_law(const Subject& subject);
/// False where the method refuses the scene, as those for few DOFs do with large ones.
bool takes(const Subject& subject, const std::string& scene);
inline constexpr const char* kRayleighDamping = "mass_proportional = 0.5\nstiffness_proportional = 1e-5\n";

/// The overrides with which an adaptive method accepts every step, so that equal steps can be taken with it: the
/// loosest tolerance that its declaration allows.
std::vector<std::string> accept_all(const Subject& subject);

}  // namespace butee::conformance
