#pragma once

#include <memory>
#include <string>
#include <vector>

#include "butee/model/field_format.hpp"
#include "butee/record/impacts.hpp"
#include "butee/scene/read_scene.hpp"

namespace butee::python {

/// Rows in memory, column by column.
class Columns final : public model::FieldWriter {
 public:
  explicit Columns(std::vector<std::string> all) : names(std::move(all)), values(names.size()) {}

  void append(double, std::span<const double>) override {}
  void append_row(std::span<const double> row) override {
    for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(row[i]);
  }
  void finish() override {}

  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

/// The results of a run. Immutable once made.
struct Outcome {
  std::string title, message;
  std::string summary;  ///< content of summary.json
  bool completed = false;
  std::vector<std::string> warnings;
  Columns history{{}}, energy{{}};
  std::vector<record::Impact> impacts;
  std::string wear;  ///< content of wear.csv; empty if no contact wears
};

/// Called between the steps of a run.
class Watch {
 public:
  virtual ~Watch() = default;
  /// The reason to stop the run here, or nullptr.
  virtual const char* look(double t) = 0;
};

struct RunOptions {
  bool progress_bar = false;
  std::string folder{};  ///< for the files that `butee run` writes; empty: none
  bool resumes = false;  ///< continues from the newest checkpoint there, or starts a new run
};

/// Integrates the scene. Throws InputError if it cannot be run, and RunError for the folder; a
/// failed run is reported in the outcome. Safe on several threads with one scene.
std::shared_ptr<Outcome> perform(scene::Scene& scene, const RunOptions& options, Watch& watch);

}  // namespace butee::python
