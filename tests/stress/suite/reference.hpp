#pragma once

#include <memory>
#include <optional>
#include <string>

#include <butee/dynamics/frequencies.hpp>

#include "contact_changes.hpp"
#include "scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::stress {

/// The solution of a scene by `exact`, or where that cannot take its contacts by extrapolation8 with a thousandth of
/// the tolerance, and Gamma by runs of it that were disturbed by e = tolerance: at the start, at each tenth of the run
/// and before the hardest impacts.
///
/// Gamma is the largest over all disturbances, of which a few are tried; more can only raise it. To be within the
/// promise of a few is to be within it, so that refine() tries more of them where a method seems to break it. The first
/// few are vibrations of e = tolerance in all modes, the others move every component by itself.
class Reference {
 public:
  /// `work` bounds each of its runs; where that does not reach the scene's end, the run that is judged is shorter.
  Reference(const Scene& scene, std::int64_t work);

  /// Why the scene is none, or "".
  const std::string& complaint() const { return complaint_; }
  /// False where there is nothing to compare with.
  bool exists() const { return promise_ && promise_->rows() > kFewRows; }
  /// The horizon where the reference's own uncertainty, a tenth of the tolerance, came before growth.
  bool is_uncertain() const { return is_uncertain_; }
  /// How often refine() was called.
  int level() const { return level_; }
  /// False where refine() has nothing more to try.
  bool can_refine() const { return promise_ && level_ < kLevels; }
  /// Tries more disturbances: at each tenth of the run, then all along until the row of a judgement.
  void refine(Index until);

  const Promise& promise() const { return *promise_; }
  /// By `exact` with other series, whose difference from the reference is what that is worth.
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
    Index row;  ///< the first after it
    double size;
    bool is_over;  ///< it came to its end
    Trajectory trajectory;
  };

  void solve();
  /// The scene with the reference's method, or another one to compare with.
  std::string toml(bool is_other) const;
  /// Of the run, which goes on with the phases that its contacts are in.
  void set_motion(const Vector& x, const Vector& v);
  void place_instants();
  /// Runs to the end, keeping a snapshot at each row; how far it came, s.
  double follow();
  void compare_with_another();
  /// Before `until`, s.
  void add_disturbances(double until);
  void disturb(double t, int pattern);
  std::vector<double> before_hardest_impacts(double until) const;
  /// The last row at or before t.
  Index row_at(double t) const;
  /// Growth, the bands of velocities and the horizon from all disturbed runs.
  void measure();
  void place_bands();
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
