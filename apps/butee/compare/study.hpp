#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../session.hpp"

namespace butee::app::compare {

/// One method with the key that sets its accuracy and the values to take for it, from coarse to fine.
struct Sweep {
  std::string method;          ///< canonical name
  std::string knob;            ///< "time_step", "tolerance", ...
  bool as_written = false;     ///< a single run with the scene's own values; no knob then
  std::vector<double> values;  ///< empty: chosen for the scene
  config::Table settings;      ///< further keys of [integrator]
};

/// What is compared: scenes times methods times values.
struct Study {
  std::string title;
  std::vector<std::string> scenes;  ///< model files
  std::vector<std::string> overrides;
  std::vector<std::string> quantities;                     ///< columns of history.csv; the first one where empty
  std::optional<double> end_time;                          ///< s
  std::vector<double> end_times;                           ///< s, one for each scene, instead
  std::vector<double> targets = {1e-2, 1e-3, 1e-4, 1e-5};  ///< relative rms errors
  double time_limit = 2.0;                                 ///< s, of a single run
  std::string reference_file;                              ///< CSV with columns t and the quantities; empty: computed
  std::vector<Sweep> sweeps;                               ///< empty: every method that is found
};

/// Reads MODEL.toml or STUDY.toml, told apart by a table [study]. Throws InputError with every mistake.
Study read_study(const ModelArguments& arguments);

/// The sweeps of a study for one scene: all methods where none are named, values where none are given. `fixed_step`
/// bounds are taken from the highest frequency (rad/s) of the scene and its end time (s).
std::vector<Sweep> complete_sweeps(const Study& study, plugin::Catalogue& catalogue, double highest_frequency,
                                   double end_time);

/// The scene of a study with another method: [integrator] is written anew from the sweep, the scene's own keys for that
/// method, and what one would try first.
config::Document with_method(const config::Document& scene, const time::IntegratorType& type, const Sweep& sweep,
                             double value);

}  // namespace butee::app::compare
