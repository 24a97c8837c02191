#pragma once

#include <memory>
#include <optional>
#include <string>

#include <butee/dynamics/frequencies.hpp>

#include "contact_changes.hpp"
#include "scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::stress {

/// The solution of a scene by `exact`, or by extrapolation8 with a thousandth of the tolerance if `exact`
/// refuses its contacts, and the growth factor Gamma. Gamma is measured by runs disturbed by e = tolerance:
/// at the start, at each tenth of the run and before the hardest impacts.
///
/// Gamma is the largest growth of all disturbances; only a few are tried, and more can only raise it. A
/// method that keeps the bound for a few keeps it for all, so refine() tries more only if a method seems to
/// violate it. The first disturbances are vibrations of e = tolerance in all modes; the others disturb every
/// component independently.
class Reference {
 public:
  /// `work` limits each of its runs; if that does not suffice for the scene's end time, the judged run is
  /// shortened.
  Reference(const Scene& scene, std::int64_t work);

  /// Why the scene is invalid, or "".
  const std::string& complaint() const { return complaint_; }
  /// False if no comparison is possible.
  bool exists() const { return promise_ && promise_->rows() > kFewRows; }
  /// True if the reference's own uncertainty, a tenth of the tolerance, set the horizon rather than growth.
  bool is_uncertain() const { return is_uncertain_; }
  /// Number of calls of refine().
  int level() const { return level_; }
  /// False if refine() has no more disturbances to try.
  bool can_refine() const { return promise_ && level_ < kLevels; }
  /// Tries more disturbances: at each tenth of the run, then at instants up to the row of a judgement.
  void refine(Index until);

  const Promise& promise() const { return *promise_; }
  /// Solution by `exact` with other series; its difference from the reference measures the reference's
  /// accuracy.
  const Trajectory& other() const { return other_; }
  const std::vector<double>& instants() const { return instants_; }
  double end_time() const { return end_time_; }            ///< s
  double critical_step() const { return critical_step_; }  ///< s, with all stops closed
  double peak() const { return peak_; }                    ///< the largest displacement or rotation
  /// "velocity of u of b:3 at t = 0.2"
  std::string place(const Judgement& found) const;

  static constexpr int kRows = 201;  ///< instants from 0 to end_time
  static constexpr int kLevels = 2;

 private:
  static constexpr Index kFewRows = 4;

  struct Disturbed {
    Index row;  ///< first row after the disturbance
    double size;
    bool is_over;  ///< the run reached its end
    Trajectory trajectory;
  };

  void solve();
  /// The scene with the reference's method, or with the method it is compared with.
  std::string toml(bool is_other) const;
  /// Sets the motion of the run; contacts keep their present phases.
  void set_motion(const Vector& x, const Vector& v);
  void place_instants();
  /// Runs to the end and keeps a snapshot at each row; returns the time reached, s.
  double follow();
  void compare_with_another();
  /// Adds disturbances before `until`, s.
  void add_disturbances(double until);
  void disturb(double t, int pattern);
  std::vector<double> before_hardest_impacts(double until) const;
  /// The last row at or before t.
  Index row_at(double t) const;
  /// Computes growth, velocity bands and the horizon from all disturbed runs.
  void measure();
  /// Returns the number of rows that are judged: long bands repeat much of the run, so that they end after a number of
  /// evaluations.
  Index place_bands();
  bool advance_to(double t);

  Scene scene_;
  std::int64_t work_;
  double end_time_, critical_step_ = 0.0, peak_ = 0.0;
  std::vector<double> instants_;
  std::unique_ptr<test::SceneRun> run_;
  std::unique_ptr<CourseWatch> watch_;
  std::unique_ptr<VelocityBand> band_;
  std::unique_ptr<Follower> follower_;
  std::vector<time::Snapshot> snapshots_;
  std::vector<Disturbed> disturbed_;
  Trajectory base_, largest_, other_;
  std::optional<dynamics::Modes> modes_;
  std::optional<Promise> promise_;
  int level_ = 0;
  bool is_uncertain_ = false, is_exact_ = true;
  std::string complaint_;
};

}  // namespace butee::stress
