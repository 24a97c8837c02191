#include "butee/model/saved_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "butee/core/bytes.hpp"
#include "butee/core/error.hpp"

namespace butee::model {
namespace {

constexpr std::uint64_t kStatesMark = 0x0A747473'65747562U;  // "butestt\n"
constexpr std::uint32_t kStatesFormat = 2;
constexpr double kSamePlace = 1e-9;  ///< of a beam's length

bool is_same_place(const std::vector<double>& a, const std::vector<double>& b) {
  const double allowed = a.empty() ? 0.0 : kSamePlace * (a.back() - a.front());
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](double one, double other) { return std::abs(one - other) <= allowed; });
}

/// The kinds in the order of their codes in a file.
constexpr std::array<DofKind, kDofKinds> kCodes = {DofKind::uy, DofKind::rz, DofKind::ux,
                                                   DofKind::uz, DofKind::rx, DofKind::ry};

std::uint8_t code_of(DofKind kind) {
  return static_cast<std::uint8_t>(std::find(kCodes.begin(), kCodes.end(), kind) - kCodes.begin());
}

DofKind kind_of_code(std::uint8_t code) {
  if (code >= kCodes.size()) throw RunError("is damaged: it names a degree of freedom that no node has");
  return kCodes.at(code);
}

bool is_same_dof(NodalDof a, NodalDof b) {
  return a.node == b.node && a.kind == b.kind;
}

}  // namespace

SavedMotions::SavedMotions(const NodeTable& nodes, const DofTable& table) : free(table.free()) {
  for (const std::string& name : nodes.group_names()) groups.push_back({name, nodes.find(name)->coordinates});
}

std::string SavedMotions::difference_from(const NodeTable& nodes, const DofTable& table) const {
  const SavedMotions other(nodes, table);
  const auto count = [](std::size_t number, const char* what) { return std::to_string(number) + " " + what; };
  for (std::size_t i = 0; i < std::max(groups.size(), other.groups.size()); ++i) {
    if (i >= groups.size()) return "it has no \"" + other.groups[i].name + "\"";
    if (i >= other.groups.size()) return "it also has \"" + groups[i].name + "\"";
    const Group &a = groups[i], &b = other.groups[i];
    if (a.name != b.name) return "it has \"" + a.name + "\" where this scene has \"" + b.name + "\"";
    if (a.coordinates.size() != b.coordinates.size())
      return "\"" + a.name + "\" has " + count(std::max<std::size_t>(a.coordinates.size(), 1), "nodes there and ") +
             count(std::max<std::size_t>(b.coordinates.size(), 1), "here");
    if (!is_same_place(a.coordinates, b.coordinates)) return "the nodes of \"" + a.name + "\" have other coordinates";
  }
  const auto [here, there] = std::mismatch(other.free.begin(), other.free.end(), free.begin(), free.end(), is_same_dof);
  if (here == other.free.end() && there == free.end()) return "";
  const bool is_here = there == free.end() || (here != other.free.end() &&
                                               std::pair(here->node, here->kind) < std::pair(there->node, there->kind));
  return is_here ? table.name(*here) + " is free here, not there" : table.name(*there) + " is free there, not here";
}

std::vector<std::byte> to_bytes(const SavedMotions& saved) {
  std::vector<std::byte> content, bytes;
  ByteWriter inner(content);
  inner.put(static_cast<std::uint64_t>(saved.groups.size()));
  for (const auto& group : saved.groups) {
    inner.put(group.name);
    inner.put(group.coordinates);
  }
  inner.put(static_cast<std::uint64_t>(saved.free.size()));
  for (const NodalDof dof : saved.free) {
    inner.put(dof.node);
    inner.put(code_of(dof.kind));
  }
  inner.put(saved.in_space);
  inner.put(saved.has_base);
  inner.put(static_cast<std::uint64_t>(saved.contacts.size()));
  for (const std::string& name : saved.contacts) inner.put(name);
  inner.put(static_cast<std::uint64_t>(saved.motions.size()));
  for (const SavedMotion& motion : saved.motions) {
    inner.put(motion.t);
    inner.put(motion.x);
    inner.put(motion.v);
    inner.put(motion.contact);
  }
  ByteWriter outer(bytes);
  outer.put(kStatesMark);
  outer.put(kStatesFormat);
  outer.put(checksum(content));
  outer.put(std::span<const std::byte>(content));
  return bytes;
}

SavedMotions to_saved_motions(std::span<const std::byte> bytes) {
  ByteReader outer(bytes);
  if (outer.take<std::uint64_t>() != kStatesMark) throw RunError("is not a file of motions of butee");
  if (const auto format = outer.take<std::uint32_t>(); format != kStatesFormat)
    throw RunError("is of format " + std::to_string(format) + "; this butee reads " + std::to_string(kStatesFormat));
  const auto sum = outer.take<std::uint64_t>();
  std::vector<std::byte> content;
  outer.take(content);
  if (!outer.at_end() || checksum(content) != sum) throw RunError("is damaged: its checksum is wrong");
  ByteReader inner(content);
  SavedMotions saved;
  saved.groups.resize(inner.count(2 * sizeof(std::uint64_t)));
  for (auto& group : saved.groups) {
    inner.take(group.name);
    inner.take(group.coordinates);
  }
  saved.free.resize(inner.count(sizeof(NodeId) + 1));
  for (NodalDof& dof : saved.free) {
    inner.take(dof.node);
    dof.kind = kind_of_code(inner.take<std::uint8_t>());
  }
  inner.take(saved.in_space);
  inner.take(saved.has_base);
  saved.contacts.resize(inner.count(sizeof(std::uint64_t)));
  for (std::string& name : saved.contacts) inner.take(name);
  saved.motions.resize(inner.count(sizeof(double)));
  for (SavedMotion& motion : saved.motions) {
    inner.take(motion.t);
    inner.take(motion.x);
    inner.take(motion.v);
    inner.take(motion.contact);
    if (motion.x.size() != std::ssize(saved.free) || motion.v.size() != std::ssize(saved.free))
      throw RunError("is damaged: a motion and its structure have different numbers of DOFs");
  }
  return saved;
}

}  // namespace butee::model
