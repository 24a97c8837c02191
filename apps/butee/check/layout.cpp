#include "layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <butee/core/text.hpp>

namespace butee::app::check {
namespace {

using model::NodeGroup;
using model::NodeId;

struct Tie {
  NodeId a, b;
  bool joined;  ///< both names denote the same node
};

/// Places bodies so that tied nodes have the same x.
class Placer {
 public:
  Placer(const model::Model& model, const Survey& survey) : nodes_(model.nodes) {
    for (const std::string& name : nodes_.group_names()) groups_.push_back(nodes_.find(name));
    for (std::size_t i = 0; i < groups_.size(); ++i) index_[groups_[i]->first] = i;
    find_ties(model, survey);
    placed_.resize(groups_.size());
    for (std::size_t i = 0; i < groups_.size(); ++i)
      if (!placed_[i]) place_all_tied_to(i);
  }

  Place of(NodeId node) const {
    const std::size_t i = group_index(node);
    return {placed_[i]->x + coordinate(node), placed_[i]->row};
  }
  int rows() const { return rows_; }

  std::vector<Body> bodies() const {
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const NodeGroup& group = *groups_[i];
      Body body;
      body.name = group.name;
      body.lone = group.lone();
      body.row = placed_[i]->row;
      for (NodeId k = 0; k < group.size(); ++k) body.nodes.push_back(of(group.first + k).x);
      body.begin = body.nodes.front();
      body.end = body.nodes.back();
      bodies.push_back(std::move(body));
    }
    return bodies;
  }

 private:
  std::size_t group_index(NodeId node) const { return index_.at(nodes_.group_of(node).first); }
  double coordinate(NodeId node) const {
    const NodeGroup& group = nodes_.group_of(node);
    return group.lone() ? 0.0 : group.coordinates[static_cast<std::size_t>(node - group.first)];
  }

  void find_ties(const model::Model& model, const Survey& survey) {
    for (NodeId node = 0; node < nodes_.size(); ++node)
      if (const NodeId root = nodes_.canonical(node); root != node) ties_.push_back({root, node, true});
    for (const SpringPlace& spring : survey.springs)
      if (spring.b >= 0) ties_.push_back({spring.a, spring.b, false});
    const auto tie_ends = [&](const auto& groups) {
      for (const auto& group : groups)
        for (std::size_t i = 0; i < group.b.size(); ++i) ties_.push_back({group.a[i], group.b[i], false});
    };
    tie_ends(model.stops);
    tie_ends(model.obstacles);
  }

  bool is_taken(int row, double begin, double end) const {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (!placed_[i] || placed_[i]->row != row) continue;
      const double first = placed_[i]->x + coordinate(groups_[i]->first);
      const double last = placed_[i]->x + coordinate(groups_[i]->first + groups_[i]->size() - 1);
      const double slack = 1e-9 * (std::abs(first) + std::abs(last));
      if (std::max(begin, first) < std::min(end, last) - slack || (begin == first && end == last)) return true;
    }
    return false;
  }

  void put(std::size_t i, double x, int row) {
    const double begin = x + coordinate(groups_[i]->first);
    const double end = x + coordinate(groups_[i]->first + groups_[i]->size() - 1);
    while (is_taken(row, begin, end)) ++row;
    placed_[i] = Place{x, row};
    rows_ = std::max(rows_, row + 1);
  }

  void place_all_tied_to(std::size_t first) {
    put(first, 0.0, rows_);
    bool changed = true;
    while (changed) {
      changed = false;
      for (const Tie& tie : ties_)
        for (const auto& [from, to] : {std::pair(tie.a, tie.b), std::pair(tie.b, tie.a)}) {
          const std::size_t known = group_index(from), next = group_index(to);
          if (!placed_[known] || placed_[next]) continue;
          put(next, of(from).x - coordinate(to), placed_[known]->row + (tie.joined ? 0 : 1));
          changed = true;
        }
    }
  }

