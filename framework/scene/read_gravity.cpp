#include "butee/core/text.hpp"
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
    std::vector<std::string> able;
    for (int axis = 0; axis < 3; ++axis)
      if (!inertia_pattern(model_, Eigen::Vector3d::Unit(axis)).empty()) able.emplace_back(1, "xyz"[axis]);
    p->complain(
        diagnostics_, "acceleration",
        "acts along no displacement of the scene" +
            (able.empty() ? "" : ", which moves along " + join(able) + "; the numbers are those along x, y and z"));
    return;
  }
  config::Table unity;
  unity["value"] = Value(1.0);
  const LoadType& constant = *find_type(types_.loads, "constant");
  Load load{std::move(pattern), constant.make(config::make_parameters(constant.parameters, unity), diagnostics_),
            nullptr, 0.0};
  load.acceleration = Eigen::Vector3d(g[0], g[1], g[2]);
  gravity_load_ = model_.loads.size();
  model_.loads.push_back(std::move(load));
  model_.starts_static = p->flag("static");
}

}  // namespace butee::scene
