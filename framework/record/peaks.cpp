#include "butee/record/peaks.hpp"

#include <algorithm>
#include <utility>

#include "butee/model/element_choice.hpp"
#include "butee/record/contacts_on.hpp"
#include "butee/record/probes.hpp"

namespace butee::record {
namespace {

/// In one piece, for the sum of several stops.
constexpr int kMostHalvingsOfSum = 4000;

using Bounds = std::pair<double, double>;

/// The bounds of the force of a stop whose displacement is between `least` and `greatest`. With two
/// sides the force also jumps at the middle if the law has a force at open stops.
Bounds force_bounds(dynamics::ElasticStops& contact, Index stop, double least, double greatest) {
  Bounds bounds = std::minmax({contact.force_of(stop, least), contact.force_of(stop, greatest)});
  if (contact.play_of(stop).has_both() && least < 0.0 && greatest > 0.0 &&
      contact.law_of(stop).asymptotic_force() > 0.0)
    for (const double w : {std::numeric_limits<double>::min(), -std::numeric_limits<double>::min()})
      bounds = {std::min(bounds.first, contact.force_of(stop, w)), std::max(bounds.second, contact.force_of(stop, w))};
  return bounds;
}

/// The bounds of the rate of the force of a piecewise linear stop, N/s, for a displacement and a speed within bounds.
Bounds rate_bounds(const model::FreePlay& play, double stiffness, const Bounds& displacement, const Bounds& speed) {
  const double side = play.closed_side(displacement.first), other_side = play.closed_side(displacement.second);
  if (side == 0.0 && other_side == 0.0) return {0.0, 0.0};
  const Bounds closed{-stiffness * speed.second, -stiffness * speed.first};
  if (side == other_side) return closed;
  return {std::min(0.0, closed.first), std::max(0.0, closed.second)};
}

double largest_of(const Bounds& bounds) {
  return std::max({0.0, -bounds.first, bounds.second});
}

}  // namespace

Peaks::Peaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics) : dynamics_(dynamics) {
  for (const model::ProbeRequest& request : requests)
    for (const model::Quantity quantity : request.quantities) {
      const Index dof = Probes::dof_of(quantity, request.node, dynamics);
      Column column{
          request.label + "." + name_of(quantity), kNone, static_cast<std::size_t>(order_of(quantity)), {}, 0.0};
      if (is_contact_force(quantity)) {
        column.stops = stops_on(quantity, request.node);
        column.is_piecewise_linear = std::all_of(column.stops.begin(), column.stops.end(), [&](const Stop& stop) {
          return dynamics.stops().law_of(stop.index).is_piecewise_linear();
        });
      } else if (dof >= 0)
        column.track = follow(dof, model::DofTable::kFixed, column.order);
      columns_.push_back(std::move(column));
    }
}

std::size_t Peaks::follow(Index a, Index b, std::size_t order) {
  const std::size_t track = tracks_.add(a, b, order);
  followed_.resize(tracks_.size());
  followed_[track].is_followed[order] = true;
  return track;
}

std::vector<Peaks::Stop> Peaks::stops_on(model::Quantity quantity, model::NodeId node) {
  const model::System& system = dynamics_.system();
  if (system.model == nullptr) return {};
  const dynamics::ElasticStops& contact = dynamics_.stops();
  const ContactsOn contacts =
      contacts_on(*system.model, system.dofs, {node, contact_kind(*system.model, node, quantity)});
  std::vector<Stop> stops;
  if (!contacts.obstacles.empty()) return stops;  // SampledPeaks follows the sum.
  for (const auto& [i, sign] : contacts.stops) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    // The speed resolves penetrations that are small beside the displacement.
    tracks_.add(a, b, 1);
    stops.push_back({i, follow(a, b, 0), sign, contact.closed_stiffness()[i]});
    tracks_.resolve(stops.back().track, contact.play_of(i));
  }
  return stops;
}

void Peaks::start(const time::State& state) {
  for (Followed& followed : followed_) followed.ranges.fill({});
  for (Column& column : columns_) column.largest = 0.0;
  take(state);
}

void Peaks::take(const time::State& state) {
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const Point point = tracks_.at(state, i);
    for (std::size_t order = 0; order < 3; ++order)
      if (followed_[i].is_followed[order]) followed_[i].ranges[order].take(point.t, point.of[order]);
  }
  for (Column& column : columns_) {
    begin_.clear();
    for (const Stop& stop : column.stops) begin_.push_back(tracks_.at(state, stop.track));
    column.largest = std::max(column.largest, sum_at(column, begin_));
  }
}

