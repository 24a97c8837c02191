#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../session.hpp"

namespace butee::app::compare {

/// One method, the key that sets its accuracy, and the values of that key from coarse to fine.
struct Sweep {
  std::string method;          ///< canonical name
  std::string knob;            ///< "time_step", "tolerance", ...
  bool as_written = false;     ///< a single run with the scene's own values, without a knob
  std::vector<double> values;  ///< empty: chosen for the scene
  config::Table settings;      ///< further keys of [integrator]
};

/// The runs to compare: scenes times methods times values.
struct Study {
  std::string title;
  std::vector<std::string> scenes;  ///< model files
  std::vector<std::string> overrides;
  std::vector<std::string> quantities;                     ///< columns of history.csv; empty: the first one
  std::optional<double> end_time;                          ///< s
  std::vector<double> end_times;                           ///< s, one for each scene; replaces end_time
  std::vector<double> targets = {1e-2, 1e-3, 1e-4, 1e-5};  ///< relative rms errors
  double time_limit = 2.0;                                 ///< s, of a single run
  std::string reference_file;                              ///< CSV with columns t and the quantities; empty: computed
  std::vector<Sweep> sweeps;                               ///< empty: all available methods
};

/// Reads MODEL.toml or STUDY.toml; a study has a table [study]. Throws InputError with all mistakes.
Study read_study(const ModelArguments& arguments);

/// The sweeps of a study for one scene: all methods if none are named, default values if none are given.
/// Fixed steps are bounded by the scene's highest frequency (rad/s) and its end time (s).
std::vector<Sweep> complete_sweeps(const Study& study, plugin::Catalogue& catalogue, double highest_frequency,
                                   double end_time);

/// The scene of a study with another method. [integrator] is rebuilt from the sweep, the scene's own keys for
/// that method, and the recommended values of required parameters.
config::Document with_method(const config::Document& scene, const time::IntegratorType& type, const Sweep& sweep,
                             double value);

}  // namespace butee::app::compare
