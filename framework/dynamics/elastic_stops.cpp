#include "butee/dynamics/elastic_stops.hpp"

#include <algorithm>
#include <cmath>

namespace butee::dynamics {
namespace {

using model::FreeStops;
std::span<const double> part(const Vector& v, Index begin, Index count) {
  return {v.data() + begin, static_cast<std::size_t>(count)};
}
std::span<double> part(double* v, Index begin, Index count) {
  return {v + begin, static_cast<std::size_t>(count)};
}

}  // namespace

ElasticStops::ElasticStops(const model::System& system, linalg::Counters& counters)
    : counters_(&counters), system_size_(system.size()) {
  for (const FreeStops& stops : system.stops) {
    groups_.push_back({stops.law, stops.play, size(), static_cast<Index>(stops.size())});
    a_.insert(a_.end(), stops.a.begin(), stops.a.end());
    b_.insert(b_.end(), stops.b.begin(), stops.b.end());
  }
  for (std::size_t i = 0; i < a_.size(); ++i) grounded_ = grounded_ && a_[i] >= 0 && b_[i] == FreeStops::kGround;
  penetration_ = side_ = secant_ = Vector::Zero(size());
}

void ElasticStops::difference(ConstVectorRef x, VectorRef w) const {
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double ua = a_[i] >= 0 ? x[a_[i]] : 0.0;
    const double ub = b_[i] >= 0 ? x[b_[i]] : 0.0;
    w[static_cast<Index>(i)] = ua - ub;
  }
}

void ElasticStops::scatter_both(ConstVectorRef f, VectorRef force) const {
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const double value = f[static_cast<Index>(i)];
    if (a_[i] >= 0) force[a_[i]] += value;
    if (b_[i] >= 0) force[b_[i]] -= value;
  }
}

void ElasticStops::locate(ConstVectorRef w) {
  for (const Group& group : groups_) {
    const model::FreePlay play = group.play;
    const double* displacement = w.data() + group.begin;
    double* penetration = penetration_.data() + group.begin;
    double* side = side_.data() + group.begin;
    for (Index i = 0; i < group.count; ++i) {
      penetration[i] = play.penetration(displacement[i]);
      side[i] = play.side(displacement[i]);
    }
  }
}

double ElasticStops::force_at(const Group& group, double w) {
  const double g = group.play.penetration(w);
  return -group.play.side(w) * group.law->secant(g) * g;
}

void ElasticStops::count_evaluation() {
  ++counters_->contact_evaluations;
  counters_->law_evaluations += size();
}

void ElasticStops::force(ConstVectorRef w, VectorRef f) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    f[0] = force_at(group, w[0]);
    return;
  }
  locate(w);
  for (const Group& group : groups_)
    group.law->secants(part(penetration_, group.begin, group.count), part(secant_.data(), group.begin, group.count));
  f = -side_.array() * secant_.array() * penetration_.array();
}

void ElasticStops::tangent(ConstVectorRef w, VectorRef f, VectorRef k) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    f[0] = force_at(group, w[0]);
    k[0] = group.law->tangent(group.play.penetration(w[0]));
    return;
  }
  locate(w);
  for (const Group& group : groups_)
    group.law->tangents(part(penetration_, group.begin, group.count), part(secant_.data(), group.begin, group.count),
                        part(k.data(), group.begin, group.count));
  f = -side_.array() * secant_.array() * penetration_.array();
}

void ElasticStops::secant(ConstVectorRef w, VectorRef k, VectorRef c) {
  count_evaluation();
  if (size() == 1) {
    const Group& group = groups_.front();
    k[0] = group.law->secant(group.play.penetration(w[0]));
    c[0] = group.play.gap * group.play.side(w[0]) * k[0];
    return;
  }
  locate(w);
  for (const Group& group : groups_) {
    group.law->secants(part(penetration_, group.begin, group.count), part(k.data(), group.begin, group.count));
    c.segment(group.begin, group.count) =
        group.play.gap * side_.segment(group.begin, group.count).cwiseProduct(k.segment(group.begin, group.count));
  }
}

const ElasticStops::Group& ElasticStops::group_of(Index i) const {
  if (groups_.size() == 1) return groups_.front();
  const auto after = std::upper_bound(groups_.begin(), groups_.end(), i,
                                      [](Index stop, const Group& group) { return stop < group.begin; });
  return *(after - 1);
}

double ElasticStops::force_of(Index i, double w) {
  ++counters_->law_evaluations;
  return force_at(group_of(i), w);
}

double ElasticStops::energy_of(Index i, double w) const {
  const Group& group = group_of(i);
  return group.law->energy(group.play.penetration(w)) - group.law->energy(-group.play.gap);
}

double ElasticStops::energy(ConstVectorRef w) const {
  double sum = 0.0;
  for (Index i = 0; i < size(); ++i) sum += energy_of(i, w[i]);
  return sum;
}

void ElasticStops::penetration(ConstVectorRef w, VectorRef g) const {
  for (const Group& group : groups_)
    for (Index i = group.begin; i < group.begin + group.count; ++i) g[i] = group.play.penetration(w[i]);
}

Vector ElasticStops::closed_stiffness() const {
  Vector k(size());
  for (const Group& group : groups_) k.segment(group.begin, group.count).setConstant(group.law->closed_stiffness());
  return k;
}

}  // namespace butee::dynamics
