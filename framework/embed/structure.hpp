#pragma once

#include <cstdint>
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

/// Options for making a structure from its scene.
struct StructureOptions {
  std::vector<std::string> overrides{};  ///< "integrator.type=NM1", as for --set of the program
  std::vector<std::string> plugins{};    ///< modules or folders of modules, as for --plugin
  /// Selectors of the nodes on which forces will be set: "string:middle" along u, "string:all.uz" along another degree
  /// of freedom, ux to rz, "string:all.theta" for moments about z.
  std::vector<std::string> forced{};
  std::optional<plugin::Catalogue> catalogue{};  ///< the types that the scene may name, instead of `plugins`
};

/// The structure of a scene as a part of another program, which advances it, reads its motion, sets
/// forces and returns to earlier states.
///
/// Each structure has its own state and shares nothing with others, so that several may live in one
/// process and on several threads, each used by one thread at a time. The scene's [integrator]
/// gives the method and tolerance. Its end_time is the duration for which they are chosen: errors of
/// the steps are kept small enough to meet the tolerance after it; the structure may go on beyond.
/// Between two calls of advance_to() forces are constant or linear in time; with linear ones a
/// partitioned iteration is of second order in its windows.
/// Bad input throws InputError, a failed step RunError with the diagnosis. Checked in tests/embed
/// against the same system solved as one.
class BUTEE_EXPORT Structure {
 public:
  /// The largest magnitude of a force or a motion that can be set: its square, an energy, must be a
  /// finite number.
  static constexpr double kLargestNumber = 1e100;

  /// Reads a scene from a file, from TOML text, or as built in code with config::ModelBuilder.
  /// Throws InputError with all errors.
  static Structure from_file(const std::string& path, const StructureOptions& options = {});
  static Structure from_toml(const std::string& text, const StructureOptions& options = {});
  static Structure from_document(config::Document document, const StructureOptions& options = {});
  Structure(Structure&& other) noexcept;
  Structure& operator=(Structure&& other) noexcept;
  ~Structure();

  /// The number of free degrees of freedom, and the names of all of them, "u of string:17".
  Index size() const;
  std::string dof_name(Index dof) const;
  /// The free DOF of a selector that names one node: an index into the vectors of state(). Throws
  /// InputError if it does not exist or is fixed.
  Index dof(const std::string& selector, DofKind kind = DofKind::u) const;
  /// The same for a selector that names several nodes, in its order, without fixed DOFs.
  std::vector<Index> dofs(const std::string& selector, DofKind kind = DofKind::u) const;

  double time() const { return state().t; }
  /// Advances to `t` exactly, s. Throws RunError if a step fails; the state is then that of the
  /// last good step, and the same error is thrown again until a force, the motion or restore()
  /// changes the situation.
  void advance_to(double t);
  /// The same; asks after every step whether to continue; true if it reached `t`. Another call
  /// continues from the point where it stopped. Throws LogicError if advance_to(), advance_step(), set_motion() or
  /// restore() is called within a step, as by `goes_on`.
  bool advance_to(double t, const std::function<bool()>& goes_on);
  /// Takes one step of the method's own length, not beyond `limit`, and returns the new time.
  double advance_step(double limit);

  /// Displacements, velocities and accelerations, m or rad and s.
  const time::State& state() const;
  double displacement(Index dof) const;
  double velocity(Index dof) const;
  double acceleration(Index dof) const;
  /// Sets the motion at the present time; the method restarts from it. Here and for forces numbers
  /// must be finite with a magnitude of at most kLargestNumber; otherwise throws LogicError and
  /// changes nothing.
  void set_motion(ConstVectorRef displacements, ConstVectorRef velocities);
  void set_displacement(Index dof, double value);
  void set_velocity(Index dof, double value);

  /// A force on a DOF of StructureOptions::forced, N or N m: `value` from now on.
  void set_force(Index dof, double value);
  /// A force that is linear in time, from the value `from` now to `to` at time `until`, s, and
  /// continued beyond.
  void set_force(Index dof, double from, double to, double until);
  double force(Index dof) const;
  /// The force of all contacts on a DOF, N or N m.
  double contact_force(Index dof) const;
  /// A quantity of [[output.probe]] ("M", "reaction", ...) at the present instant; `node` names one
  /// node, `element` the beam or spring if there are several. Throws InputError if the quantity
  /// does not exist there.
  double quantity(const std::string& name, const std::string& node, const std::string& element = "") const;

  /// The motion, the method's memory and the forces that were set, for returning to them. A value.
  struct Snapshot {
    time::Snapshot run;
    std::vector<NodalForce::Line> forces;
    std::uint64_t origin = 0;  ///< identifies its scene, options and observers
  };
  Snapshot snapshot() const;
  /// Returns to a snapshot of this structure, or of one with the same scene and options, observers of the same types
  /// and the same followed peaks; otherwise throws LogicError and changes nothing.
  void restore(const Snapshot& snapshot);

  /// Adds an observer of every step; only before the first step. `observer` must outlive the
  /// structure.
  void observe(time::Observer& observer);
  /// Records the largest |value| of quantities at each node of a selector over the whole motion
  /// from now on, on the method's dense output; only before the first step. Throws InputError if
  /// the selector names no node, and for forces of elements.
  void follow_peaks(const std::string& selector, const std::vector<model::Quantity>& quantities);
  /// The peaks by node and quantity, "string:17.u".
  std::map<std::string, double> peaks() const;
  /// The peak at one recorded node, in the unit of the quantity (m, rad, per s, per s^2, N or N m); throws InputError
  /// for other nodes.
  double peak(const std::string& node, model::Quantity quantity) const;
  /// J
  record::Energy energy() const;
  /// The method's name, the counts of work done, and the result so far.
  const std::string& method() const;
  const linalg::Counters& counters() const;
  const time::RunReport& report() const;

 private:
  struct Parts;
  class Advance;
  void set_line(Index dof, const NodalForce::Line& line);
  explicit Structure(std::unique_ptr<Parts> parts);
  /// Throws LogicError if the structure was moved from.
  Parts& parts() const;

  std::unique_ptr<Parts> parts_;
};

}  // namespace butee::embed
