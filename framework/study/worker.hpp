#pragma once

#include <functional>
#include <optional>

#include "butee/study/bench.hpp"

namespace butee::study {

/// The motion at the end of a run, from which the next run of a sweep starts.
struct Motion {
  Vector x, v;     ///< m or rad, m/s or rad/s
  Vector contact;  ///< memory of contacts with friction (time::contact_memory), or empty
  bool is_empty() const { return x.size() == 0; }
};

/// Does runs of a study, one after the other. A row depends only on the study and the run, except
/// its cost columns, and not on earlier runs. Each thread needs its own Worker.
class BUTEE_EXPORT Worker {
 public:
  /// `study` and its `layout` must outlive this object.
  Worker(const Study& study, const Layout& layout);

  /// The row of a run. `motion` is the start of a run of a sweep, or empty for the scene's own
  /// start; on return it is the end of the run, or unchanged if the run failed. Nothing if
  /// `goes_on` returned false. The row reports errors.
  std::optional<Row> perform(std::int64_t run, Motion& motion, const std::function<bool()>& goes_on);

  /// The same for given values, an entry for each axis.
  std::optional<Row> perform(std::int64_t run, const std::vector<config::Value>& values, Motion& motion,
                             const std::function<bool()>& goes_on);

 private:
  scene::Scene read(const std::vector<config::Value>& values, Counted& counted);
  /// False if it was told to stop.
  bool integrate(std::unique_ptr<scene::Scene> owned, const std::vector<config::Value>& values, const Counted& counted,
                 Motion& motion, Row& row, const std::function<bool()>& goes_on);

  /// Study::horizon of a run from 0 to `end`; NaN if it fails, nothing if it was interrupted.
  std::optional<double> horizon(const scene::Scene& scene, double end) const;

  const Study& study_;
  const Layout& layout_;
  /// Passed from scene to scene, since copying it and opening modules takes longer than a short
  /// run. Empty if it was lost with a scene that could not be read.
  std::optional<plugin::Catalogue> catalogue_;
  Bench bench_;
  std::size_t first_value_, first_result_;
};

/// Reads and assembles points of a study until one is accepted, so that errors common to all points are reported at
/// once, and a point that is refused is a row like any other. Throws InputError with the reason of the first point if
/// each of 16 points between the first and the last is refused.
BUTEE_EXPORT void check_points(const Study& study);

/// The same for a study whose points are given one by one, of which `study` has the first. If it is refused but changes
/// only keys that the scene gives, the scene may be accepted as it is written. Throws InputError.
BUTEE_EXPORT void check_streamed_points(const Study& study);

}  // namespace butee::study
