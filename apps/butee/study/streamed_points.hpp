#pragma once

#include <string>

#include "../commands.hpp"

namespace butee::app::studies {

/// A study whose points come one by one.
struct StreamedPoints {
  const ModelArguments& model;  ///< the study
  const std::string& points;    ///< a CSV file, or "-" for standard input
  const std::string& results;   ///< a CSV file, or "-" for standard output
  int threads;                  ///< 0: as many as there are processors
};

/// Reads points, performs their runs and writes a row for each, in the order of the points. Returns the exit status.
/// Throws InputError before the first run.
int answer_points(const StreamedPoints& request);

}  // namespace butee::app::studies
