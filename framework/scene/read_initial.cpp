#include <algorithm>
#include <cmath>
#include <filesystem>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/model/saved_motion.hpp"
#include "butee/model/system.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Parameters;
using config::Value;

namespace {

/// Relative tolerance for matching an instant to a saved one.
constexpr double kSameTime = 1e-9;
/// A DOF that a rigid rotation moves by less than this fraction of its largest displacement is not
/// moved.
constexpr double kUnmoved = 1e-12;
/// The largest initial value: its square, an energy, must be a finite number.
constexpr double kLargest = 1e100;

/// True if a support that moves by itself stands elsewhere at t = 0 than at `t`.
bool jumps_back(const std::vector<BaseMotion>& bases, double t) {
  return std::any_of(bases.begin(), bases.end(), [t](const BaseMotion& base) {
    return !base.nodes.empty() && base.motion && base.motion->front().value(t) != base.motion->front().value(0.0);
  });
}

const SavedMotion* find_motion(const SavedMotions& saved, double at) {
  for (const SavedMotion& motion : saved.motions)
    if (std::abs(motion.t - at) <= kSameTime * std::max(std::abs(at), saved.motions.back().t)) return &motion;
  return nullptr;
}

std::string times_of(const SavedMotions& saved) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> times;
  for (const SavedMotion& motion : saved.motions) times.push_back(to_short_text(motion.t));
  if (times.size() > kMost) times.erase(times.begin() + kMost / 2, times.end() - kMost / 2);
  return join(times);
}

}  // namespace

void SceneReader::read_initial() {
  const Value* table = root_.table()->find("initial");
  if (table == nullptr) return;
  const auto p = read_parameters(
      *table, "initial",
      {config::table("displacement", "initial displacements, such as { nodes = \"NODE\", value = 0.01 }").optional(),
       config::table("velocity", "initial velocities, such as { nodes = \"NODE\", value = 0.5 }").optional(),
       config::text("from", "the result folder of the run from which this one starts, relative to the scene")
           .optional(),
       config::number("at", "s", "the instant of that run; default: its end").optional(),
       config::boolean("keep_time", "true: begin at that instant; false: at t = 0").or_else(false),
       config::integer("size", "bytes of its states.bin, as in model.toml").at_least(0).optional(),
       config::text("checksum", "CRC-64 of its states.bin, likewise").optional()},
      diagnostics_);
  if (p && p->has("from")) read_initial_motion(*p);
  if (p && !p->has("from"))
    for (const char* key : {"at", "keep_time", "size", "checksum"})
      if (p->given(key)) p->complain(diagnostics_, key, "belongs to from, which is not given");
  if (table->table() == nullptr) return;
  for (const std::string key : {"displacement", "velocity"})
    if (const Value* given = table->table()->find(key)) read_initial_list(*given, key);
  if (const Value* given = table->table()->find("displacement"); given != nullptr && model_.starts_static)
    diagnostics_.warning("initial.displacement", given->at,
                         "is only where the search for the static position begins, since [gravity] static starts the "
                         "run there");
}

void SceneReader::read_initial_motion(const Parameters& p) {
  const std::string path =
      (std::filesystem::path(config::path_beside(diagnostics_.document(), p.text("from"))) / SavedMotions::kFile)
          .string();
  const auto complain = [&](const std::string& key, const std::string& complaint) {
    p.complain(diagnostics_, key, printable(complaint));
  };
  SavedMotions saved;
  try {
    const std::string bytes = config::read_text(path);
    const std::string change =
        config::change_of(bytes, p.has("size") ? p.integer("size") : 0, p.has("checksum") ? p.text("checksum") : "");
    if (!change.empty()) return complain("from", "states.bin there " + change);
    saved = to_saved_motions(std::as_bytes(std::span(bytes)));
  } catch (const InputError& error) {
    return complain("from", path + " " + error.what() + "; name the result folder of a run that was completed");
  } catch (const RunError& error) {
    return complain("from", path + " " + error.what());
  }
  if (diagnostics_.error_count() > 0) return;  // The structure may be incomplete because of errors.
  const std::string difference = saved.difference_from(model_.nodes, *dofs_);
  if (!difference.empty()) return complain("from", "is a run of another structure: " + difference);
  if (saved.motions.empty()) return complain("from", "contains no motion");
  if (saved.has_base && !model_.bases.empty() && saved.in_space != moves_apart(model_.bases))
    return complain("from",
                    saved.in_space
                        ? "is a run whose supports move one by one, so that its motion is that in space; here it is "
                          "relative to a common [base]"
                        : "is a run whose motion is relative to a common [base]; here supports move one by one, "
                          "and the motion is that in space");
  const SavedMotion* motion = p.has("at") ? find_motion(saved, p.number("at")) : &saved.motions.back();
  if (motion == nullptr)
    return complain("at", "is not an instant saved by that run; saved: " + times_of(saved) + " s. Add it to [output] " +
                              "states of that scene and run it again");
  if (model_.starts_static)
    return complain("from",
                    "conflicts with [gravity] static, which starts at rest in the static position; give one of "
                    "the two");
  if (!p.flag("keep_time") && jumps_back(model_.bases, motion->t))
    diagnostics_.warning("initial.from", p.value("from").at,
                         "is the motion at t = " + to_short_text(motion->t) +
                             " s, and the [[base]] motions begin anew at t = 0, where their supports stand elsewhere; "
                             "with keep_time = true they go on");
  model_.initial_motion = InitialMotion{motion->x, motion->v, p.flag("keep_time") ? motion->t : 0.0};
  if (saved.contacts == contact_names(model_, *dofs_))
    model_.initial_motion->contact = motion->contact;
  else if (std::any_of(model_.obstacles.begin(), model_.obstacles.end(),
                       [](const auto& group) { return group.friction.has_memory(); }))
    diagnostics_.warning("initial.from", p.value("from").at,
                         "is a run with other contacts; friction with stick starts here without a force");
}

