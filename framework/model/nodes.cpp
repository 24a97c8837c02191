#include "butee/model/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::model {
namespace {

/// A coordinate selects a node within this fraction of the beam's length.
constexpr double kCoordinateTolerance = 1e-9;

Selection range(const NodeGroup& group, NodeId begin, NodeId end) {
  Selection selection;
  selection.nodes.resize(static_cast<std::size_t>(end - begin));
  std::iota(selection.nodes.begin(), selection.nodes.end(), group.first + begin);
  return selection;
}

Selection refuse(std::string problem) {
  return {{}, std::move(problem), false};
}

std::string forms(const NodeGroup& group) {
  const std::string last = std::to_string(group.size() - 1);
  return group.name + ":first, " + group.name + ":last, " + group.name + ":middle, " + group.name + ":0 ... " +
         group.name + ":" + last + ", " + group.name + ":0.." + last + ", " + group.name + ":all or " + group.name +
         "@COORDINATE";
}

Selection select_at(const NodeGroup& group, std::string_view text) {
  const auto wanted = whole_number<double>(text);
  if (!wanted || !std::isfinite(*wanted))
    return refuse(group.name + "@" + std::string(text) + " is not a coordinate in m");
  const auto& x = group.coordinates;
  const double tolerance = kCoordinateTolerance * (x.back() - x.front());
  const auto above = std::lower_bound(x.begin(), x.end(), *wanted);
  const auto near = [&](auto at) { return std::abs(*at - *wanted) <= tolerance; };
  if (above != x.end() && near(above)) return range(group, NodeId(above - x.begin()), NodeId(above - x.begin()) + 1);
  if (above != x.begin() && near(above - 1))
    return range(group, NodeId(above - x.begin()) - 1, NodeId(above - x.begin()));
  const auto right = std::clamp<std::ptrdiff_t>(above - x.begin(), 1, std::ssize(x) - 1);
  const auto named = [&](std::ptrdiff_t i) {
    return group.name + ":" + std::to_string(i) + " at " + to_short_text(x[static_cast<std::size_t>(i)]) + " m";
  };
  return refuse("no node there; the nearest are " + named(right - 1) + " and " + named(right));
}

Selection select_by_index(const NodeGroup& group, std::string_view text) {
  const NodeId size = group.size();
  if (text == "all") return range(group, 0, size);
  if (text == "first") return range(group, 0, 1);
  if (text == "last") return range(group, size - 1, size);
  if (text == "middle") {
    if (size % 2 == 0)
      return refuse(group.name + " has an even number of nodes (" + std::to_string(size) +
                    ") and so none in the middle; the two nearest are " + group.name + ":" +
                    std::to_string(size / 2 - 1) + " and " + group.name + ":" + std::to_string(size / 2));
    return range(group, size / 2, size / 2 + 1);
  }
  const auto dots = text.find("..");
  const auto begin = whole_number<NodeId>(text.substr(0, dots));
  const auto end = dots == std::string_view::npos ? begin : whole_number<NodeId>(text.substr(dots + 2));
  if (!begin || !end)
    return refuse('"' + std::string(text) + "\" is not a part of a beam" +
                  suggestion(text, {"all", "first", "last", "middle"}) + "; write " + forms(group));
  if (std::min(*begin, *end) < 0 || std::max(*begin, *end) >= size)
    return refuse(group.name + " has the nodes 0 ... " + std::to_string(size - 1));
  if (*begin > *end)
    return refuse("the range runs backwards; write " + group.name + ":" + std::to_string(*end) + ".." +
                  std::to_string(*begin) + " (" + group.name + " has the nodes 0 ... " + std::to_string(size - 1) +
                  ")");
  return range(group, *begin, *end + 1);
}

}  // namespace

NodeId NodeTable::add(const std::string& name, std::vector<double> coordinates) {
  require(find(name) == nullptr, "two node groups of one name");
  const NodeId first = size();
  groups_.push_back({name, first, std::move(coordinates)});
  root_.resize(root_.size() + static_cast<std::size_t>(groups_.back().size()));
  std::iota(root_.begin() + first, root_.end(), first);
  return first;
}

NodeId NodeTable::canonical(NodeId node) const {
  if (node < 0 || node >= size()) throw InputError("there is no node of number " + std::to_string(node));
  while (root_[static_cast<std::size_t>(node)] != node) node = root_[static_cast<std::size_t>(node)];
  return node;
}

void NodeTable::place(NodeId node, const std::array<double, 3>& origin, const std::array<double, 3>& direction) {
  const NodeGroup& group = group_of(node);
  groups_[static_cast<std::size_t>(&group - groups_.data())].origin = origin;
  groups_[static_cast<std::size_t>(&group - groups_.data())].direction = direction;
}

void NodeTable::join(NodeId a, NodeId b) {
  a = canonical(a);
  b = canonical(b);
  root_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

Selection NodeTable::select(std::string_view selector) const {
  const auto mark = selector.find_first_of(":@");
  const std::string name(selector.substr(0, mark));
  const NodeGroup* group = find(name);
  if (group == nullptr) {
    if (excused_.contains(name) || excused_.contains("")) return {{}, "", true};
    const auto known = group_names();
    return refuse("there is no node or beam \"" + name + "\"" + suggestion(name, known) +
                  (known.empty() ? "" : "; known: " + butee::join(known)));
  }
  if (mark == std::string_view::npos) {
    if (group->lone()) return range(*group, 0, 1);
    return refuse(name + " is a beam of " + std::to_string(group->size()) + " nodes; write " + forms(*group));
  }
  if (group->lone()) return refuse(name + " is a single node; write \"" + name + "\" alone");
  const std::string_view part = selector.substr(mark + 1);
  return selector[mark] == '@' ? select_at(*group, part) : select_by_index(*group, part);
}

const NodeGroup* NodeTable::find(std::string_view name) const {
  const auto found = std::find_if(groups_.begin(), groups_.end(), [&](const NodeGroup& g) { return g.name == name; });
  return found == groups_.end() ? nullptr : &*found;
}

const NodeGroup& NodeTable::group_of(NodeId node) const {
  require(node >= 0 && node < size(), "no such node");
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), node,
                                      [](NodeId id, const NodeGroup& group) { return id < group.first; });
  return *(after - 1);
}

std::string NodeTable::name(NodeId node) const {
  const NodeGroup& group = group_of(node);
  return group.lone() ? group.name : group.name + ":" + std::to_string(node - group.first);
}

std::vector<std::string> NodeTable::group_names() const {
  std::vector<std::string> names;
  for (const NodeGroup& group : groups_) names.push_back(group.name);
  return names;
}

}  // namespace butee::model
