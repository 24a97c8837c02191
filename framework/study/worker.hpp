#pragma once

#include <functional>
#include <optional>

#include "butee/study/bench.hpp"

namespace butee::study {

/// The motion at the end of a run, from which the next of a sweep starts.
struct Motion {
  Vector x, v;     ///< m or rad, m/s or rad/s
  Vector contact;  ///< what contacts with friction remember (time::contact_memory), or empty
  bool is_empty() const { return x.size() == 0; }
};

/// Does runs of a study, one after the other. A row depends on the study and the run alone, cost columns excepted,
/// whatever was done before. For each thread one of its own.
class BUTEE_EXPORT Worker {
 public:
  /// `study` and `layout`, its own, must outlive it.
  Worker(const Study& study, const Layout& layout);

  /// The row of a run. `motion` is where a sweep starts from, nothing for the scene's own start, and then where it
  /// ended; a run that failed leaves it alone. Nothing where `goes_on` said no. What goes wrong is told by the row.
  std::optional<Row> perform(std::int64_t run, Motion& motion, const std::function<bool()>& goes_on);

  /// The same for values of one's own, an entry for each axis.
  std::optional<Row> perform(std::int64_t run, const std::vector<config::Value>& values, Motion& motion,
                             const std::function<bool()>& goes_on);

 private:
  scene::Scene read(const std::vector<config::Value>& values, Counted& counted);
  /// False where it was told not to go on.
  bool integrate(std::unique_ptr<scene::Scene> owned, const std::vector<config::Value>& values, const Counted& counted,
                 Motion& motion, Row& row, const std::function<bool()>& goes_on);

  /// Study::horizon of a run from 0 to `end`; NaN where it fails, nothing where it was interrupted.
  std::optional<double> horizon(const scene::Scene& scene, double end) const;

  const Study& study_;
  const Layout& layout_;
  /// Goes from scene to scene: copying it, and opening modules, takes longer than a short run. Empty where it was lost
  /// with a scene that could not be read.
  std::optional<plugin::Catalogue> catalogue_;
  Bench bench_;
  std::size_t first_value_, first_result_;
};

/// Reads the first point of a study and assembles it, so that what is wrong with all of them is told at once. Throws
/// InputError.
BUTEE_EXPORT void check_first_point(const Study& study);

}  // namespace butee::study
