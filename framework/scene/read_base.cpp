#include <algorithm>
#include <set>

#include "butee/core/text.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Parameters;
using config::Value;

namespace {

/// A displacement with jumps in velocity, such as a ramp, would be an impact.
std::string complaint_about(const std::string& type, const TimeFunction& displacement) {
  if (type == "ramp")
    return "a ramp of displacement has jumps of velocity; give a table of the displacement, which is interpolated "
           "smoothly, or the acceleration";
  if (type == "table" && !displacement.discontinuities().empty() && displacement.discontinuities().front() > 0.0)
    return "a table of displacement must begin at t = 0 or before";
  return "";
}

}  // namespace

/// Reads [base], or [[base]] for several motions.
void SceneReader::read_base() {
  const Value* given = root_.table()->find("base");
  const bool has_still_stops = model_.base_frame == BaseFrame::still;
  if (given != nullptr) {
    if (given->table() != nullptr) {
      read_base_entry(*given, "base", false);
    } else {
      for (const auto& [entry, path] : entries("base")) read_base_entry(*entry, path, true);
    }
  }
  if (given == nullptr && has_still_stops)
    for (const auto& [entry, path] : entries("contact"))
      if (const Value* frame = entry->table() != nullptr ? entry->table()->find("frame") : nullptr;
          frame != nullptr && frame->text() != nullptr && *frame->text() == "space")
        diagnostics_.error(path + ".frame = \"space\"", frame->at,
                           "requires a moving base: give [base], or remove frame");
  if (model_.bases.empty() || lacks_elements_ || diagnostics_.error_count() > 0) return;
  const auto is_of_some = [](const BaseMotion& base) { return !base.nodes.empty(); };
  const auto some = std::count_if(model_.bases.begin(), model_.bases.end(), is_of_some);
  if (some > 0 && some < std::ssize(model_.bases))
    return diagnostics_.error("base", given->at,
                              "moves all supports in one entry and some in another; give every [[base]] its nodes, or "
                              "none");
  if (some > 0) model_.base_frame = BaseFrame::still;
  if (!can_be_still(*given)) return;
  for (const BaseMotion& base : model_.bases) add_base_loads(base);
}

void SceneReader::read_base_entry(const Value& entry, const std::string& path, bool takes_nodes) {
  std::vector<config::Parameter> declared = {
      config::table("acceleration", "the acceleration of the supports, m/s2, with its direction").optional(),
      config::table("displacement", "the displacement of the supports, m, with its direction, instead of acceleration")
          .optional(),
      config::number("initial_velocity", "m/s", "with acceleration, their velocity at t = 0").or_else(0.0)};
  if (takes_nodes)
    declared.push_back(config::texts("nodes", "the supports that move; default: all, with the ground").optional());
  const auto p = read_table(entry, path, declared);
  if (!p) return;
  const std::string key = p->has("acceleration") ? "acceleration" : "displacement";
  if (p->has("acceleration") == p->has("displacement"))
    return diagnostics_.error(path, entry.at,
                              p->has("acceleration")
                                  ? "has both acceleration and displacement; give one of them"
                                  : "give acceleration or displacement, such as { direction = [0, 1, 0], type = "
                                    "\"table\", file = \"quake.csv\" }");
  if (p->has("displacement") && p->given("initial_velocity"))
    return p->complain(diagnostics_, "initial_velocity",
                       "belongs to acceleration; displacement already defines the velocity");
  const Value& motion = p->value(key);
  if (motion.table() == nullptr) return diagnostics_.error(path + "." + key, motion, "must be one table, not several");
  const char* const unit = key == "acceleration" ? "m/s2" : "m";
  const auto in_time = read_in_time(motion, path + "." + key, {"direction"}, unit);
  std::vector<std::string> others;
  for (const auto& [name, value] : motion.table()->entries)
    if (name != "direction") others.push_back(name);
  const auto along = read_parameters(
      motion, path + "." + key, {config::numbers("direction", "1", "along which it acts, x, y and z").of_length(3)},
      diagnostics_, others);
  if (!along || in_time == nullptr) return;
  const auto d = along->numbers("direction");
  const Eigen::Vector3d direction(d[0], d[1], d[2]);
  if (!(direction.norm() > 0.0))
    return along->complain(diagnostics_, "direction", "has no length; give one such as [0, 1, 0]");
  BaseMotion base{direction.normalized(), std::nullopt, {}};
  if (p->has("nodes") && !read_base_nodes(*p, base)) return;
  if (key == "acceleration") {
    integrate_base(*in_time, p->number("initial_velocity"), base);
    if (base.motion && loses_digits((*base.motion)[2]))
      return diagnostics_.error(path + "." + key, motion.at,
                                "turns by " + to_short_text((*base.motion)[2].wave.angular_frequency * run_time()) +
                                    " rad in the run, too little for its double integral in double precision; give a "
                                    "constant or a ramp");
  }
  if (key != "acceleration" && !differentiate_base(motion, path + "." + key, *in_time, base)) return;
  if (!base.motion) {
    if (base.nodes.empty() && model_.base_frame == BaseFrame::moving) {
      auto pattern = inertia_pattern(model_, -base.direction);
      Load load{std::move(pattern), read_in_time(motion, path + "." + key, {"direction"}, unit), nullptr, 0.0};
      load.acceleration = -base.direction;
      model_.loads.push_back(std::move(load));
    } else {
      return p->complain(diagnostics_, key,
                         "stops with frame = \"space\" and independently moving supports need its integral; only "
                         "harmonic, constant, ramp and table can be integrated");
    }
  }
  if (base.nodes.empty() && !lacks_elements_ && inertia_pattern(model_, base.direction).empty())
    return along->complain(diagnostics_, "direction", "acts along no displacement of the scene");
  model_.bases.push_back(std::move(base));
}

