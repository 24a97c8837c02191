#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "butee/study/collect.hpp"
#include "butee/study/plan.hpp"

namespace butee::study {

/// A study, read and checked: one scene, its varied keys, and the results collected from each run.
struct Study {
  config::Document document;    ///< of the study
  config::Document scene;       ///< with the overrides that apply to every run
  plugin::Catalogue catalogue;  ///< its methods are loaded when the first point needs them
  Plan plan;
  static constexpr double kMostPeriods = 1e9;  ///< settled or collected

  std::int64_t settle = 0;                ///< periods before results are collected
  std::optional<std::int64_t> periods{};  ///< number of periods collected; up to the scene's end_time if absent
  std::optional<double> period{};         ///< s; that of the loads if absent
  std::optional<double> steady{};         ///< relative tolerance: settling ends earlier if the motion repeats itself
                                          ///< within it
  std::vector<Item> items{};
  std::string title{};
  std::string stem{};  ///< name of its file without extension
  /// For "trust": the instant up to which a run of a scene can be trusted, s; nothing if it was
  /// interrupted. Thread-safe. Throws RunError.
  std::function<std::optional<double>(scene::Scene&)> horizon{};
};

/// The keys of a study, for help and completion.
BUTEE_EXPORT std::vector<config::Parameter> study_parameters();
BUTEE_EXPORT std::vector<config::Parameter> vary_parameters();

/// True for a document accepted by `butee study`: it has `scene` or `vary`.
BUTEE_EXPORT bool is_study(const config::Document& document);

struct StudyOptions {
  std::vector<std::string> overrides{};  ///< of the scene, "KEY=VALUE"
  std::vector<std::string> plugins{};
  std::string points{};  ///< CSV text with a header of keys, in place of [[vary]]
  /// Study::horizon; "trust" is refused if it is empty.
  std::function<std::optional<double>(scene::Scene&)> horizon{};
};

/// Reads a study, its scene and the first of its points. Throws InputError with all errors.
BUTEE_EXPORT Study load_study(const std::string& path, const StudyOptions& options = {});
/// The same for a study and its scene in memory; the file named by `scene` in the study is not
/// read.
BUTEE_EXPORT Study read_study(const config::Document& study, const config::Document& scene,
                              const StudyOptions& options = {});

/// The scene of a study at these values, an entry for each axis.
BUTEE_EXPORT config::Document scene_at(const Study& study, const std::vector<config::Value>& values);

/// The period of the loads of a scene, s, which must have one frequency. Throws InputError if there
/// is none or several.
BUTEE_EXPORT double period_of(const model::Model& model);

/// The columns of the rows: position of the run in the plan, values of the axes, status, results,
/// cost.
BUTEE_EXPORT Layout layout_of(const Study& study);

/// Names of columns that every study has.
inline constexpr const char *kRunColumn = "run", *kPointColumn = "point", *kDirectionColumn = "direction",
                            *kStatusColumn = "status", *kReasonColumn = "reason", *kSceneColumn = "scene",
                            *kSettledColumn = "settled", *kStepsColumn = "steps",
                            *kFactorizationsColumn = "factorizations", *kSolvesColumn = "solves",
                            *kAssembliesColumn = "assemblies", *kSecondsColumn = "wall_seconds";

}  // namespace butee::study
