#include <algorithm>

#include "butee/config/number_file.hpp"
#include "butee/scene/contact_tables.hpp"
#include "butee/scene/keys_of_others.hpp"
#include "butee/scene/scene_reader.hpp"
#include "butee/scene/turning_parts.hpp"

namespace butee::scene {

using config::number;
using config::Parameters;
using config::text;
using config::Value;

namespace {

constexpr const char* kStop = "stop";
constexpr const char* kFriction = "friction";

Sides sides_of(const std::string& name) {
  if (name == "positive") return Sides::positive;
  return name == "negative" ? Sides::negative : Sides::both;
}

/// One stop or a pair of stops in a single direction.
class StopShape final : public ContactShape {
 public:
  explicit StopShape(const FreePlay& play) : play_(play) {}
  Approach at(const Eigen::Vector2d& d) const override {
    const double side = play_.side(d[0]);
    return {play_.penetration(d[0]), {side == 0.0 ? 1.0 : side, 0.0}, 0.0};
  }
  Form form() const override {
    if (play_.has_both()) return {Form::Kind::circle, {0.0, 0.0}, play_.gap, 1.0};
    return {Form::Kind::line, {play_.side(0.0), 0.0}, play_.gap, 1.0};
  }

 private:
  FreePlay play_;
};

/// The gap is required unless the entry has another key for it.
std::vector<config::Parameter> gap_parameters(const config::Table& entry) {
  const config::Parameter gap = number("gap", "m", "the free play on each side").at_least(0);
  const bool has_other = entry.find("gaps") != nullptr || entry.find("gaps_from") != nullptr;
  return {has_other ? gap.optional() : gap,
          config::numbers("gaps", "m", "the free play of each contact, instead of gap").optional(),
          config::table("gaps_from", "a file with a column of gaps, instead of gap, such as { file = \"gaps.csv\" }")
              .optional()};
}

std::vector<std::string> stop_dof_names() {
  return {"u", "w", "theta", "ux", "uy", "uz", "rx", "ry", "rz"};
}

/// The keys of every contact: where it is, and its frame.
std::vector<config::Parameter> general_contact_parameters() {
  return {config::texts("nodes", "the nodes that meet the obstacle").optional(),
          config::texts("between", "two selectors: contacts on u_a - u_b, pair by pair").optional(),
          config::table("friction", "Coulomb friction, such as { coefficient = 0.2 }").optional(),
          text("frame", "for a contact with ground under [base]: it moves with the base, or stays in space")
              .one_of({"base", "space"})
              .or_else("base"),
          number("radius", "m", "the radius of the turning body at the contact").at_least(0).optional()};
}

}  // namespace

/// The kind of a contact and the types that it uses; without a name if the entry has none that is known.
struct SceneReader::ContactKind {
  std::string name, law_name;
  const LawType* law = nullptr;        ///< null for a friction support, or an unknown law
  const ContactType* shape = nullptr;  ///< null for stops and friction supports

  bool is_support() const { return name == kFriction; }
  bool is_stop() const { return name.empty() || name == kStop; }

  std::vector<config::Parameter> parameters(const config::Table& entry) const {
    std::vector<config::Parameter> all = general_contact_parameters();
    const auto add = [&](const std::vector<config::Parameter>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    if (!is_support()) {
      add(gap_parameters(entry));
      add({config::table("damping",
                         "dissipation of the closed contact, such as { type = \"kelvin_voigt\", coefficient = 200.0 }")
               .optional()});
    } else {
      add({number("normal_force", "N", "the force that presses the support").above(0)});
    }
    if (is_stop())
      add({text("sides", "the sides that have a stop").one_of({"both", "positive", "negative"}).or_else("both")});
    if (shape == nullptr)
      add({text("dof", "the displacement or rotation it acts on").one_of(stop_dof_names()).or_else("u")});
    if (shape != nullptr) {
      add(shape->parameters);
      add({config::texts("dofs", "the two displacements of its plane")
               .of_length(2)
               .or_else(config::Array{Value(std::string("uy")), Value(std::string("uz"))})});
    }
    if (law != nullptr) add(law->parameters);
    return all;
  }

  /// Keys that are no error: read already, or possibly of a law that is not known.
  std::vector<std::string> ignored(const ModelTypes& types) const {
    std::vector<std::string> keys = {"type"};
    if (is_support()) return keys;
    keys.emplace_back("law");
    if (law == nullptr)
      for (const LawType& any : types.laws)
        for (const std::string& key : names_of(any.parameters)) keys.push_back(key);
    return keys;
  }
};

/// The nodes, gaps, dissipation and friction of an entry; its laws and shapes are made for each gap.
struct SceneReader::ContactParts {
  std::vector<DofKind> directions;
  std::vector<NodeId> a, b;
  std::vector<double> gaps;  ///< m, one for each contact or one for all
  ImpactDamping damping;
  Friction friction;
  TurningParts turning;

