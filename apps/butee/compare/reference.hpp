#pragma once

#include <string>
#include <vector>

#include "study.hpp"
#include "trial.hpp"

namespace butee::app::compare {

/// The reference solution and its own uncertainty.
struct Reference {
  std::string origin;        ///< description of how it was obtained
  std::string method;        ///< the method that computed it; empty if it was read from a file
  Values values;             ///< at the times of the question, up to the horizon
  double horizon = 0.0;      ///< s; two computations diverge beyond it
  bool parted = false;       ///< true: the two computations diverge before the end
  double uncertainty = 0.0;  ///< relative rms of their difference up to the horizon, in the worst column; 0 for a file

  /// False if the two computations differ from the start on.
  bool is_usable() const { return !parted || values.front().size() > 1; }
};

/// Computes the reference twice by the method `exact` at different orders; if `exact` refuses the scene,
/// twice by `exponential` at tight tolerances; or reads the study's file. Throws InputError if neither method
/// takes the scene, RunError if a run fails.
Reference find_reference(const Study& study, const config::Document& scene, plugin::Catalogue& catalogue,
                         const Question& question);

/// Relative rms and largest error up to the horizon; infinite if an answer stops before it, or departs from a column
/// that is zero throughout.
struct Error {
  double rms = 0.0;
  double largest = 0.0;  ///< relative to the peak
};
/// Both errors, each of the worst column.
Error error_of(const Values& values, const Reference& reference);

}  // namespace butee::app::compare
