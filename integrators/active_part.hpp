#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "butee/model/part.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/local_error.hpp"

namespace butee::integrators {

/// Runs a method on the part of a large structure that moves and holds the rest at zero. If more
/// than a small fraction of the tolerance comes near the border of the part, a larger part follows,
/// at last the whole structure.
///
/// The part holds all DOFs within a radius, counted in edges of the matrices' sparsity pattern,
/// around the loads, the initial motion, the stops that push at rest, and the open stops whose
/// residual force exceeds what the tolerance allows. If the motion in the outer quarter of the part
/// exceeds kNegligible times the tolerance (in |x|_M or |v|_M, relative to the largest so far), the
/// step is repeated on a part of 1.5 times the radius. The error of the method consists of weak
/// waves that the border of a part reflects; as a rule it is a small fraction of the tolerance.
///
/// The method determines steps, interpolation and the contents of the state. It must use
/// LocalErrorControl's memory. Checked in
/// tests/models/active_part_test.cpp against the same method on the whole.
class ActivePart final : public time::Integrator {
 public:
  using Make = std::unique_ptr<time::Integrator> (*)(dynamics::Dynamics& dynamics, const Goal& goal);

  /// True if the errors of the structure are measured as a whole, and the first part contains at most half of its DOFs.
  static bool can_take(dynamics::Dynamics& dynamics, double tolerance);

  /// Requires can_take().
  ActivePart(dynamics::Dynamics& dynamics, const Goal& goal, Make make);

  const time::StepController* controller() const override { return parts_.front().method->controller(); }
  double first_step(const time::State& state) const override { return parts_.front().method->first_step(state); }

 private:
  /// One part; if it is the whole structure, only `method` is used.
  struct Part {
    std::vector<Index> dofs{};
    std::vector<Index> places{};  ///< the place of each DOF of the structure among `dofs`; -1: none
    std::unique_ptr<model::System> system{};
    std::unique_ptr<dynamics::Dynamics> dynamics{};
    std::unique_ptr<time::Integrator> method{};
    Vector is_outer{};  ///< 1 for a DOF in the outer quarter, else 0
    Vector work{}, outer{};
    time::State from{}, to{};

    bool is_whole() const { return dofs.empty(); }
  };

  /// The motion of the method within the last step, zero outside the part.
  class Output final : public time::Interpolant {
   public:
    /// `part` must stay valid until the next call.
    void accept(Part& part) { part_ = &part; }
    time::Interpolation interpolation() const override {
      return part_ != nullptr ? of_method().interpolation() : time::Interpolation::quintic;
    }
    std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail detail) override;
    void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                     time::Interpolated out) override;

   private:
    time::DenseOutput of_method() const { return part_->method->dense_output(part_->from, part_->to); }
    bool holds(const time::State& from, const time::State& to) const {
      return part_->is_whole() || (part_->from.t == from.t && part_->to.t == to.t);
    }

    Part* part_ = nullptr;
    std::vector<Index> dofs_;
    std::vector<std::size_t> entries_;
    std::vector<double> x_, v_, a_;
  };

  /// The memory of a state is the method's memory for the whole structure, followed by the index of
  /// its part in parts_.
  Index place_of_part() const { return LocalErrorControl::memory_size(dynamics().size()); }
  /// Copy the method's memory between a part and the whole structure. The scales of DOFs held at
  /// rest do not change.
  static void restrict_memory(const Part& part, const Vector& whole, Vector& to);
  static void extend_memory(const Part& part, const Vector& from, Vector& whole);

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return output_; }
  /// A step on one part; `from` and `to` are states of the whole structure.
  time::StepReport step_on(Part& part, const time::State& from, const time::Step& step, time::State& to);
  /// True if the motion in the outer quarter of part.to exceeds its bound.
  bool has_come_near(Part& part) const;
  /// True if all nonzero displacements and velocities of the state are within the part.
  static bool holds(const Part& part, const time::State& state);
  Part& at(std::size_t place);
  Part make_part(std::size_t place) const;

  Goal goal_;
  Make make_;
  std::vector<Index> distances_;
  std::deque<Part> parts_;  ///< those needed so far; output_ refers to one of them
  Output output_;
};

}  // namespace butee::integrators
