#pragma once

#include <cmath>

#include "butee/model/base_energy.hpp"
#include "butee/model/field_format.hpp"
#include "butee/record/csv_writer.hpp"
#include "butee/record/output_times.hpp"
#include "butee/time/simulation.hpp"

namespace butee::record {

/// The mechanical energy of a state, J.
struct Energy {
  double kinetic = 0.0;       ///< v.M v / 2, with moving supports (BaseEnergy)
  double strain = 0.0;        ///< x.K x / 2, with moving supports
  double contact = 0.0;       ///< sum of U(w), zero at w = 0
  double in_obstacles = 0.0;  ///< the part of `contact` outside elastic stops
  double of_supports = 0.0;   ///< the part of `kinetic` and `strain` by moving supports

  double total() const { return kinetic + strain + contact; }
  /// The sum of magnitudes: kinetic and strain energy cancel in unstable structures.
  double size() const { return std::abs(kinetic) + std::abs(strain) + std::abs(contact); }
};

BUTEE_EXPORT Energy energy_of(const time::State& state, dynamics::Dynamics& dynamics);

/// Records the work of the loads and the dissipation over a run.
///
///     work = int v.F dt,   dissipated = int v.C v dt
///
/// Where supports move and x is measured in space, F contains their equivalent loads; the work is then that of the
/// other loads and of the forces on the supports, and the dissipation is that between all points (BaseEnergy).
///
/// Unless the method provides them (DenseOutput::energies), they are integrated by Simpson's rule
/// from breakpoint to breakpoint of every accepted step, with the midpoint from the method's own
/// interpolant: fourth order, so that the balance shows the method's error and not the quadrature
/// error. Except with Interpolation::cubic, pieces also end at the instants of rows, and
/// with Interpolation::other at discontinuities of the loads. Gauss' rule with five points is
/// used with obstacles, whose forces may jump, and along quintics, where v.C v is of degree 8. With
/// Interpolation::other pieces are halved until Kronrod's rule with 15 points and Gauss' rule with seven of them agree.
/// The balance error is (change + dissipated - work) / largest energy.
class BUTEE_EXPORT EnergyRecorder final : public time::Observer {
 public:
  /// `dynamics` must outlive this object. A `writer` gets a row at the start, at each of `times` and at the last step;
  /// with Interpolation::cubic and with DenseOutput::energies a row is at the first end or breakpoint of a step at or
  /// after its instant.
  explicit EnergyRecorder(dynamics::Dynamics& dynamics, CsvWriter* writer = nullptr,
                          std::optional<OutputTimes> times = std::nullopt);

  /// Also writes rows to `rows`, which must outlive the last one. To be called before the first
  /// step.
  void also_to(model::FieldWriter& rows) { other_ = &rows; }

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void finish() override;
  double file_seconds() const override { return writer_ != nullptr ? writer_->seconds() : 0.0; }
  /// The columns of the file: "t" and energies in J
  static std::vector<std::string> columns();
  bool watches_every_step() const override { return times_ && times_->counts_steps(); }
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  double work() const { return work_ + (now_.of_supports - first_of_supports_); }
  double dissipated() const { return dissipated_ + into_obstacles_ - (now_.in_obstacles - first_stored_); }
  /// Zero if there was never any energy.
  double balance_error() const;

 private:
  struct Power {
    double of_loads, of_damping;
    double of_contacts = 0.0;  ///< power into obstacles(), W

    Power& operator+=(const Power& other) {
      of_loads += other.of_loads;
      of_damping += other.of_damping;
      of_contacts += other.of_contacts;
      return *this;
    }
    friend Power operator+(Power a, const Power& b) { return a += b; }
    friend Power operator*(double factor, const Power& power) {
      return {factor * power.of_loads, factor * power.of_damping, factor * power.of_contacts};
    }
  };
  Power power(double t, const Vector& x, const Vector& v);
  Power power_within(const time::AcceptedStep& step, double t);
  void add(const Power& done);
  /// Sets powers_ to those at the points of a quadrature rule.
  template <class Points>
  void find_powers(const time::AcceptedStep& step, const Points& points);
  Power gauss(const time::AcceptedStep& step, double begin, double end);
  /// Adds the work of an interval by Kronrod's rule, or of its halves unless Gauss' rule within it agrees.
  void add_halved(const time::AcceptedStep& step, double begin, double end, int halvings);
  /// Adds the work between two instants with no breakpoint between them.
  void add_piece(const time::AcceptedStep& step, double begin, double end);
  bool uses_gauss(const time::AcceptedStep& step) const;
  /// The ends of the pieces within a step, its own end excepted. Valid until the next call.
  const std::vector<double>& ends_of_pieces(const time::AcceptedStep& step);
  void find_due(const time::AcceptedStep& step);
  void look_within(const time::AcceptedStep& step, double t);
  void write_row(double t);

  dynamics::Dynamics& dynamics_;
  std::vector<Index> all_;
  model::BaseEnergy base_;
  bool has_drive_;  ///< K is not symmetric
  bool needs_x_;
  Vector middle_, middle_x_, force_;
  Eigen::MatrixXd x_at_, v_at_;                         ///< at the points of a quadrature rule, one column each
  std::vector<Power> powers_;                           ///< at these points
  std::vector<double> due_;                             ///< instants for which a row is not yet written
  std::vector<double> ends_;                            ///< of the pieces of a step
  std::optional<std::vector<double>> discontinuities_;  ///< of the loads, s; found when they are needed
  Power last_{};
  std::vector<dynamics::ContactForces> contacts_;
  CsvWriter* writer_;
  model::FieldWriter* other_ = nullptr;
  std::optional<OutputTimes> times_;
  Energy now_;
  double first_total_ = 0.0, largest_ = 0.0, first_stored_ = 0.0, first_of_supports_ = 0.0;
  /// J; dissipated_ by damping only, work_ without the change of Energy::of_supports.
  double work_ = 0.0, dissipated_ = 0.0;
  double into_obstacles_ = 0.0;  ///< J, partly stored and partly dissipated in obstacles
};

}  // namespace butee::record
