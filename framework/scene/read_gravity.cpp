#include <cmath>

#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Value;
using model::LoadType;

void SceneReader::read_gravity() {
  const Value* given = root_.table()->find("gravity");
  if (given == nullptr) return;
  const auto p = read_parameters(
      *given, "gravity",
      {config::numbers("acceleration", "m/s2", "the acceleration of free fall along x, y and z").of_length(3),
       config::boolean("static", "starts at rest in the static position").or_else(false)},
      diagnostics_);
  if (!p || lacks_elements_) return;
  const auto g = p->numbers("acceleration");
  auto pattern = inertia_pattern(model_, Eigen::Vector3d(g[0], g[1], g[2]));
  if (pattern.empty()) {
    p->complain(diagnostics_, "acceleration", "acts along no displacement that the scene has");
    return;
  }
  config::Table unity;
  unity["value"] = Value(1.0);
  const LoadType& constant = *find_type(types_.loads, "constant");
  model_.loads.push_back({std::move(pattern),
                          constant.make(config::make_parameters(constant.parameters, unity), diagnostics_), nullptr,
                          0.0});
  model_.starts_static = p->flag("static");
}

void SceneReader::read_base() {
  const Value* given = root_.table()->find("base");
  if (given == nullptr) return;
  const auto p = read_parameters(
      *given, "base", {config::table("acceleration", "the acceleration of all supports, m/s2, with its direction")},
      diagnostics_);
  if (!p) return;
  const Value& motion = p->value("acceleration");
  auto in_time = read_in_time(motion, "base.acceleration", {"direction"});
  std::vector<std::string> others;
  for (const auto& [key, value] : motion.table()->entries)
    if (key != "direction") others.push_back(key);
  const auto along = read_parameters(
      motion, "base.acceleration", {config::numbers("direction", "1", "along which it acts, x, y and z").of_length(3)},
      diagnostics_, others);
  if (!along || in_time == nullptr || lacks_elements_) return;
  const auto d = along->numbers("direction");
  const Eigen::Vector3d direction(d[0], d[1], d[2]);
  if (!(direction.norm() > 0.0))
    return along->complain(diagnostics_, "direction", "has no length; give one such as [0, 1, 0]");
  auto pattern = inertia_pattern(model_, -direction.normalized());
  if (pattern.empty()) return along->complain(diagnostics_, "direction", "is along no displacement that the scene has");
  model_.loads.push_back({std::move(pattern), std::move(in_time), nullptr, 0.0});
}

}  // namespace butee::scene
