#include "butee/record/field_layout.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace butee::record {
namespace {

using model::NodeGroup;
using model::NodeId;

constexpr double kLaneSpacing = 0.05;     ///< of the longest beam
constexpr double kLoneNodeSpacing = 1.0;  ///< m, if there are no beams
constexpr double kTouching = 1e-9;        ///< of a beam's length: beams that overlap by less are placed end to end
constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

/// Places every node of a model: x in m, and the index of its line.
class Placement {
 public:
  Placement(const model::Model& model, const model::System& system)
      : nodes_(model.nodes), system_(system), places_(static_cast<std::size_t>(nodes_.size()), Place{kNowhere, 0}) {
    for (const std::string& name : nodes_.group_names())
      if (const NodeGroup& group = *nodes_.find(name); !group.lone()) place_beam(group);
    const bool beams = !lanes_.empty();
    find_points();
    for (const std::string& name : nodes_.group_names())
      if (const NodeGroup& group = *nodes_.find(name); group.lone()) place_lone(group.first, beams);
  }

  std::array<double, 3> position(NodeId node, const NodeGroup& group) const {
    if (is_in_space_) return in_space(node);
    const Place& own = group.lone() ? place_of(node) : starts_.at(group.first);
    const double x = group.lone() ? own.x : own.x + group.coordinates[static_cast<std::size_t>(node - group.first)];
    return {x, 0.0, static_cast<double>(own.lane) * (longest_ > 0.0 ? kLaneSpacing * longest_ : kLoneNodeSpacing)};
  }

 private:
  struct Place {
    double x;
    int lane;
    bool known() const { return x == x; }
  };
  struct Span {
    double begin, end;
  };

  /// Beams between points are placed at these; a lone node at a beam's node, or at the origin.
  std::array<double, 3> in_space(NodeId node) const {
    const auto found = points_.find(nodes_.canonical(node));
    return found != points_.end() ? found->second : std::array<double, 3>{};
  }
  void find_points() {
    for (const std::string& name : nodes_.group_names()) {
      const NodeGroup& group = *nodes_.find(name);
      const bool is_along_x = group.direction == std::array{1.0, 0.0, 0.0} && group.origin == std::array{0.0, 0.0, 0.0};
      is_in_space_ = is_in_space_ || !is_along_x;
      for (NodeId i = 0; i < group.size() && !group.lone(); ++i) {
        std::array<double, 3> at = group.origin;
        for (std::size_t k = 0; k < 3; ++k)
          at[k] += group.coordinates[static_cast<std::size_t>(i)] * group.direction[k];
        points_.emplace(nodes_.canonical(group.first + i), at);
      }
    }
  }

  Place& place_of(NodeId node) { return places_[static_cast<std::size_t>(nodes_.canonical(node))]; }
  const Place& place_of(NodeId node) const { return places_[static_cast<std::size_t>(nodes_.canonical(node))]; }

  void place_beam(const NodeGroup& group) {
    const auto& x = group.coordinates;
    const double length = x.back() - x.front();
    longest_ = std::max(longest_, length);
    Place start{0.0, static_cast<int>(lanes_.size())};
    for (NodeId i = 0; i < group.size(); ++i) {
      const Place& joined = place_of(group.first + i);
      if (!joined.known()) continue;
      start.x = joined.x - x[static_cast<std::size_t>(i)];
      if (is_free(joined.lane, start.x + x.front(), start.x + x.back(), kTouching * length)) start.lane = joined.lane;
      break;
    }
    if (start.lane == static_cast<int>(lanes_.size())) lanes_.emplace_back();
    lanes_[static_cast<std::size_t>(start.lane)].push_back({start.x + x.front(), start.x + x.back()});
    starts_[group.first] = start;
    for (NodeId i = 0; i < group.size(); ++i)
      if (Place& place = place_of(group.first + i); !place.known())
        place = {start.x + x[static_cast<std::size_t>(i)], start.lane};
  }

  bool is_free(int lane, double begin, double end, double tolerance) const {
    const auto& spans = lanes_[static_cast<std::size_t>(lane)];
    return std::all_of(spans.begin(), spans.end(),
                       [&](const Span& s) { return end <= s.begin + tolerance || begin >= s.end - tolerance; });
  }

  void place_lone(NodeId node, bool beams) {
    Place& place = place_of(node);
    if (place.known()) return;
    place = {0.0, static_cast<int>(lanes_.size())};
    if (!beams) {
      place.x = kLoneNodeSpacing * static_cast<double>(lone_++);
      return;
    }
    if (const Index dof = system_.dofs.index({node, DofKind::u}); dof >= 0)
      for (SparseMatrix::InnerIterator entry(system_.stiffness, dof); entry; ++entry) {
        const Place& tied = place_of(system_.dofs.free()[static_cast<std::size_t>(entry.row())].node);
        if (entry.row() == dof || !tied.known()) continue;
        place.x = tied.x;
        break;
      }
    while (!taken_.insert({place.x, place.lane}).second) ++place.lane;
  }

  const model::NodeTable& nodes_;
  const model::System& system_;
  std::vector<Place> places_;       ///< by canonical node
  std::map<NodeId, Place> starts_;  ///< of beams, by their first node: the x of coordinate 0
  std::vector<std::vector<Span>> lanes_;
  std::set<std::pair<double, int>> taken_;
  std::map<NodeId, std::array<double, 3>> points_;  ///< in space, by canonical node
  bool is_in_space_ = false;                        ///< some beam has points
  double longest_ = 0.0;
  int lone_ = 0;
};

}  // namespace

model::FieldLayout make_layout(const model::Model& model, const model::System& system,
                               const model::FieldRequest& request) {
  const Placement placement(model, system);
  model::FieldLayout layout;
  layout.title = model.title;
  const NodeGroup* last = nullptr;
  for (const NodeId node : request.nodes) {
    const NodeGroup& group = model.nodes.group_of(node);
    if (!group.lone()) {
      if (&group != last) layout.lines.push_back({group.name, {}});
      layout.lines.back().nodes.push_back(static_cast<Index>(layout.nodes.size()));
    }
    last = &group;
    layout.nodes.push_back(model.nodes.name(node));
    layout.coordinates.push_back(group.lone() ? 0.0 : group.coordinates[static_cast<std::size_t>(node - group.first)]);
    layout.positions.push_back(placement.position(node, group));
  }
  std::erase_if(layout.lines, [](const model::FieldLine& line) { return line.nodes.size() < 2; });
  for (const model::Quantity quantity : request.quantities)
    layout.fields.push_back({name_of(quantity), unit_of(quantity), quantity == model::Quantity::stop_state});
  return layout;
}

}  // namespace butee::record