bool SceneReader::read_base_nodes(const Parameters& p, BaseMotion& base) {
  const auto nodes = select(p, "nodes");
  if (!nodes) return false;
  base.nodes = *nodes;
  for (const NodeId node : base.nodes) {
    bool moves = false;
    for (const DofKind kind : {DofKind::ux, DofKind::uy, DofKind::uz})
      if (base.direction[axis_of(kind)] != 0.0)
        moves = moves || (dofs_->exists({node, kind}) && dofs_->is_fixed({node, kind}));
    if (moves || lacks_elements_) continue;
    p.complain(diagnostics_, "nodes",
               "no [[support]] holds " + model_.nodes.name(node) +
                   " along the direction; a base moves only nodes that are fixed to it");
    return false;
  }
  return true;
}

void SceneReader::integrate_base(const TimeFunction& acceleration, double initial_velocity, BaseMotion& base) {
  std::string problem;
  const SmoothMotion a = SmoothMotion::of(acceleration, problem);
  if (!problem.empty()) return;
  const SmoothMotion v = a.integral(initial_velocity);
  base.motion = {v.integral(0.0), v, a};
}

bool SceneReader::loses_digits(const SmoothMotion& acceleration) const {
  // The displacement A/omega^2 (1 - cos(omega t)) is a small difference of large numbers. Its relative rounding error
  // is 4 epsilon/(omega t)^2.
  constexpr double kLeastTurn = 1e-4;
  const double turn = acceleration.wave.angular_frequency * run_time();
  return acceleration.wave.amplitude != 0.0 && turn > 0.0 && turn < kLeastTurn;
}

bool SceneReader::differentiate_base(const Value& motion, const std::string& path, const TimeFunction& displacement,
                                     BaseMotion& base) {
  const Value* type = motion.table()->find("type");
  std::string problem = complaint_about(*type->text(), displacement);
  SmoothMotion d;
  if (problem.empty() && *type->text() == "table" && !displacement.discontinuities().empty()) {
    const std::vector<double> times = displacement.discontinuities();
    std::vector<double> values;
    for (const double t : times) values.push_back(displacement.value(t));
    d.line = PiecewisePolynomial::spline(times, values);
  } else if (problem.empty()) {
    d = SmoothMotion::of(displacement, problem);
  }
  if (!problem.empty()) {
    diagnostics_.error(path, motion.at, problem);
    return false;
  }
  const SmoothMotion v = d.derivative();
  base.motion = {d, v, v.derivative()};
  return true;
}

