#include "butee/model/part.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::model {
namespace {

constexpr Index kHeld = -1;

SparseMatrix restricted(const SparseMatrix& whole, std::span<const Index> dofs, const std::vector<Index>& places) {
  if (whole.size() == 0) return {};
  const auto n = static_cast<Index>(dofs.size());
  SparseMatrix part(n, n);
  part.reserve(Eigen::VectorXi::Constant(n, static_cast<int>(whole.nonZeros() / whole.cols()) + 2));
  for (Index j = 0; j < n; ++j)
    for (SparseMatrix::InnerIterator entry(whole, dofs[static_cast<std::size_t>(j)]); entry; ++entry)
      if (const Index i = places[static_cast<std::size_t>(entry.row())]; i != kHeld) part.insert(i, j) = entry.value();
  part.makeCompressed();
  return part;
}

FreeStops restricted(const FreeStops& whole, const std::vector<Index>& places) {
  FreeStops part;
  part.law = whole.law;
  part.play = whole.play;
  const auto place = [&](Index dof) { return dof < 0 ? FreeStops::kGround : places[static_cast<std::size_t>(dof)]; };
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Index a = place(whole.a[i]), b = place(whole.b[i]);
    if (a < 0 && b < 0) continue;
    part.a.push_back(a);
    part.b.push_back(b);
  }
  return part;
}

FreeLoad restricted(const FreeLoad& whole, const std::vector<Index>& places) {
  FreeLoad part;
  part.in_time = whole.in_time;
  for (std::size_t i = 0; i < whole.dofs.size(); ++i) {
    const Index place = places[static_cast<std::size_t>(whole.dofs[i])];
    if (place == kHeld) continue;
    part.dofs.push_back(place);
    part.weights.push_back(whole.weights[i]);
  }
  return part;
}

DofTable table_of(const System& whole, const std::vector<Index>& places) {
  DofTable table = whole.dofs;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i] == kHeld) table.fix(whole.dofs.free()[i]);
  table.number();
  return table;
}

}  // namespace

System part_of(const System& whole, std::span<const Index> dofs) {
  require(!dofs.empty() && std::is_sorted(dofs.begin(), dofs.end()) && dofs.back() < whole.size(),
          "a part has DOFs of the whole, ascending");
  require(!whole.damping.is_modal(), "modal damping is that of a whole");
  static_assert(FreeStops::kGround == kHeld);
  std::vector<Index> places(static_cast<std::size_t>(whole.size()), kHeld);
  for (std::size_t i = 0; i < dofs.size(); ++i) places[static_cast<std::size_t>(dofs[i])] = static_cast<Index>(i);

  System part(table_of(whole, places));
  part.mass = restricted(whole.mass, dofs, places);
  part.stiffness = restricted(whole.stiffness, dofs, places);
  part.dashpots = restricted(whole.dashpots, dofs, places);
  part.is_symmetric = whole.is_symmetric;
  part.stiffness_is_symmetric = whole.stiffness_is_symmetric;
  part.gyroscopic = restricted(whole.gyroscopic, dofs, places);
  part.circulatory = restricted(whole.circulatory, dofs, places);
  part.rotation = whole.rotation;
  part.damping = whole.damping;
  for (const FreeStops& stops : whole.stops) {
    FreeStops kept = restricted(stops, places);
    if (kept.size() > 0) part.stops.push_back(std::move(kept));
  }
  for (const FreeLoad& load : whole.loads) {
    FreeLoad kept = restricted(load, places);
    if (!kept.dofs.empty()) part.loads.push_back(std::move(kept));
  }
  part.initial_displacement = whole.initial_displacement(dofs);
  part.initial_velocity = whole.initial_velocity(dofs);
  part.initial_time = whole.initial_time;
  return part;
}

std::vector<Index> distances(const System& system, std::span<const Index> from) {
  std::vector<Index> distance(static_cast<std::size_t>(system.size()), -1);
  std::vector<Index> reached(from.begin(), from.end());
  for (const Index dof : reached) distance[static_cast<std::size_t>(dof)] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Index next = distance[static_cast<std::size_t>(reached[i])] + 1;
    for (SparseMatrix::InnerIterator entry(system.mass, reached[i]); entry; ++entry) {
      Index& known = distance[static_cast<std::size_t>(entry.row())];
      if (known >= 0) continue;
      known = next;
      reached.push_back(entry.row());
    }
  }
  return distance;
}

}  // namespace butee::model