  const model::NodeTable& nodes_;
  std::vector<const NodeGroup*> groups_;
  std::map<NodeId, std::size_t> index_;
  std::vector<Tie> ties_;
  std::vector<std::optional<Place>> placed_;
  int rows_ = 0;
};

void add_supports(const model::Model& model, const Placer& placer, Layout& layout) {
  std::map<NodeId, SupportMark> marks;
  for (const model::NodalDof& dof : model.fixed) {
    if (dof.kind == DofKind::rx) continue;  // Twist is not drawn.
    SupportMark& mark = marks[model.nodes.canonical(dof.node)];
    mark.at = placer.of(dof.node);
    (is_rotation(dof.kind) ? mark.theta : mark.u) = true;
  }
  for (const auto& [node, mark] : marks) layout.supports.push_back(mark);
}

/// Names the direction of a stop that closes in one only.
const char* sides_of(const model::FreePlay& play) {
  if (play.has_positive() && play.has_negative()) return "";
  return play.has_positive() ? ", sides positive" : ", sides negative";
}

/// `laws` are those of [[contact]], of use here if each is one group of stops.
void add_stops(const model::Model& model, const Placer& placer, const std::vector<std::string>& laws, Layout& layout) {
  const bool names_laws = laws.size() == model.stops.size() && model.obstacles.empty();
  for (std::size_t g = 0; g < model.stops.size(); ++g) {
    const model::StopGroup& group = model.stops[g];
    const bool turns = is_rotation(group.dof);
    layout.stop_labels.push_back("gap " + to_short_text(group.play.gap) + (turns ? " rad, " : " m, ") +
                                 to_short_text(group.law->closed_stiffness()) + (turns ? " N m/rad" : " N/m") +
                                 (names_laws ? ", " + laws[g] : "") + sides_of(group.play));
    for (std::size_t i = 0; i < group.a.size(); ++i) {
      StopMark mark;
      mark.at = placer.of(group.a[i]);
      if (!group.b.empty()) mark.other = placer.of(group.b[i]);
      mark.positive = group.play.has_positive();
      mark.negative = group.play.has_negative();
      mark.gap = group.play.gap;
      mark.group = static_cast<int>(g);
      layout.stops.push_back(mark);
    }
  }
}

/// Stops with dissipation, rings and planes; of their directions the first is drawn.
void add_obstacles(const model::Model& model, const Placer& placer, Layout& layout) {
  for (const model::ObstacleGroup& group : model.obstacles) {
    if (group.shape == nullptr || group.law == nullptr) continue;
    const bool turns = is_rotation(group.directions.front());
    const double gap = 0.0 - group.shape->at({0.0, 0.0}).penetration, beyond = 2.0 * std::abs(gap) + 1.0;
    StopMark mark;
    mark.gap = gap;
    mark.positive = group.shape->at({beyond, 0.0}).penetration > 0.0;
    mark.negative = group.shape->at({-beyond, 0.0}).penetration > 0.0;
    mark.group = static_cast<int>(layout.stop_labels.size());
    layout.stop_labels.push_back((group.kind == "stop" ? "" : group.kind + ", ") + "gap " + to_short_text(gap) +
                                 (turns ? " rad, " : " m, ") + to_short_text(group.law->closed_stiffness()) +
                                 (turns ? " N m/rad" : " N/m") +
                                 (group.damping.kind == model::ImpactDamping::Kind::none ? "" : ", with dissipation") +
                                 (group.friction.rule == model::Friction::Rule::none
                                      ? ""
                                      : ", friction " + to_short_text(group.friction.coefficient)));
    for (std::size_t i = 0; i < group.a.size(); ++i) {
      mark.at = placer.of(group.a[i]);
      if (!group.b.empty()) mark.other = placer.of(group.b[i]);
      layout.stops.push_back(mark);
    }
  }
}