  /// Gives `group` the nodes of gap i.
  template <class Group>
  void place(std::size_t i, Group& group) const {
    const bool all = gaps.size() == 1;
    group.a = all ? a : std::vector{a[i]};
    if (!b.empty()) group.b = all ? b : std::vector{b[i]};
  }
};

void SceneReader::read_contacts() {
  for (const auto& [entry, path] : entries("contact")) read_contact(*entry, path);
}

void SceneReader::read_contact(const Value& entry, const std::string& path) {
  const ContactKind kind = contact_kind(entry, path);
  if (entry.table() == nullptr) return;
  const std::vector<config::Parameter> parameters = kind.parameters(*entry.table());
  const std::vector<std::string> keys = names_of(parameters);
  std::vector<std::string> others = kind.ignored(types_);
  for (const std::string& key : kind.law != nullptr ? names_of(kind.law->parameters) : std::vector<std::string>())
    if (std::count(keys.begin(), keys.end(), key) > 1 || key == "type" || key == "law") {
      const Value* law = entry.table()->find("law");
      diagnostics_.error(path + ".law", law != nullptr ? law->at : entry.at,
                         kind.law_name + " declares the parameter " + key +
                             ", a key that contacts have themselves; its module must rename it");
      return;
    }
  if (kind.law != nullptr) {
    others.insert(others.end(), keys.begin(), keys.end());
    report_keys_of_others(entry, path, "law = \"" + kind.law_name + "\"", types_.laws, others, diagnostics_);
  }
  const auto p = read_table(entry, path, parameters, others);
  if (!p || kind.name.empty()) return;
  if (p->has("nodes") == p->has("between")) {
    diagnostics_.error(path, entry.at,
                       p->has("nodes") ? "has both nodes and between; give one of them"
                                       : "give nodes (stops to ground) or between (stops between two bodies)");
    return;
  }
  const auto parts = contact_parts(*p, kind, path, entry);
  if (parts && add_contacts(*p, kind, *parts)) read_frame(*p);
}

SceneReader::ContactKind SceneReader::contact_kind(const Value& entry, const std::string& path) {
  std::vector<std::string> names = type_names(types_.contacts);
  names.insert(names.begin(), kStop);
  names.emplace_back(kFriction);
  ContactKind kind;
  kind.name = type_of(entry, path, "type", names).value_or("");
  if (entry.table() == nullptr || kind.is_support()) return kind;
  kind.law_name = type_of(entry, path, "law", type_names(types_.laws), "linear").value_or("");
  if (!kind.law_name.empty()) kind.law = find_type(types_.laws, kind.law_name);
  if (!kind.is_stop()) kind.shape = find_type(types_.contacts, kind.name);
  return kind;
}

std::optional<std::vector<DofKind>> SceneReader::contact_directions(const Parameters& p, const ContactKind& kind) {
  if (kind.shape == nullptr) return std::vector{*dof_named(p.text("dof"))};
  std::vector<DofKind> directions;
  for (const std::string& name : p.texts("dofs")) {
    const auto dof = dof_named(name);
    if (dof && !is_rotation(*dof)) directions.push_back(*dof);
  }
  if (directions.size() == 2 && directions[0] != directions[1]) return directions;
  p.complain(diagnostics_, "dofs", "must name two of the displacements ux, uy and uz");
  return std::nullopt;
}

std::optional<SceneReader::ContactParts> SceneReader::contact_parts(const Parameters& p, const ContactKind& kind,
                                                                    const std::string& path, const Value& entry) {
  ContactTables tables{p, path, kind.law_name, diagnostics_};
  const auto damping = tables.damping(kind.law);
  const auto friction = tables.friction();
  const auto directions = contact_directions(p, kind);
  ContactParts parts;
  if (!directions || !read_ends(p, *directions, parts.a, parts.b)) return std::nullopt;
  const auto gaps = kind.is_support() ? std::optional(std::vector<double>{0.0}) : read_gaps(p, parts.a.size());
  if (!gaps || !damping || !friction) return std::nullopt;
  const bool rubs = friction->rule != Friction::Rule::none;
  if (kind.is_support() && !rubs) {
    diagnostics_.error(path + ".friction", entry.at, "missing; a friction support requires it");
    return std::nullopt;
  }
  if (kind.is_stop() && rubs) {
    p.complain(diagnostics_, "friction",
               "is not possible on a stop, which has no slip direction; use type = \"plane\"");
    return std::nullopt;
  }
  parts.directions = *directions;
  if (rubs) {
    const auto turning = read_turning_parts(p, model_, *dofs_, {parts.directions, parts.a, parts.b}, diagnostics_);
    if (!turning) return std::nullopt;
    parts.turning = *turning;
  }
  warn_of_fixed_ends(p, parts);
  parts.gaps = *gaps;
  parts.damping = *damping;
  parts.friction = *friction;
  return parts;
}

void SceneReader::warn_of_fixed_ends(const Parameters& p, const ContactParts& parts) {
  const auto all_fixed = [&](const std::vector<NodeId>& nodes) {
    return std::all_of(nodes.begin(), nodes.end(), [&](NodeId node) {
      return std::all_of(parts.directions.begin(), parts.directions.end(), [&](DofKind kind) {
        return dofs_->exists({node, kind}) && dofs_->is_fixed({node, kind});
      });
    });
  };
  if (parts.a.empty() || !all_fixed(parts.a) || !all_fixed(parts.b) || root_.table()->find("base") != nullptr) return;
  const char* key = p.has("between") ? "between" : "nodes";
  diagnostics_.warning(p.key(key), p.value(key).at,
                       "names only nodes that a [[support]] holds there, so that this contact can never act");
}

bool SceneReader::add_contacts(const Parameters& p, const ContactKind& kind, const ContactParts& parts) {
  const Sides sides = kind.is_stop() ? sides_of(p.text("sides")) : Sides::both;
  const bool is_damped = parts.damping.kind != ImpactDamping::Kind::none;
  for (std::size_t i = 0; i < parts.gaps.size(); ++i) {
    auto law = kind.law != nullptr ? kind.law->make(p, diagnostics_) : nullptr;
    if (!kind.is_support() && law == nullptr) return false;
    if (law != nullptr && i == 0)
      for (const auto* nodes : {&parts.a, &parts.b})
        check_rate(p, "stiffness", law->closed_stiffness(), *nodes, parts.directions);
    const bool dissipates = law != nullptr && law->rate_dependence() != ContactLaw::RateDependence::none;
    if (dissipates && is_damped) {
      p.complain(diagnostics_, "damping",
                 "conflicts with law = \"" + kind.law_name + "\", which has its own dissipation");
      return false;
    }
    if (kind.is_stop() && !dissipates && !is_damped) {
      StopGroup group;
      group.law = std::move(law);
      group.play = {parts.gaps[i], sides};
      group.dof = parts.directions.front();
      parts.place(i, group);
      model_.stops.push_back(std::move(group));
      continue;
    }
    // Without a gap the normal of a pair of stops would change its sign within contact; each is then a contact of its
    // own.
    const bool is_split = kind.is_stop() && sides == Sides::both && parts.gaps[i] == 0.0;
    for (const Sides side : is_split ? std::vector{Sides::positive, Sides::negative} : std::vector{sides})
      if (!add_obstacle(p, kind, parts, i, side)) return false;
  }
  return true;
}

bool SceneReader::add_obstacle(const Parameters& p, const ContactKind& kind, const ContactParts& parts, std::size_t i,
                               Sides side) {
  ObstacleGroup group;
  group.kind = kind.name;
  if (kind.law != nullptr) group.law = kind.law->make(p, diagnostics_);
  if (kind.is_stop()) group.shape = std::make_unique<StopShape>(FreePlay{parts.gaps[i], side});
  if (kind.shape != nullptr && (group.shape = kind.shape->make(p, parts.gaps[i], diagnostics_)) == nullptr)
    return false;
  if (group.shape != nullptr && !check_stick(p, parts.friction.rule, group.shape->form())) return false;
  if (kind.is_support()) group.normal_force = p.number("normal_force");
  group.directions = parts.directions;
  group.damping = parts.damping;
  if (group.law != nullptr && group.law->rate_dependence() != ContactLaw::RateDependence::none)
    group.damping.kind = ImpactDamping::Kind::law;
  group.friction = parts.friction;
  parts.turning.set_arms(group.shape != nullptr ? group.shape->form() : ContactShape::Form{}, group);
  parts.place(i, group);
  model_.obstacles.push_back(std::move(group));
  return true;
}

bool SceneReader::check_stick(const Parameters& p, Friction::Rule rule, const ContactShape::Form& form) {
  using Kind = ContactShape::Form::Kind;
  const char* why = nullptr;
  if (rule == Friction::Rule::rigid && form.kind != Kind::line)
    why = "stick = \"rigid\" needs a straight obstacle, such as a plane; take stick_stiffness or slip_speed";
  else if (rule == Friction::Rule::spring && form.kind == Kind::circle && form.distance == 0.0)
    why = "a stick spring is stretched along the circumference of the gap, which is 0 here; take slip_speed";
  else if (rule == Friction::Rule::spring && form.kind == Kind::other)
    why =
        "a stick spring needs an obstacle whose ContactShape::form() is a line or a circle, along which it is "
        "stretched; take slip_speed";
  if (why != nullptr) p.complain(diagnostics_, "friction", why);
  return why == nullptr;
}

std::optional<std::vector<double>> SceneReader::read_gaps(const Parameters& p, std::size_t count) {
  if (int(p.has("gap")) + int(p.has("gaps")) + int(p.has("gaps_from")) != 1) {
    diagnostics_.error(p.path() + ".gap", p.at(), "give one of gap, gaps and gaps_from");
    return std::nullopt;
  }
  if (p.has("gap")) return std::vector{p.number("gap")};
  std::vector<double> gaps;
  const char* const key = p.has("gaps") ? "gaps" : "gaps_from";
  if (p.has("gaps")) {
    gaps = p.numbers("gaps");
  } else {
    const auto file =
        read_parameters(p.value("gaps_from"), p.key("gaps_from"), config::number_file_parameters(), diagnostics_);
    const auto table = file ? read_number_file(*file, diagnostics_) : std::nullopt;
    if (!table) return std::nullopt;
    gaps = table->values;
  }
  if (gaps.size() != count) {
    p.complain(diagnostics_, key,
               "holds " + std::to_string(gaps.size()) + " gaps for " + std::to_string(count) + " contacts");
    return std::nullopt;
  }
  const auto wrong = std::find_if(gaps.begin(), gaps.end(), [](double gap) { return !(gap >= 0.0); });
  if (wrong != gaps.end()) {
    p.complain(diagnostics_, key,
               "must hold numbers >= 0; entry " + std::to_string(wrong - gaps.begin()) + " (counted from 0) is " +
                   to_short_text(*wrong));
    return std::nullopt;
  }
  return gaps;
}

bool SceneReader::read_ends(const Parameters& p, const std::vector<DofKind>& directions, std::vector<NodeId>& a,
                            std::vector<NodeId>& b) {
  if (p.has("between")) return read_pairs(p, directions, a, b);
  const auto nodes = select(p, "nodes");
  if (!nodes) return false;
  a = *nodes;
  return std::all_of(a.begin(), a.end(), [&](NodeId node) { return check_directions(p, "nodes", node, directions); });
}

bool SceneReader::check_directions(const Parameters& p, const char* key, NodeId node,
                                   const std::vector<DofKind>& directions) {
  for (const DofKind kind : directions)
    if (!dofs_->exists({node, kind}) && !lacks_elements_) {
      const bool lacks_plane = directions.size() == 2;
      p.complain(diagnostics_, key,
                 dofs_->name({node, kind}) + " does not exist: no element there uses it" +
                     (lacks_plane ? "; contact in a plane needs both displacements (beams with motion = \"lateral\" or "
                                    "\"spatial\", or springs along both)"
                                  : ""));
      return false;
    }
  return true;
}

bool SceneReader::read_pairs(const Parameters& parameters, const std::vector<DofKind>& directions,
                             std::vector<NodeId>& first, std::vector<NodeId>& second) {
  const auto complain = [&](const std::string& complaint) {
    parameters.complain(diagnostics_, "between", complaint);
    return false;
  };
  const auto selectors = parameters.texts("between");
  if (selectors.size() != 2) return complain("must hold two selectors, such as [\"rotor:3..9\", \"casing:3..9\"]");
  const Selection a = model_.nodes.select(selectors[0]), b = model_.nodes.select(selectors[1]);
  for (const auto& [selection, selector] : {std::pair(&a, &selectors[0]), std::pair(&b, &selectors[1])})
    if (!selection->problem.empty()) complain("\"" + *selector + "\": " + selection->problem);
  if (a.nodes.empty() || b.nodes.empty()) return false;
  if (a.nodes.size() != b.nodes.size())
    return complain("pairs nodes one by one, but the first selector names " + std::to_string(a.nodes.size()) +
                    " and the second " + std::to_string(b.nodes.size()));
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    if (model_.nodes.canonical(a.nodes[i]) == model_.nodes.canonical(b.nodes[i]))
      return complain(model_.nodes.name(a.nodes[i]) + " and " + model_.nodes.name(b.nodes[i]) +
                      " are the same node, which has no relative motion");
    for (const NodeId node : {a.nodes[i], b.nodes[i]})
      if (!check_directions(parameters, "between", node, directions)) return false;
  }
  first = a.nodes;
  second = b.nodes;
  return true;
}

}  // namespace butee::scene
