#pragma once

#include <string>
#include <vector>

#include "study.hpp"
#include "trial.hpp"

namespace butee::app::compare {

/// The answer that others are measured against, and how far it can itself be trusted.
struct Reference {
  std::string origin;        ///< what it was made by
  std::string method;        ///< the method among them, if any
  Values values;             ///< at the times of the question, up to the horizon
  double horizon = 0.0;      ///< s; beyond it two computations part company
  bool parted = false;       ///< false: they agree to the end
  double uncertainty = 0.0;  ///< relative rms of their difference up to the horizon, of the worst column
};

/// Computes it twice by the method `exact` at different orders, where that refuses the scene twice by `exponential` at
/// tight tolerances, or reads the study's file. Throws InputError where the scene is for neither, RunError where a run
/// fails.
Reference find_reference(const Study& study, const config::Document& scene, plugin::Catalogue& catalogue,
                         const Question& question);

/// Relative rms and largest error up to the horizon; infinite where an answer stops before.
struct Error {
  double rms = 0.0;
  double largest = 0.0;  ///< relative to the peak
};
/// Each of the worst column.
Error error_of(const Values& values, const Reference& reference);

}  // namespace butee::app::compare