bool is_constant(const model::TimeFunction& function) {
  return !function.harmonic() && function.discontinuities().empty() && function.value(0.0) == function.value(1.0) &&
         function.value(0.0) == function.value(17.3);
}

void add_loads(const model::Model& model, const Placer& placer, Layout& layout) {
  for (const model::Load& load : model.loads) {
    if (!load.acceleration.isZero(0.0)) continue;  // Weight and a moving base are not drawn.
    LoadMark mark;
    for (const model::NodalValue& value : load.pattern)
      if (load.pattern.size() == 1 || value.dof.kind == DofKind::u) mark.at.push_back(placer.of(value.dof.node));
    if (mark.at.empty()) continue;
    const bool single = load.pattern.size() == 1;
    mark.moment = single && is_rotation(load.pattern.front().dof.kind);
    const bool is_line = load.line != nullptr && load.per_length != 0.0;
    mark.label = describe(*load.in_time, is_line ? load.per_length : load.pattern.front().value,
                          is_line       ? "N/m"
                          : mark.moment ? "N m"
                                        : "N");
    if (single && !mark.moment && load.pattern.front().dof.kind != DofKind::uy)
      mark.label += std::string(" along ") + name_of(load.pattern.front().dof.kind);
    if (is_constant(*load.in_time)) {
      const double value = (is_line ? load.per_length : load.pattern.front().value) * load.in_time->value(0.0);
      mark.sign = (value > 0.0 ? 1 : 0) - (value < 0.0 ? 1 : 0);
    }
    mark.aside = std::any_of(layout.stops.begin(), layout.stops.end(), [&](const StopMark& stop) {
      return stop.at.row == mark.at.front().row && stop.at.x == mark.at.front().x;
    });
    layout.loads.push_back(std::move(mark));
  }
}

}  // namespace

std::string describe(const model::TimeFunction& function, double weight, const char* unit) {
  if (const auto harmonic = function.harmonic())
    return to_short_text(weight * harmonic->amplitude) + " " + unit + " at " +
           to_short_text(harmonic->angular_frequency / (2.0 * std::numbers::pi)) + " Hz";
  double largest = std::abs(function.value(0.0));
  const std::vector<double> instants = function.discontinuities();
  for (const double t : instants) largest = std::max(largest, std::abs(function.value(t)));
  // Between them a load may oscillate, as an unbalance that runs up.
  constexpr int kSamples = 20000;
  if (!instants.empty())
    for (int i = 0; i <= kSamples; ++i)
      largest = std::max(largest, std::abs(function.value(instants.back() * (1.05 * i / kSamples))));
  if (is_constant(function)) return to_short_text(weight * function.value(0.0)) + " " + unit;
  return (instants.empty() ? "a force in " : "up to " + to_short_text(std::abs(weight) * largest) + " ") + unit +
         ", changing in time";
}

Layout layout_of(const model::Model& model, const Survey& survey, const std::vector<std::string>& laws) {
  const Placer placer(model, survey);
  Layout layout;
  layout.title = model.title;
  layout.bodies = placer.bodies();
  layout.rows = placer.rows();
  layout.left = layout.right = layout.bodies.empty() ? 0.0 : layout.bodies.front().begin;
  for (const Body& body : layout.bodies) {
    layout.left = std::min(layout.left, body.begin);
    layout.right = std::max(layout.right, body.end);
  }
  add_supports(model, placer, layout);
  add_stops(model, placer, laws, layout);
  add_obstacles(model, placer, layout);
  add_loads(model, placer, layout);
  for (const SpringPlace& spring : survey.springs)
    layout.springs.push_back({placer.of(spring.a), spring.b >= 0 ? std::optional(placer.of(spring.b)) : std::nullopt,
                              spring.stiffness, spring.along == DofKind::uz});
  for (const MassPlace& mass : survey.masses) layout.masses.push_back({placer.of(mass.node), mass.mass});
  return layout;
}

}  // namespace butee::app::check
