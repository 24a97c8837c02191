#include "butee/embed/structure.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <typeinfo>
#include <utility>

#include "butee/config/file_reference.hpp"
#include "butee/config/override.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"
#include "butee/embed/forced_dof.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/record/probes.hpp"
#include "butee/scene/assembly.hpp"

namespace butee::embed {
namespace {

namespace fs = std::filesystem;

/// Throws LogicError unless `value` may be set.
void check_number(double value, const char* name) {
  if (std::abs(value) <= Structure::kLargestNumber) return;
  throw LogicError(std::string(name) + " is " + to_short_text(value) + "; it must be a finite number of at most " +
                   to_short_text(Structure::kLargestNumber));
}

void check_numbers(ConstVectorRef values, const char* name, Index size) {
  if (values.size() != size)
    throw LogicError(std::string(name) + ": " + std::to_string(values.size()) + " numbers are given for " +
                     std::to_string(size) + " degrees of freedom");
  for (const double value : values) check_number(value, name);
}

/// Throws LogicError unless `t` is after the present instant, or equal to it if `may_stay`.
void check_time(double t, double now, bool may_stay, const char* name) {
  if (std::isfinite(t) && (t > now || (may_stay && t == now))) return;
  throw LogicError(std::string(name) + " = " + to_short_text(t) + " s: the time must be finite and " +
                   (may_stay ? "not before" : "after") + " the present one, " + to_short_text(now) +
                   " s; only restore() goes back");
}

void check_dof(Index dof, Index size) {
  if (dof < 0 || dof >= size)
    throw LogicError("the degree of freedom " + std::to_string(dof) + " does not exist; there are 0 to " +
                     std::to_string(size - 1));
}

/// The scene with the checksums of the files that it names, whose paths are taken from its own folder. A file that
/// cannot be read is left to read_scene().
std::string identity_of(const config::Document& document) {
  const std::string folder = fs::path(config::path_beside(document, "scene")).parent_path().string();
  try {
    return config::write_toml(config::with_files_found_from(document, folder.empty() ? "." : folder));
  } catch (const InputError&) {
    return config::write_toml(*document.root.table());
  }
}

}  // namespace

/// All data of a structure, in the order in which the parts refer to each other.
struct Structure::Parts {
  scene::Scene scene;
  std::uint64_t origin;                   ///< identifies the snapshots
  std::map<Index, NodalForce*> forces{};  ///< by DOF; owned by the model's loads
  std::optional<scene::Assembly> assembly{};
  std::vector<std::unique_ptr<record::Peaks>> peaks{};
  bool is_advancing = false;
  bool has_jumped = false;  ///< the state has been set, or changed by a new force, since the last step

