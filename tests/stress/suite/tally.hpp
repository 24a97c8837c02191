#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "run.hpp"

namespace butee::stress {

/// A failure, with all data needed to reproduce it.
struct Failure {
  std::string scene, method;
  Outcome outcome;
};

/// Counts over many runs.
class Tally {
 public:
  struct Row {
    std::array<std::int64_t, kVerdicts> counts{};
    std::int64_t runs = 0, cut = 0, warned = 0;
    std::int64_t inaccurate_unwarned = 0;
    double seconds = 0.0, slowest = 0.0, worst = 0.0;  ///< the last is the largest ratio of error to allowed error
  };

  void add(const Scene& scene, const Method& method, const Outcome& outcome);
  std::int64_t scenes = 0;
  std::vector<std::string> complaints;  ///< invalid scenes
  double reference_seconds = 0.0;
  std::int64_t uncertain = 0, unjudged = 0;  ///< scenes: references differ before the horizon; no reference

  const std::map<std::string, Row>& rows() const { return rows_; }
  const std::vector<Failure>& failures() const { return failures_; }
  std::int64_t count(Verdict verdict) const;

  /// The results as a markdown table, followed by the failures.
  std::string markdown() const;

 private:
  std::map<std::string, Row> rows_;
  std::vector<Failure> failures_;
};

/// Runs every method on every scene.
void run_all(const std::vector<Scene>& scenes, const std::vector<Method>& methods, std::int64_t work, Tally& tally,
             const std::function<void(const Scene&, const Method&, const Outcome&)>& on_run = {});

}  // namespace butee::stress
