#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "butee/config/value.hpp"
#include "butee/embed/nodal_force.hpp"
#include "butee/plugin/catalogue.hpp"
#include "butee/record/energy.hpp"
#include "butee/record/peaks.hpp"
#include "butee/time/simulation.hpp"

namespace butee::embed {

/// How a structure is made of its scene.
struct StructureOptions {
  std::vector<std::string> overrides{};  ///< "integrator.type=NM1", as --set of the program
  std::vector<std::string> plugins{};    ///< modules or folders of modules, as --plugin
  /// Selectors of the nodes on which forces will be set: "string:middle" along u, "string:all.uz" along another degree
  /// of freedom, ux to rz, "string:all.theta" for moments about z.
  std::vector<std::string> forced{};
  std::optional<plugin::Catalogue> catalogue{};  ///< the types that the scene may name, instead of `plugins`
};

/// The structure of a scene as a part of another program: it is advanced as far as that wants, read, pushed and set
/// back.
///
/// Each structure has a state of its own and shares nothing with others, so that several may live in one process and on
/// several threads, each used by one thread at a time. The scene's [integrator] says with which method and tolerance;
/// its end_time is of no importance. Between two calls of advance_to() forces are straight lines in time, so that a
/// partitioned iteration is of second order in its windows. Bad input throws InputError, a failed step RunError with
/// the diagnosis. Checked in tests/embed against the same system solved as one.
class BUTEE_EXPORT Structure {
 public:
  /// The largest magnitude of a force or a motion that is set: its square, an energy, has to be a number as well.
  static constexpr double kLargestNumber = 1e100;

  /// Reads a scene from a file, from TOML text, or as built in code with config::ModelBuilder. Throws InputError with
  /// every mistake.
  static Structure from_file(const std::string& path, const StructureOptions& options = {});
  static Structure from_toml(const std::string& text, const StructureOptions& options = {});
  static Structure from_document(config::Document document, const StructureOptions& options = {});
  Structure(Structure&& other) noexcept;
  Structure& operator=(Structure&& other) noexcept;
  ~Structure();

  /// The number of free degrees of freedom, and the names of all of them, "u of string:17".
  Index size() const;
  std::string dof_name(Index dof) const;
  /// The free DOF of a selector that names one node: an index into the vectors of state(). Throws InputError where
  /// there is none, or where it is fixed.
  Index dof(const std::string& selector, DofKind kind = DofKind::u) const;
  /// The same of a selector that names several nodes, in its order, fixed ones left out.
  std::vector<Index> dofs(const std::string& selector, DofKind kind = DofKind::u) const;

  double time() const { return state().t; }
  /// Goes on to `t` exactly, s. Throws RunError where a step fails; the state is then that of the last good step, and
  /// the same error comes again until another force, another motion or restore() gives a way to go on.
  void advance_to(double t);
  /// The same, asking after every step whether to go on; true where it came to `t`. Another call takes it on from where
  /// it was stopped.
  bool advance_to(double t, const std::function<bool()>& goes_on);
  /// Takes one step of the method's own length, not beyond `limit`, and returns the new time.
  double advance_step(double limit);

  /// Displacements, velocities and accelerations, m or rad and s.
  const time::State& state() const;
  double displacement(Index dof) const;
  double velocity(Index dof) const;
  double acceleration(Index dof) const;
  /// Takes another motion at the present time; the method starts anew from it. Here and in forces a number is finite,
  /// and of a magnitude of at most kLargestNumber; LogicError otherwise, and nothing is changed.
  void set_motion(ConstVectorRef displacements, ConstVectorRef velocities);
  void set_displacement(Index dof, double value);
  void set_velocity(Index dof, double value);

  /// A force on a DOF of StructureOptions::forced, N or N m: `value` from now on.
  void set_force(Index dof, double value);
  /// A force that goes from `from` now to `to` at time `until`, s, in a straight line (and on beyond).
  void set_force(Index dof, double from, double to, double until);
  double force(Index dof) const;
  /// The force of all contacts on a DOF, N, but for what holds those that stick rigidly.
  double contact_force(Index dof) const;
  /// A quantity of [[output.probe]] ("M", "reaction", ...) at the present instant; `node` names one node, `element` the
  /// beam or spring meant where there are several. Throws InputError where there is no such quantity there.
  double quantity(const std::string& name, const std::string& node, const std::string& element = "") const;

  /// The motion, the method's memory and the forces set, to go back to. A value.
  struct Snapshot {
    time::Snapshot run;
    std::vector<NodalForce::Line> forces;
    std::uint64_t origin = 0;  ///< which scene, options and observers it belongs to
  };
  Snapshot snapshot() const;
  /// Goes to a snapshot of this structure, or of another one of the same scene, options and number of observers;
  /// LogicError otherwise, and nothing is changed.
  void restore(const Snapshot& snapshot);

  /// Watches every step from now on; before the first one. `observer` must outlive the structure.
  void observe(time::Observer& observer);
  /// Follows the largest |value| of quantities of each node of a selector over the whole motion from now on, on the
  /// method's dense output; before the first step. Throws InputError where the selector names no node,
  /// and of forces of elements.
  void follow_peaks(const std::string& selector, const std::vector<model::Quantity>& quantities);
  /// By node and quantity, "string:17.u".
  std::map<std::string, double> peaks() const;
  /// Of one node that is followed; else throws InputError.
  double peak(const std::string& node, model::Quantity quantity) const;
  record::Energy energy() const;
  /// The method's name, what has been counted, and what it came to so far.
  const std::string& method() const;
  const linalg::Counters& counters() const;
  const time::RunReport& report() const;

 private:
  struct Parts;
  void set_line(Index dof, const NodalForce::Line& line);
  explicit Structure(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace butee::embed