  std::vector<model::NodalDof> select(const std::string& selector, DofKind kind) const;
  void add_forces(const std::string& selector, std::vector<std::pair<model::NodalDof, NodalForce*>>& made);
  NodalForce& force_on(Index dof);
  /// Throws InputError if record::Peaks cannot follow the quantity.
  void check_peak(const std::string& node_name, model::NodeId node, model::Quantity quantity);
  /// Lets the peaks take a state that has jumped, before a step or a question for them.
  void take_jump() {
    if (!std::exchange(has_jumped, false)) return;
    for (const auto& each : peaks) each->take(assembly->simulation.state());
  }
  /// Takes a step; false at the end of the run.
  bool advance() {
    take_jump();
    return assembly->simulation.advance();
  }
  /// Throws LogicError if the call comes from a function that advance_to() or advance_step() calls.
  void check_idle(const char* call) const {
    if (is_advancing) throw LogicError(std::string(call) + "() is called within a step; call it after advance_to()");
  }
  /// Changes `origin` by an observer or by what it follows, so that snapshots without it are refused.
  void mark(const std::string& what) { origin = 31 * origin + std::hash<std::string>{}(what); }
};

std::vector<model::NodalDof> Structure::Parts::select(const std::string& selector, DofKind kind) const {
  const auto selection = scene.model.nodes.select(selector);
  if (selection.nodes.empty()) throw InputError(selector + ": " + selection.problem);
  std::vector<model::NodalDof> dofs;
  for (const model::NodeId node : selection.nodes) dofs.push_back({node, kind});
  return dofs;
}

void Structure::Parts::add_forces(const std::string& selector,
                                  std::vector<std::pair<model::NodalDof, NodalForce*>>& made) {
  const auto [nodes, kind] = split_forced(selector);
  const std::size_t before = made.size();
  const model::DofTable table = number_dofs(scene.model);
  for (const model::NodalDof dof : select(nodes, kind)) {
    if (table.index(dof) < 0) continue;
    auto force = std::make_unique<NodalForce>();
    made.emplace_back(dof, force.get());
    scene.model.loads.push_back({{{dof, 1.0}}, std::move(force), nullptr, 0.0});
  }
  if (made.size() == before)
    throw InputError(selector + ": names no free " + name_of(kind) + " on which a force could act");
}

void Structure::Parts::check_peak(const std::string& node_name, model::NodeId node, model::Quantity quantity) {
  const std::string problem =
      model::is_element_force(quantity) ? "" : model::why_not(quantity, scene.model, assembly->system.dofs, node, "");
  if (!problem.empty()) throw InputError(node_name + ": " + problem);
  const bool is_of_obstacle = model::is_contact_force(quantity) && assembly->dynamics.obstacles() != nullptr;
  const bool has_base = record::Probes::has_base_share(assembly->system.model, assembly->system.dofs, node, quantity);
  if (!model::is_element_force(quantity) && !is_of_obstacle && !has_base) return;
  throw InputError(node_name + ": peaks of " + model::name_of(quantity) + " are not followed" +
                   (is_of_obstacle ? " beside contacts with dissipation, friction or motion in a plane"
                    : has_base     ? ", since it contains the motion of the base"
                                   : "") +
                   "; quantity() gives it at an instant");
}

NodalForce& Structure::Parts::force_on(Index dof) {
  const auto found = forces.find(dof);
  if (found != forces.end()) return *found->second;
  throw InputError(
      (dof >= 0 && dof < assembly->system.size() ? assembly->dynamics.dof_name(dof) : "DOF " + std::to_string(dof)) +
      ": it was not declared for forces; name its node in `forced` when the structure is made");
}

Structure::Structure(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Structure::Parts& Structure::parts() const {
  if (parts_ != nullptr) return *parts_;
  throw LogicError("the structure was moved from; use the one that it was moved to");
}

Structure::Structure(Structure&& other) noexcept = default;
Structure& Structure::operator=(Structure&& other) noexcept = default;
Structure::~Structure() = default;

Structure Structure::from_file(const std::string& path, const StructureOptions& options) {
  return from_document(config::load_toml(path), options);
}

Structure Structure::from_toml(const std::string& text, const StructureOptions& options) {
  return from_document(config::parse_toml(text, "scene"), options);
}

Structure Structure::from_document(config::Document document, const StructureOptions& options) {
  for (const std::string& assignment : options.overrides) config::apply_override(document, assignment);
  // advance_to() determines the end of the run.
  config::Value& integrator = (*document.root.table())["integrator"];
  if (config::Table* table = integrator.table(); table != nullptr && table->find("end_time") == nullptr)
    (*table)["end_time"] = config::Value(1.0);

  const std::string identity = identity_of(document) + join(options.forced, "\n");
  auto parts = std::unique_ptr<Parts>(new Parts{
      scene::read_scene(std::move(document),
                        options.catalogue ? *options.catalogue : plugin::Catalogue::with_plugins(options.plugins),
                        scene::Output::ignored),
      checksum(std::as_bytes(std::span(identity)))});
  for (const std::string& line : parts->scene.warnings) log::warning(line);
  std::vector<std::pair<model::NodalDof, NodalForce*>> made;
  for (const std::string& selector : options.forced) parts->add_forces(selector, made);
  parts->assembly.emplace(parts->scene);
  for (const auto& [dof, force] : made)
    if (const Index free = parts->assembly->system.dofs.index(dof); !parts->forces.emplace(free, force).second)
      throw InputError("forced names " + parts->assembly->dynamics.dof_name(free) +
                       " twice; name every degree of freedom once");
  return Structure(std::move(parts));
}

Index Structure::size() const {
  return parts().assembly->system.size();
}

std::string Structure::dof_name(Index dof) const {
  check_dof(dof, size());
  return parts().assembly->dynamics.dof_name(dof);
}

Index Structure::dof(const std::string& selector, DofKind kind) const {
  const auto dofs = parts().select(selector, kind);
  if (dofs.size() != 1)
    throw InputError(selector + ": names " + std::to_string(dofs.size()) + " nodes; dofs() takes several");
  const Index index = parts().assembly->system.dofs.index(dofs.front());
  if (index >= 0) return index;
  throw InputError(selector + ": " + name_of(kind) +
                   (index == model::DofTable::kFixed ? " is fixed by a support there" : " does not exist there"));
}

std::vector<Index> Structure::dofs(const std::string& selector, DofKind kind) const {
  std::vector<Index> free;
  for (const model::NodalDof dof : parts().select(selector, kind))
    if (const Index index = parts().assembly->system.dofs.index(dof); index >= 0) free.push_back(index);
  return free;
}

/// Refuses further calls that change the state until it is destroyed.
class Structure::Advance {
 public:
  Advance(Parts& parts, const char* call) : parts_(parts) {
    parts.check_idle(call);
    parts.is_advancing = true;
  }
  Advance(const Advance&) = delete;
  Advance& operator=(const Advance&) = delete;
  ~Advance() { parts_.is_advancing = false; }

 private:
  Parts& parts_;
};

void Structure::advance_to(double t) {
  advance_to(t, nullptr);
}

bool Structure::advance_to(double t, const std::function<bool()>& goes_on) {
  const Advance advance(parts(), "advance_to");
  time::Simulation& simulation = parts().assembly->simulation;
  simulation.start();
  check_time(t, time(), true, "advance_to");
  if (t == time() && !simulation.report().message.empty()) throw RunError(simulation.report().message);
  if (t == time()) return true;
  if (simulation.report().message.empty()) simulation.set_end_time(t);
  while (parts().advance())
    if (goes_on && !goes_on()) return false;
  if (!simulation.report().completed) throw RunError(simulation.report().message);
  return true;
}

double Structure::advance_step(double limit) {
  const Advance advance(parts(), "advance_step");
  time::Simulation& simulation = parts().assembly->simulation;
  simulation.start();
  check_time(limit, time(), false, "advance_step");
  if (simulation.report().message.empty()) simulation.set_end_time(limit);
  parts().advance();
  if (!simulation.report().message.empty()) throw RunError(simulation.report().message);
  return time();
}

const time::State& Structure::state() const {
  parts().assembly->simulation.start();
  return parts().assembly->simulation.state();
}

double Structure::displacement(Index dof) const {
  check_dof(dof, size());
  return state().x[dof];
}

double Structure::velocity(Index dof) const {
  check_dof(dof, size());
  return state().v[dof];
}

double Structure::acceleration(Index dof) const {
  check_dof(dof, size());
  return state().a[dof];
}

void Structure::set_motion(ConstVectorRef displacements, ConstVectorRef velocities) {
  parts().check_idle("set_motion");
  check_numbers(displacements, "a displacement", size());
  check_numbers(velocities, "a velocity", size());
  parts().assembly->simulation.set_motion(displacements, velocities);
  parts().has_jumped = true;
}

void Structure::set_displacement(Index dof, double value) {
  check_dof(dof, size());
  Vector x = state().x;
  x[dof] = value;
  set_motion(x, Vector(state().v));
}

void Structure::set_velocity(Index dof, double value) {
  check_dof(dof, size());
  Vector v = state().v;
  v[dof] = value;
  set_motion(Vector(state().x), v);
}

void Structure::set_force(Index dof, double value) {
  check_number(value, "a force");
  set_line(dof, {value, 0.0, time()});
}

void Structure::set_force(Index dof, double from, double to, double until) {
  for (const double value : {from, to}) check_number(value, "a force");
  check_time(until, time(), false, "set_force until");
  const double slope = (to - from) / (until - time());
  check_number(slope, "the slope of a force");
  set_line(dof, {from, slope, time()});
}

void Structure::set_line(Index dof, const NodalForce::Line& line) {
  NodalForce& force = parts().force_on(dof);
  if (parts().assembly->simulation.is_observed())
    throw LogicError("set_force() is called by an observer; call it between steps, for example in goes_on");
  const bool jump = force.value(time()) != line.value;
  force.line = line;
  parts().assembly->simulation.loads_changed(jump);
  parts().has_jumped = true;
}

double Structure::force(Index dof) const {
  return parts().force_on(dof).value(time());
}

double Structure::contact_force(Index dof) const {
  check_dof(dof, size());
  Vector force = Vector::Zero(size());
  const time::State& now = state();
  parts().assembly->dynamics.add_held_contact_force(now.t, now.x, now.v, force);
  return force[dof];
}

double Structure::quantity(const std::string& name, const std::string& node, const std::string& element) const {
  const model::Quantity quantity = model::quantity_of(name);
  if (const auto source = source_of(quantity);
      !element.empty() && source != model::Source::section && source != model::Source::springs)
    throw InputError(element + ": " + name + " is not the force of an element; give no element");
  const auto nodes = parts().select(node, DofKind::u);
  if (nodes.size() != 1)
    throw InputError(node + ": names " + std::to_string(nodes.size()) + " nodes; exactly one is required");
  const std::string problem =
      model::why_not(quantity, parts().scene.model, parts().assembly->system.dofs, nodes.front().node, element);
  if (!problem.empty()) throw InputError(node + ": " + problem);
  record::Probes probe({{"", nodes.front().node, {quantity}, element}}, parts().assembly->dynamics);
  double value = 0.0;
  probe.evaluate(state(), {&value, 1});
  return value;
}

Structure::Snapshot Structure::snapshot() const {
  Snapshot snapshot{parts().assembly->simulation.snapshot(), {}, parts().origin};
  for (const auto& [dof, force] : parts().forces) snapshot.forces.push_back(force->line);
  return snapshot;
}

void Structure::restore(const Snapshot& snapshot) {
  parts().check_idle("restore");
  if (snapshot.origin != parts().origin)
    throw LogicError("the snapshot is of another structure: its scene, options or observers differ");
  if (snapshot.forces.size() != parts().forces.size())
    throw LogicError("the snapshot has " + std::to_string(snapshot.forces.size()) + " forces; the structure has " +
                     std::to_string(parts().forces.size()));
  parts().assembly->simulation.restore(snapshot.run);
  auto line = snapshot.forces.begin();
  for (const auto& [dof, force] : parts().forces) force->line = *line++;
  parts().assembly->dynamics.loads_changed();
  parts().has_jumped = true;
}

void Structure::observe(time::Observer& observer) {
  parts().assembly->simulation.add(observer);
  parts().mark(typeid(observer).name());
}

void Structure::follow_peaks(const std::string& selector, const std::vector<model::Quantity>& quantities) {
  std::vector<model::ProbeRequest> requests;
  std::string label;
  for (const model::NodalDof dof : parts().select(selector, DofKind::u)) {
    requests.push_back({parts().scene.model.nodes.name(dof.node), dof.node, quantities});
    for (const model::Quantity quantity : quantities) {
      parts().check_peak(requests.back().label, dof.node, quantity);
      label += requests.back().label + "." + model::name_of(quantity) + "\n";
    }
  }
  auto peaks = std::make_unique<record::Peaks>(requests, parts().assembly->dynamics);
  parts().assembly->simulation.add(*peaks);
  parts().peaks.push_back(std::move(peaks));
  parts().mark(label);
}

std::map<std::string, double> Structure::peaks() const {
  parts().assembly->simulation.start();
  parts().take_jump();
  std::map<std::string, double> all;
  for (const auto& peaks : parts().peaks) all.merge(peaks->largest());
  return all;
}

double Structure::peak(const std::string& node, model::Quantity quantity) const {
  const auto dofs = parts().select(node, DofKind::u);
  const auto all = peaks();
  const auto found =
      all.find(parts().scene.model.nodes.name(dofs.front().node) + "." + std::string(model::name_of(quantity)));
  if (dofs.size() == 1 && found != all.end()) return found->second;
  throw InputError(node + ": no peaks of its " + model::name_of(quantity) + " are followed");
}

record::Energy Structure::energy() const {
  return record::energy_of(state(), parts().assembly->dynamics);
}

const std::string& Structure::method() const {
  return parts().scene.integrator.name;
}

const linalg::Counters& Structure::counters() const {
  return parts().assembly->dynamics.counters();
}

const time::RunReport& Structure::report() const {
  return parts().assembly->simulation.report();
}

}  // namespace butee::embed
