#pragma once

#include <span>

#include <butee/export.hpp>

#include "butee/time/state.hpp"

namespace butee::time {

/// Output arrays of an interpolation: one entry for each DOF asked for, instant by instant. An empty
/// span is not computed.
struct Interpolated {
  std::span<double> x, v, a;
};

/// Energies at an instant, J; work and dissipation are counted from the beginning of the step.
struct EnergyAt {
  double t = 0.0;  ///< s
  double kinetic = 0.0, strain = 0.0, contact = 0.0;
  double work = 0.0, dissipated = 0.0;
};

/// The motion that a method's interpolant gives between two neighbouring breakpoints of a step.
enum class Interpolation {
  cubic,         ///< x: cubic through x and v at both ends; v: cubic through v and a; a: linear
  quintic,       ///< x: quintic through x, v and a at both ends, or the cubic through x and v; v and a its derivatives
  near_quintic,  ///< close to that quintic in x; in v within departure(), or by 1/200 of its largest value if that is 0
  other          ///< any smooth motion; departure() bounds it
};

/// The quantities that the motion between two neighbouring breakpoints resolves within the tolerance.
enum class Detail {
  displacements,  ///< displacements, by the polynomial of Interpolation
  velocities,     ///< velocities as well
  accelerations,  ///< accelerations as well, which fast modes of small amplitude may dominate
  power           ///< the work of forces, by Gauss' rule with five points
};

/// The motion of a method within its accepted steps. The default is the cubic interpolation; a
/// method with a better one derives from this class. `from` and `to` are the ends of any accepted
/// step, not only of the last one. Not thread-safe: an interpolant may keep the last step.
class BUTEE_EXPORT Interpolant {
 public:
  Interpolant() = default;
  virtual ~Interpolant();

  /// For the search for extremes.
  virtual Interpolation interpolation() const { return Interpolation::cubic; }

  /// The instants, ascending and strictly within the step, between which the method took internal
  /// steps. The motion is smooth between them, as far as `detail` requires; there may be fewer for
  /// Detail::power. Valid until the next call.
  virtual std::span<const double> breakpoints(const State& from, const State& to, Detail detail);

  /// The motion of `dofs` at `t`.
  virtual void interpolate(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out);
  /// Default: one instant after the other. Override if several instants share work.
  virtual void interpolate_all(const State& from, const State& to, std::span<const double> times,
                               std::span<const Index> dofs, Interpolated out);

  /// The motion of `dofs` within the last computed step, for the detection of changes of contact:
  /// the result of interpolate() or, if much cheaper, a polynomial as accurate as the method's own
  /// representation of its contacts.
  virtual void trace(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out);
  /// The number of parts of a step that this detection examines one by one: the parts between
  /// breakpoints, unless trace() is smoother.
  virtual int trace_parts(const State& from, const State& to);

  /// The energies at the first breakpoints at or after each of `instants` (ascending), and at the
  /// end, if the method can compute them for less than the motion of all DOFs would cost; else
  /// empty. Valid until the next call.
  virtual std::span<const EnergyAt> energies(const State& from, const State& to, std::span<const double> instants);

  /// For Interpolation::other, and for v of Interpolation::near_quintic: for each DOF, bounds on how far x, v and a
  /// depart from the quintic through x, v and a at both instants, and its derivatives, between two instants with no
  /// breakpoint between them.
  virtual void departure(const State& from, const State& to, double begin, double end, std::span<const Index> dofs,
                         Interpolated out);

 protected:
  Interpolant(const Interpolant&) = default;
  Interpolant& operator=(const Interpolant&) = default;
};

/// The motion within one accepted step: a value that refers to the states at both ends and to the
/// method's interpolant, and is valid as long as these are. The functions are those of Interpolant.
class BUTEE_EXPORT DenseOutput {
 public:
  DenseOutput(Interpolant& interpolant, const State& from, const State& to)
      : interpolant_(&interpolant), from_(&from), to_(&to) {}

  const State& from() const { return *from_; }
  const State& to() const { return *to_; }
  Interpolation interpolation() const { return interpolant_->interpolation(); }
  std::span<const double> breakpoints(Detail detail = Detail::velocities) const {
    return interpolant_->breakpoints(*from_, *to_, detail);
  }
  /// The motion of `dofs` at an instant of the step.
  void interpolate(double t, std::span<const Index> dofs, Interpolated out) const { interpolate({&t, 1}, dofs, out); }
  /// The same at several instants, ascending.
  void interpolate(std::span<const double> times, std::span<const Index> dofs, Interpolated out) const;
  void trace(double t, std::span<const Index> dofs, Interpolated out) const {
    interpolant_->trace(*from_, *to_, t, dofs, out);
  }
  int trace_parts() const { return interpolant_->trace_parts(*from_, *to_); }
  std::span<const EnergyAt> energies(std::span<const double> instants) const {
    return interpolant_->energies(*from_, *to_, instants);
  }
  void departure(double begin, double end, std::span<const Index> dofs, Interpolated out) const {
    interpolant_->departure(*from_, *to_, begin, end, dofs, out);
  }

 private:
  Interpolant* interpolant_;
  const State *from_, *to_;
};

}  // namespace butee::time
