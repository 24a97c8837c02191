#pragma once

#include <string>
#include <vector>

#include "reference.hpp"

namespace butee::app::compare {

/// One run of a comparison.
struct Row {
  std::string fingerprint;  ///< hash of scene and question; a second call keeps rows with the same hash
  std::string scene, method, knob;
  double value = 0.0;
  std::string outcome = "completed";  ///< or the reason of failure
  Error error;
  double seconds = 0.0;
  std::int64_t steps = 0, rejected = 0, newton = 0;
  std::int64_t factorizations = 0, solves = 0, contact_evaluations = 0, force_evaluations = 0;

  bool completed() const { return outcome == "completed"; }
};

/// The results of one scene.
struct SceneResult {
  std::string scene, title, column;
  double end_time = 0.0;
  Reference reference;
  std::vector<Row> rows;
};

/// Writes runs.csv, one line for each run.
std::string csv_header();
std::string csv_line(const Row& row);
/// Reads the rows of an earlier call; incomplete lines are skipped.
std::vector<Row> read_csv(const std::string& path);

/// The report as Markdown: reference, tables, the fastest method for each target.
std::string markdown(const Study& study, const std::vector<SceneResult>& results, const std::string& command);

/// The fastest run with an error up to `target`, or nullptr.
const Row* fastest(const std::vector<Row>& rows, double target);

/// As fastest(), but nullptr also if the target is within the uncertainty of the reference.
const Row* fastest_beyond_doubt(const SceneResult& result, double target);

/// Draws error against time as work-precision-<scene>.png and .svg in `folder` by gnuplot. Returns false if
/// gnuplot is missing or failed; the script and the data are kept.
bool draw(const SceneResult& result, const std::string& folder);

}  // namespace butee::app::compare
