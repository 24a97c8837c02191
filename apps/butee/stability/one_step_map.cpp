#include "one_step_map.hpp"

#include <cmath>

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::app::stability {
namespace {

/// Relative deviation from linearity that is accepted: far above the rounding of a step, far below any
/// nonlinearity.
constexpr double kLinear = 1e-6;

std::string scene_of(const Oscillator& oscillator) {
  std::string text =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = " +
      to_text(oscillator.stiffness) + "\ndamping = " + to_text(oscillator.damping) + "\n";
  if (oscillator.stop > 0.0)
    text += "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.0\nlaw = \"linear\"\nstiffness = " +
            to_text(oscillator.stop) + "\n";
  return text + "[integrator]\nend_time = 1e6\n";
}

config::Document document_of(const time::IntegratorType& type, const std::vector<std::string>& settings,
                             const Oscillator& oscillator) {
  config::Document document = config::parse_toml(scene_of(oscillator), "butee stability");
  config::Table& integrator = *(*document.root.table())["integrator"].table();
  integrator["type"] = config::Value(type.name);
  if (!type.finds_first_step) integrator["time_step"] = config::Value(1.0);
  for (const config::Parameter& parameter : type.parameters) {
    if (!parameter.required) continue;
    if (parameter.first_try)
      integrator[parameter.name] = *parameter.first_try;
    else if (parameter.swept)
      integrator[parameter.name] = config::Value(parameter.swept->first);
  }
  for (const std::string& setting : settings)
    config::apply_override(document, setting.rfind("integrator.", 0) == 0 ? setting : "integrator." + setting);
  return document;
}

std::string parameters_of(const config::Document& document) {
  std::string text;
  for (const auto& [key, value] : document.root.table()->find("integrator")->table()->entries) {
    if (key == "type" || key == "time_step" || key == "end_time") continue;
    if (!text.empty()) text += ", ";
    text += key + " = " + config::to_toml(value);
  }
  return text;
}

}  // namespace

OneStepMap::OneStepMap(const plugin::Catalogue& catalogue, const std::string& method,
                       const std::vector<std::string>& settings, const Oscillator& oscillator)
    : catalogue_(catalogue), type_(catalogue_.load(method)), rate_(std::sqrt(oscillator.stiffness + oscillator.stop)) {
  if (!(rate_ > 0.0)) rate_ = 1.0;
  config::Document document = document_of(type_, settings, oscillator);
  parameters_ = parameters_of(document);
  session_ = std::make_unique<scene::Scene>(scene::read_scene(std::move(document), catalogue_));
  assembly_ = std::make_unique<scene::Assembly>(*session_);
}

std::optional<Eigen::Vector3d> OneStepMap::step(const Eigen::Vector3d& from, double h) {
  time::State begin, end;
  begin.x = Vector::Constant(1, from[0]);
  begin.v = Vector::Constant(1, from[1] * rate_);
  assembly_->integrator->start(begin);
  begin.a[0] = from[2] * rate_ * rate_;
  const time::StepReport report = assembly_->integrator->step(begin, {h, h, true}, end);
  if (report.status != time::StepStatus::ok) {
    refusal_ = "a step of h = " + to_short_text(h) + " s fails";
    return std::nullopt;
  }
  if (end.t < h || report.inner_steps > 1) {
    refusal_ = "given a step of h = " + to_short_text(h) + " s it takes shorter steps of its own choice";
    return std::nullopt;
  }
  // A step that error control would reject may come without an updated acceleration.
  const time::StepController* controller = assembly_->integrator->controller();
  if (controller != nullptr && end.a == begin.a && !controller->decide(h, report).accept)
    assembly_->dynamics.acceleration(end.t, end.x, end.v, end.a);
  return Eigen::Vector3d(end.x[0], end.v[0] / rate_, end.a[0] / (rate_ * rate_));
}

std::optional<Eigen::Matrix3d> OneStepMap::at(double h) {
  // All states have nonzero displacement and velocity: the stop is closed from the start, and relative errors
  // are defined.
  const Eigen::Vector3d one(1.0, 1.0, 0.0), moving(1.0, 2.0, 0.0), pushed(1.0, 1.0, 1.0), other(2.0, -1.0, 0.5);
  const auto first = step(one, h), second = step(moving, h), third = step(pushed, h), fourth = step(other, h);
  if (!first || !second || !third || !fourth) return std::nullopt;
  Eigen::Matrix3d map;
  map << 2.0 * *first - *second, *second - *first, *third - *first;
  if ((map * other - *fourth).norm() > kLinear * (map.norm() + 1.0)) {
    refusal_ = "a step of h = " + to_short_text(h) + " s is not linear in the state";
    return std::nullopt;
  }
  return map;
}

}  // namespace butee::app::stability
