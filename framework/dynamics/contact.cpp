#include "butee/dynamics/contact.hpp"

#include <algorithm>
#include <cmath>

namespace butee::dynamics {
namespace {

using model::FreeStops;
using model::Sides;

struct Place {
  double penetration, side;
};

Place place(double w, double gap, Sides sides) {
  switch (sides) {
    case Sides::positive:
      return {w - gap, 1.0};
    case Sides::negative:
      return {-w - gap, -1.0};
    case Sides::both:
      break;
  }
  return {std::abs(w) - gap, static_cast<double>(w > 0.0) - static_cast<double>(w < 0.0)};
}

std::span<const double> part(const Vector& v, Index begin, Index count) {
  return {v.data() + begin, static_cast<std::size_t>(count)};
}
std::span<double> part(double* v, Index begin, Index count) {
  return {v + begin, static_cast<std::size_t>(count)};
}

}  // namespace

Contact::Contact(const model::System& system, linalg::Counters& counters)
    : counters_(&counters), system_size_(system.size()) {
  for (const FreeStops& stops : system.stops) {
    groups_.push_back({stops.law, stops.gap, stops.sides, size(), static_cast<Index>(stops.size())});
    a_.insert(a_.end(), stops.a.begin(), stops.a.end());
    b_.insert(b_.end(), stops.b.begin(), stops.b.end());
  }
  for (std::size_t i = 0; i < a_.size(); ++i) grounded_ = grounded_ && a_[i] >= 0 && b_[i] == FreeStops::kGround;
  penetration_ = side_ = secant_ = Vector::Zero(size());
}

void Contact::difference(ConstVectorRef x, VectorRef w) const {
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double ua = a_[i] >= 0 ? x[a_[i]] : 0.0;
    const double ub = b_[i] >= 0 ? x[b_[i]] : 0.0;
    w[static_cast<Index>(i)] = ua - ub;
  }
}

void Contact::scatter_both(ConstVectorRef f, VectorRef force) const {
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double value = f[static_cast<Index>(i)];
    if (a_[i] >= 0) force[a_[i]] += value;
    if (b_[i] >= 0) force[b_[i]] -= value;
  }
}

void Contact::locate(ConstVectorRef w) {
  for (const Group& group : groups_) {
    const double gap = group.gap, fixed_side = group.sides == Sides::positive ? 1.0 : -1.0;
    const double* displacement = w.data() + group.begin;
    double* penetration = penetration_.data() + group.begin;
    double* side = side_.data() + group.begin;
    if (group.sides == Sides::both) {
      for (Index i = 0; i < group.count; ++i) {
        penetration[i] = std::abs(displacement[i]) - gap;
        side[i] = displacement[i] > 0.0 ? 1.0 : displacement[i] < 0.0 ? -1.0 : 0.0;
      }
    } else {
      for (Index i = 0; i < group.count; ++i) {
        penetration[i] = fixed_side * displacement[i] - gap;
        side[i] = fixed_side;
      }
    }
  }
}

void Contact::count_evaluation() {
  ++counters_->contact_evaluations;
  counters_->law_evaluations += size();
}

void Contact::force(ConstVectorRef w, VectorRef f) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    const Place at = place(w[0], group.gap, group.sides);
    f[0] = -at.side * group.law->secant(at.penetration) * at.penetration;
    return;
  }
  locate(w);
  for (const Group& group : groups_)
    group.law->secants(part(penetration_, group.begin, group.count), part(secant_.data(), group.begin, group.count));
  f = -side_.array() * secant_.array() * penetration_.array();
}

void Contact::tangent(ConstVectorRef w, VectorRef f, VectorRef k) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    const Place at = place(w[0], group.gap, group.sides);
    f[0] = -at.side * group.law->secant(at.penetration) * at.penetration;
    k[0] = group.law->tangent(at.penetration);
    return;
  }
  locate(w);
  for (const Group& group : groups_)
    group.law->tangents(part(penetration_, group.begin, group.count), part(secant_.data(), group.begin, group.count),
                        part(k.data(), group.begin, group.count));
  f = -side_.array() * secant_.array() * penetration_.array();
}

void Contact::secant(ConstVectorRef w, VectorRef k, VectorRef c) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    const Place at = place(w[0], group.gap, group.sides);
    k[0] = group.law->secant(at.penetration);
    c[0] = group.gap * at.side * k[0];
    return;
  }
  locate(w);
  for (const Group& group : groups_) {
    group.law->secants(part(penetration_, group.begin, group.count), part(k.data(), group.begin, group.count));
    c.segment(group.begin, group.count) =
        group.gap * side_.segment(group.begin, group.count).cwiseProduct(k.segment(group.begin, group.count));
  }
}

const Contact::Group& Contact::group_of(Index i) const {
  if (groups_.size() == 1) return groups_.front();
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), i,
                                      [](Index stop, const Group& group) { return stop < group.begin; });
  return *(after - 1);
}

double Contact::force_of(Index i, double w) {
  ++counters_->law_evaluations;
  const Group& group = group_of(i);
  const Place at = place(w, group.gap, group.sides);
  return -at.side * group.law->secant(at.penetration) * at.penetration;
}

double Contact::energy_of(Index i, double w) const {
  const Group& group = group_of(i);
  return group.law->energy(place(w, group.gap, group.sides).penetration) - group.law->energy(-group.gap);
}

double Contact::energy(ConstVectorRef w) const {
  double sum = 0.0;
  for (Index i = 0; i < size(); ++i) sum += energy_of(i, w[i]);
  return sum;
}

void Contact::penetration(ConstVectorRef w, VectorRef g) const {
  for (const Group& group : groups_)
    for (Index i = group.begin; i < group.begin + group.count; ++i)
      g[i] = place(w[i], group.gap, group.sides).penetration;
}

Vector Contact::closed_stiffness() const {
  Vector k(size());
  for (const Group& group : groups_) k.segment(group.begin, group.count).setConstant(group.law->closed_stiffness());
  return k;
}

}  // namespace butee::dynamics
