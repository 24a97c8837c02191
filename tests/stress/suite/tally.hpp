#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "run.hpp"

namespace butee::stress {

/// What must not happen, with everything that makes it happen again.
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
    double seconds = 0.0, slowest = 0.0, worst = 0.0;  ///< the last is the largest error / allowed
  };

  void add(const Scene& scene, const Method& method, const Outcome& outcome);
  std::int64_t scenes = 0;
  std::vector<std::string> complaints;  ///< scenes that are none
  double reference_seconds = 0.0;
  std::int64_t uncertain = 0, unjudged = 0;  ///< scenes, with references that differ before the horizon, or with none

  const std::map<std::string, Row>& rows() const { return rows_; }
  const std::vector<Failure>& failures() const { return failures_; }
  std::int64_t count(Verdict verdict) const;

  /// A table as markdown, and the failures.
  std::string markdown() const;

 private:
  std::map<std::string, Row> rows_;
  std::vector<Failure> failures_;
};

/// Every method on every scene.
void run_all(const std::vector<Scene>& scenes, const std::vector<Method>& methods, std::int64_t work, Tally& tally,
             const std::function<void(const Scene&, const Method&, const Outcome&)>& on_run = {});

}  // namespace butee::stress