void SceneReader::read_initial_list(const Value& given, const std::string& key) {
  if (!config::table(key, "").complaint(given).empty()) return;
  const std::string path = "initial." + key;
  if (given.array() == nullptr) return read_initial_entry(given, path + "[0]", key);
  for (std::size_t i = 0; i < given.array()->size(); ++i)
    read_initial_entry((*given.array())[i], path + "[" + std::to_string(i) + "]", key);
}

void SceneReader::read_initial_entry(const Value& entry, const std::string& path, const std::string& key) {
  const bool moves = key == "velocity";
  const auto p = read_table(
      entry, path,
      {config::texts("nodes", "the nodes"),
       config::text("dof", "the degree of freedom").one_of(dof_names()).or_else("u"),
       config::number("value", moves ? "m/s" : "m", "the value").optional(),
       config::number("rotation", moves ? "rad/s" : "rad", "instead of value, a rigid rotation of a beam").optional(),
       config::number("about", "m", "the coordinate that stays in place").optional()});
  if (!p) return;
  const bool rotates = p->has("rotation");
  if (!rotates && !p->has("value"))
    return p->complain(
        diagnostics_, "value",
        std::string("missing; give the value (number, ") + (moves ? "m/s" : "m") + ")" + ", or rotation and about");
  if (rotates && p->has("value"))
    return p->complain(diagnostics_, "rotation", "conflicts with value; give one of the two");
  if (rotates && p->given("dof"))
    return p->complain(diagnostics_, "dof", "conflicts with rotation, which sets u and theta");
  if (rotates != p->has("about"))
    return p->complain(diagnostics_, "about",
                       rotates ? "missing; give the coordinate that stays in place (number, m)"
                               : "belongs to rotation, which is not given");
  const auto nodes = select(*p, "nodes");
  if (!nodes) return;
  std::vector<NodalValue> values;
  if (rotates)
    values = rigid_rotation(*p, *nodes);
  else
    for (const NodeId node : *nodes) values.push_back({{node, *dof_named(p->text("dof"))}, p->number("value")});
  std::vector<NodalValue>& target = moves ? model_.initial_velocity : model_.initial_displacement;
  for (const NodalValue& value : values) {
    if (!(std::abs(value.value) <= kLargest))
      return p->complain(diagnostics_, rotates ? "rotation" : "value",
                         "gives " + dofs_->name(value.dof) + " an initial " + key + " of " +
                             to_short_text(value.value) + "; it must be at most " + to_short_text(kLargest));
    check_free(*p, "nodes", value.dof, "an initial value");
    const auto same = [&](const NodalValue& other) {
      return other.dof.kind == value.dof.kind &&
             model_.nodes.canonical(other.dof.node) == model_.nodes.canonical(value.dof.node);
    };
    if (std::any_of(target.begin(), target.end(), same))
      p->complain(diagnostics_, "nodes", "gives " + dofs_->name(value.dof) + " a second initial " + key);
  }
  target.insert(target.end(), values.begin(), values.end());
}

std::vector<NodalValue> SceneReader::rigid_rotation(const Parameters& p, const std::vector<NodeId>& nodes) {
  const double rotation = p.number("rotation"), about = p.number("about");
  std::vector<NodalValue> values;
  double largest = 0.0;
  for (const NodeId node : nodes) {
    const NodeGroup& group = model_.nodes.group_of(node);
    if (group.lone()) {
      p.complain(diagnostics_, "nodes", model_.nodes.name(node) + " is not a node of a beam, so it has no coordinate");
      return {};
    }
    // Along the beam; the axis of the rotation is parallel to z.
    const double arm = group.coordinates[static_cast<std::size_t>(node - group.first)] - about;
    values.push_back({{node, DofKind::u}, rotation * arm * group.direction[0]});
    if (group.direction[1] != 0.0) values.push_back({{node, DofKind::ux}, -rotation * arm * group.direction[1]});
    values.push_back({{node, DofKind::theta}, rotation});
    largest = std::max(largest, std::abs(rotation * arm));
  }
  // A support on the axis of the rotation does not prevent it.
  std::erase_if(values, [&](const NodalValue& value) {
    return dofs_->exists(value.dof) && dofs_->is_fixed(value.dof) && value.dof.kind != DofKind::theta &&
           std::abs(value.value) <= kUnmoved * largest;
  });
  return values;
}

}  // namespace butee::scene
