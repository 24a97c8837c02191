#pragma once

#include <memory>
#include <vector>

#include "butee/model/part.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/local_error.hpp"

namespace butee::integrators {

/// A method on the part of a large structure that moves, all else held at rest, for as long as nothing but a small part
/// of the tolerance has come near the border of that part; then on a larger one, at last on the whole.
///
/// The part is what lies within some places of the matrices' pattern from the loads, the initial motion, the stops that
/// push at rest, and those that pull while open by more than the tolerance allows for. A step of which more than
/// kNegligible times the tolerance (of |x|_M and |v|_M, relative to the largest so far) comes into the outer quarter of
/// the part is taken again on one whose radius is half as large again. What the border holds back is what would have
/// passed it since, weak waves that are thrown back: as a rule a small part of the tolerance.
///
/// Steps, interpolation and what the state carries are those of the method, which has LocalErrorControl's memory and
/// interpolates between states alone. Checked in tests/models/active_part_test.cpp against the same method on the
/// whole.
class ActivePart final : public time::Integrator {
 public:
  using Make = std::unique_ptr<time::Integrator> (*)(dynamics::Dynamics& dynamics, const Goal& goal);

  /// Whether there is a part to begin with that leaves half of the structure out.
  static bool can_take(dynamics::Dynamics& dynamics, double tolerance);

  /// Of a structure that it can take.
  ActivePart(dynamics::Dynamics& dynamics, const Goal& goal, Make make);

  const time::StepController* controller() const override { return parts_.front().method->controller(); }
  double first_step(const time::State& state) const override { return parts_.front().method->first_step(state); }

 private:
  /// One part; where it is the whole, the method alone.
  struct Part {
    std::vector<Index> dofs{};
    std::unique_ptr<model::System> system{};
    std::unique_ptr<dynamics::Dynamics> dynamics{};
    std::unique_ptr<time::Integrator> method{};
    Vector is_outer{};  ///< 1 in the outer quarter, else 0
    Vector work{}, outer{};
    time::State from{}, to{};

    bool is_whole() const { return dofs.empty(); }
  };

  /// A state carries the method's memory for the whole structure and behind it the place of its part in parts_.
  Index place_of_part() const { return LocalErrorControl::memory_size(dynamics().size()); }
  /// The method's memory, between a part and the whole structure. The scales of what is held at rest stay as they are.
  static void restrict_memory(const Part& part, const Vector& whole, Vector& to);
  static void extend_memory(const Part& part, const Vector& from, Vector& whole);

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  /// A step of one part, of the whole structure's states.
  time::StepReport step_on(Part& part, const time::State& from, const time::Step& step, time::State& to);
  /// Whether too much has come near the border of the part in its state `to`.
  bool has_come_near(Part& part) const;
  /// Whether all of a motion is within the part.
  static bool holds(const Part& part, const time::State& state);
  Part& at(std::size_t place);
  Part make_part(std::size_t place) const;

  Goal goal_;
  Make make_;
  std::vector<Index> distances_;
  std::vector<Part> parts_;  ///< as many as were needed so far
};

}  // namespace butee::integrators