void Peaks::step(const time::AcceptedStep& step) {
  tracks_.visit(step, [&] {
    for (std::size_t i = 0; i < followed_.size(); ++i) {
      Followed& followed = followed_[i];
      const StepPath path = tracks_.path(step, i);
      for (std::size_t order = 0; order < 3; ++order)
        if (followed.is_followed[order]) path.extend(order, tracks_.from(i), tracks_.to(i), followed.ranges[order]);
    }
    for (Column& column : columns_)
      if (column.stops.size() > 1) {
        begin_.clear();
        end_.clear();
        for (const Stop& stop : column.stops) {
          begin_.push_back(tracks_.from(stop.track));
          end_.push_back(tracks_.to(stop.track));
        }
        column.largest = std::max(column.largest, sum_at(column, end_));
        follow_sum(step, column);
      }
  });
}

void Peaks::follow_sum(const time::AcceptedStep& step, Column& column) {
  struct Interval {
    double bound;
    std::vector<Point> from, to;
  };
  const auto exceeds = [&](double bound) { return bound > (1.0 + kGoodSum) * column.largest; };
  const double first = bound_of_sum(step, column, begin_, end_);
  if (!exceeds(first)) return;
  const auto is_lower = [](const Interval& a, const Interval& b) { return a.bound < b.bound; };
  std::vector<Interval> heap = {{first, begin_, end_}};
  for (int halvings = 0; !heap.empty() && exceeds(heap.front().bound) && halvings < kMostHalvingsOfSum; ++halvings) {
    std::pop_heap(heap.begin(), heap.end(), is_lower);
    const Interval whole = std::move(heap.back());
    heap.pop_back();
    const double t = 0.5 * (whole.from.front().t + whole.to.front().t);
    if (!(t > whole.from.front().t && t < whole.to.front().t)) continue;
    std::vector<Point> middle;
    for (const Stop& stop : column.stops) middle.push_back(tracks_.path(step, stop.track).at(t));
    column.largest = std::max(column.largest, sum_at(column, middle));
    for (Interval half : {Interval{0.0, whole.from, middle}, Interval{0.0, middle, whole.to}}) {
      half.bound = bound_of_sum(step, column, half.from, half.to);
      if (!exceeds(half.bound)) continue;
      heap.push_back(std::move(half));
      std::push_heap(heap.begin(), heap.end(), is_lower);
    }
  }
}

double Peaks::bound_of_sum(const time::AcceptedStep& step, const Column& column, const std::vector<Point>& from,
                           const std::vector<Point>& to) const {
  dynamics::ElasticStops& stops = dynamics_.stops();
  Bounds force{0.0, 0.0}, rate{0.0, 0.0};
  const auto add = [](const Bounds& part, double sign, Bounds& sum) {
    sum.first += sign > 0.0 ? part.first : -part.second;
    sum.second += sign > 0.0 ? part.second : -part.first;
  };
  for (std::size_t i = 0; i < column.stops.size(); ++i) {
    const Stop& stop = column.stops[i];
    const StepPath path = tracks_.path(step, stop.track);
    const Bounds displacement = path.enclose(0, from[i], to[i]);
    add(force_bounds(stops, stop.index, displacement.first, displacement.second), stop.sign, force);
    if (column.is_piecewise_linear)
      add(rate_bounds(stops.play_of(stop.index), stop.stiffness, displacement, path.enclose(1, from[i], to[i])),
          stop.sign, rate);
  }
  if (!column.is_piecewise_linear) return largest_of(force);
  const double half = 0.5 * (to.front().t - from.front().t);
  return std::min(largest_of(force), std::max(sum_at(column, from), sum_at(column, to)) + half * largest_of(rate));
}

double Peaks::sum_at(const Column& column, const std::vector<Point>& points) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    sum += column.stops[i].sign * dynamics_.stops().force_of(column.stops[i].index, points[i].of[0]);
  return std::abs(sum);
}

double Peaks::value_of(const Column& column) const {
  if (column.track != kNone) return followed_[column.track].ranges[column.order].size();
  if (column.stops.size() != 1) return column.largest;
  const Stop& stop = column.stops.front();
  const Range& range = followed_[stop.track].ranges[0];
  return range.is_empty() ? 0.0 : largest_of(force_bounds(dynamics_.stops(), stop.index, range.least, range.greatest));
}

std::map<std::string, double> Peaks::largest() const {
  std::map<std::string, double> largest;
  for (const Column& column : columns_) largest[column.name] = value_of(column);
  return largest;
}

void Peaks::save(ByteWriter& to) const {
  for (const Followed& followed : followed_)
    for (const Range& range : followed.ranges) range.save(to);
  for (const Column& column : columns_) to.put(column.largest);
}

void Peaks::restore(ByteReader& from) {
  for (Followed& followed : followed_)
    for (Range& range : followed.ranges) range.restore(from);
  for (Column& column : columns_) from.take(column.largest);
}

}  // namespace butee::record
