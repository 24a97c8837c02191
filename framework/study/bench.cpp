#include "butee/study/bench.hpp"

#include <algorithm>

#include "butee/config/toml.hpp"
#include "butee/dynamics/static_position.hpp"

namespace butee::study {
namespace {

/// The tables of a scene whose keys do not change the structure. [integrator] is not one of them: a
/// method may request other modes from the dynamics.
const std::vector<std::string> kLoadTables = {"load", "contact", "initial", "output", "title"};

bool is_structural(const std::string& key) {
  const std::string table = key.substr(0, key.find_first_of(".["));
  return std::find(kLoadTables.begin(), kLoadTables.end(), table) == kLoadTables.end();
}

linalg::Counters difference(const linalg::Counters& a, const linalg::Counters& b) {
  return {a.force_evaluations - b.force_evaluations, a.contact_evaluations - b.contact_evaluations,
          a.law_evaluations - b.law_evaluations,     a.factorizations - b.factorizations,
          a.factor_updates - b.factor_updates,       a.solves - b.solves};
}

}  // namespace

Bench::Bench(const Study& study) : study_(study) {
  for (const Axis& axis : study.plan.axes()) is_structural_.push_back(is_structural(axis.key));
}

linalg::Counters Bench::counters() const {
  return difference(parts_->dynamics.counters(), before_);
}

bool Bench::renew(const std::string& structure) {
  if (parts_ == nullptr || structure != structure_) return false;
  // Data of contacts other than elastic stops in the dynamics cannot be reused.
  if (!scene_->model.obstacles.empty() || !parts_->system.obstacles.empty()) return false;
  before_ = parts_->dynamics.counters();
  if (!replace_loads(scene_->model, parts_->system)) return false;
  parts_->dynamics.loads_replaced();
  return true;
}

void Bench::take(std::unique_ptr<scene::Scene> scene, const std::vector<config::Value>& values) {
  std::string structure;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (is_structural_[i]) structure += config::to_toml(values[i]) + "\n";
  simulation_.reset();
  integrator_.reset();
  if (parts_ != nullptr && base_ == nullptr) base_ = std::move(scene_);
  scene_ = std::move(scene);
  assemblies_ = 0;
  try {
    if (!renew(structure)) {
      parts_.reset();
      base_.reset();
      before_ = {};
      parts_ = std::make_unique<Parts>(*scene_);
      assemblies_ = 1;
    }
    structure_ = structure;
    model::System& system = parts_->system;
    if (scene_->model.starts_static)
      system.initial_displacement = static_position(parts_->dynamics, system.initial_time, system.initial_displacement);
    integrator_ = make_integrator(*scene_, parts_->dynamics);
    simulation_ = std::make_unique<time::Simulation>(parts_->dynamics, *integrator_, scene_->integrator.options);
  } catch (...) {
    // The interrupted operation may be incomplete.
    parts_.reset();
    base_.reset();
    throw;
  }
}

}  // namespace butee::study