/// If x is absolute, some inputs cannot be represented.
bool SceneReader::can_be_still(const Value& given) {
  if (model_.base_frame == BaseFrame::moving) return true;
  const auto refuse = [&](const std::string& what) {
    diagnostics_.error("base", given.at, what);
    return false;
  };
  const std::string where =
      model_.bases.front().nodes.empty() ? "stops with frame = \"space\"" : "independently moving supports";
  if (model_.damping.is_modal())
    return refuse("modal damping requires motion relative to one base and cannot be combined with " + where +
                  "; give mass_proportional and stiffness_proportional");
  // A displacement that a base moves is fixed and not a DOF. Contacts take it as 0.
  std::set<NodeId> idle;
  const auto check_contacts = [&](const auto& group, const std::vector<DofKind>& along) {
    for (const auto* side : {&group.a, &group.b})
      for (const NodeId node : *side) {
        const auto moved = std::find_if(along.begin(), along.end(), [&](DofKind kind) {
          return moves_with_base(model_, *dofs_, {node, kind});
        });
        if (moved == along.end()) continue;
        const std::string begin = "moves " + model_.nodes.name(node) + " along " + name_of(*moved);
        if (!group.b.empty())
          return refuse(begin + ", a body of a contact between two bodies; with " + where +
                        ", both bodies need a free " + name_of(*moved) +
                        ": hold the moved one by a stiff spring instead of a support");
        const auto other = std::find_if(along.begin(), along.end(), [&](DofKind kind) {
          return dofs_->exists({node, kind}) && !dofs_->is_fixed({node, kind});
        });
        if (other != along.end())
          return refuse(begin + ", where a contact to ground also acts along " + name_of(*other) + "; with " + where +
                        ", such a node needs a free " + name_of(*moved) +
                        ": hold it by a stiff spring to a moved node instead of a support");
        idle.insert(node);
      }
    return true;
  };
  for (const StopGroup& group : model_.stops)
    if (!check_contacts(group, {group.dof})) return false;
  for (const ObstacleGroup& group : model_.obstacles)
    if (!check_contacts(group, group.directions)) return false;
  if (!idle.empty())
    diagnostics_.warning("base", given.at,
                         "moves " + model_.nodes.name(*idle.begin()) +
                             (idle.size() > 1 ? " and " + std::to_string(idle.size() - 1) + " more" : "") +
                             ", where contacts to ground act: with " + where +
                             " they are left out there, in contact forces and reactions; name only nodes without such "
                             "a support in [[contact]]");
  if (const auto node = turning_support(model_, *dofs_))
    return refuse("moves " + model_.nodes.name(*node) +
                  ", where a part that turns is supported and has gyroscopic effects or rotating damping; move the "
                  "far node of a bearing or spring between two nodes");
  return true;
}

/// For a [[contact]]: stops to ground either all move with the base or all stay in space.
void SceneReader::read_frame(const Parameters& p) {
  if (p.has("between")) {
    if (p.given("frame"))
      p.complain(diagnostics_, "frame", "applies to stops to ground (nodes), not to stops between bodies");
    return;
  }
  const BaseFrame frame = p.text("frame") == "space" ? BaseFrame::still : BaseFrame::moving;
  if (stop_frame_ && *stop_frame_ != frame)
    p.complain(
        diagnostics_, "frame",
        "differs from that of another [[contact]]: stops to ground all move with the base, or all stay in space");
  stop_frame_ = frame;
  model_.base_frame = frame;
}

void SceneReader::add_base_loads(const BaseMotion& base) {
  if (!base.motion) return;
  const auto add = [&](const std::vector<NodalValue>& pattern, double sign, std::size_t order,
                       const Eigen::Vector3d& acceleration) {
    if (pattern.empty()) return;
    for (auto& in_time : (*base.motion)[order].parts()) {
      Load load{pattern, std::move(in_time), nullptr, 0.0};
      for (NodalValue& value : load.pattern) value.value *= sign;
      load.acceleration = acceleration;
      model_.loads.push_back(std::move(load));
    }
  };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  if (model_.base_frame == BaseFrame::moving)
    return add(inertia_pattern(model_, base.direction), -1.0, 2, -base.direction);
  const auto forces = prescribed_forces(model_, *dofs_, base.direction, base.nodes);
  if (base.nodes.empty()) {
    add(forces.mass, -1.0, 2, none);
    add(forces.damping, 1.0, 1, none);
    add(forces.stiffness, 1.0, 0, none);
    return;
  }
  add(forces.mass, -1.0, 2, none);
  add(forces.damping, -1.0, 1, none);
  add(forces.stiffness, -1.0, 0, none);
}

}  // namespace butee::scene
