#pragma once

#include <string>
#include <vector>

#include "butee/record/impacts.hpp"
#include "butee/record/local_maximum.hpp"

namespace butee::record {

/// Totals of a contact over a run.
struct ContactWear {
  std::string node, kind;
  double work = 0.0;        ///< J: the integral of |F_n w| (Archard)
  double touching = 0.0;    ///< s in contact
  double slip = 0.0;        ///< m: the integral of |w| in contact
  double dissipated = 0.0;  ///< J
  double peak_force = 0.0;  ///< N, normal
  double square = 0.0;      ///< N2 s: the integral of F_n^2
};

/// Records the impacts and the wear of contacts in the plane, with dissipation or friction, on the
/// method's dense output. Integrals by Gauss' rule with five points over each of kParts parts of a
/// step, divided further where a slip reverses; largest forces at these instants and at the maxima between them.
class BUTEE_EXPORT ContactRecorder final : public time::Observer {
 public:
  /// `dynamics` must have obstacles and outlive this object.
  explicit ContactRecorder(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  /// In the order of t_in, including those still closed.
  std::vector<Impact> impacts() const;
  const std::vector<ContactWear>& wear() const { return wear_; }
  static std::vector<std::string> wear_columns();
  std::string wear_line(const ContactWear& wear) const;

 private:
  static constexpr int kParts = 2;

  struct Watch {
    bool is_support = false, touches = false;
    bool is_stop = false;  ///< acts in one direction, on one side or on both
    Impact current{};
    double stored = 0.0;            ///< J, at the last instant
    double slip_speed = 0.0;        ///< m/s, at the last end of a part
    bool has_reversed = false;      ///< its slip, in the part under integration
    std::array<Sampled, 2> last{};  ///< the normal forces at the two previous instants; undefined if their t is equal
  };
  using Forces = std::vector<dynamics::ContactForces>;

  /// The forces of the contacts in active_ at an instant of a step; other entries are outdated.
  const Forces& at(const time::AcceptedStep& step, double t);
  /// Finds the contacts that may exert a force within a step; with given phases those that touch.
  void find_active(const time::AcceptedStep& step);
  /// Copies the forces of the contacts in active_.
  void take(const Forces& forces, Forces& to) const;
  /// Calls integrate() for kParts equal parts.
  void in_parts(const time::AcceptedStep& step, double begin, double end);
  void integrate(const time::AcceptedStep& step, double begin, double end);
  /// A part of a step in which no slip reverses; ends_ holds the forces at its end.
  void integrate_part(const time::AcceptedStep& step, double begin, double end);
  /// The first instant in the part at which the slip of a contact reverses; `end` if there is none. Fills ends_ with
  /// the forces at `end`.
  double find_reversal(const time::AcceptedStep& step, double begin, double end, std::size_t& contact);
  /// Records the normal force of a contact at an instant of a step, and the maximum around the
  /// previous instant.
  void take_force(const time::AcceptedStep& step, std::size_t contact, double t, double force);
  /// The same a little beside an end of the step, at instant t, where the forces are `there`, of contacts whose force
  /// is larger beside it.
  void take_beside(const time::AcceptedStep& step, double t, double side, const Forces& there);
  void change(const time::AcceptedStep& step, std::size_t contact, double begin, double end);

  dynamics::Dynamics& dynamics_;
  std::vector<Index> dofs_;
  std::vector<double> x_values_, v_values_;
  Vector x_, v_;
  Forces forces_, now_, ends_, beside_;
  std::vector<Watch> watches_;
  std::vector<std::size_t> active_;
  std::vector<ContactWear> wear_;
  ImpactList ended_;
  double duration_ = 0.0;
};

}  // namespace butee::record
