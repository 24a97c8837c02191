#include "butee/record/peaks.hpp"

#include "butee/model/element_choice.hpp"
#include "butee/record/contacts_on.hpp"
#include "butee/record/probes.hpp"

namespace butee::record {
namespace {

/// In one piece, for the sum of several stops.
constexpr int kMostHalvingsOfSum = 4000;

/// The largest |force| of a stop whose displacement is between `least` and `greatest`. With two
/// sides the force also jumps at the middle if the law has a force at open stops.
double largest_force(dynamics::ElasticStops& contact, Index stop, double least, double greatest) {
  const auto size_at = [&](double w) { return std::abs(contact.force_of(stop, w)); };
  double largest = std::max(size_at(least), size_at(greatest));
  if (contact.play_of(stop).has_both() && least < 0.0 && greatest > 0.0 &&
      contact.law_of(stop).asymptotic_force() > 0.0)
    largest = std::max(largest, size_at(std::numeric_limits<double>::min()));
  return largest;
}

}  // namespace

Peaks::Peaks(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics) : dynamics_(dynamics) {
  for (const model::ProbeRequest& request : requests)
    for (const model::Quantity quantity : request.quantities) {
      const Index dof = Probes::dof_of(quantity, request.node, dynamics);
      Column column{
          request.label + "." + name_of(quantity), kNone, static_cast<std::size_t>(order_of(quantity)), {}, 0.0};
      if (is_contact_force(quantity))
        column.stops = stops_on(quantity, request.node);
      else if (dof >= 0)
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
    stops.push_back({i, follow(a, b, 0), sign});
    tracks_.resolve(stops.back().track, contact.play_of(i));
  }
  return stops;
}

void Peaks::start(const time::State& state) {
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const Point point = tracks_.at(state, i);
    for (std::size_t order = 0; order < 3; ++order) {
      followed_[i].ranges[order] = {};
      if (followed_[i].is_followed[order]) followed_[i].ranges[order].take(point.t, point.of[order]);
    }
  }
  for (Column& column : columns_) {
    begin_.clear();
    for (const Stop& stop : column.stops) begin_.push_back(tracks_.at(state, stop.track));
    column.largest = sum_at(column, begin_);
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
        int halvings = 0;
        column.largest = std::max(column.largest, sum_at(column, end_));
        follow_sum(step, column, begin_, end_, halvings);
      }
  });
}

void Peaks::follow_sum(const time::AcceptedStep& step, Column& column, const std::vector<Point>& from,
                       const std::vector<Point>& to, int& halvings) {
  double bound = 0.0;
  for (std::size_t i = 0; i < column.stops.size(); ++i) {
    const auto [least, greatest] = tracks_.path(step, column.stops[i].track).enclose(0, from[i], to[i]);
    bound += largest_force(dynamics_.stops(), column.stops[i].index, least, greatest);
  }
  const double t = 0.5 * (from.front().t + to.front().t);
  if (!(bound > (1.0 + kGoodSum) * column.largest) || halvings == kMostHalvingsOfSum || !(t > from.front().t)) return;
  ++halvings;
  std::vector<Point> middle;
  for (const Stop& stop : column.stops) middle.push_back(tracks_.path(step, stop.track).at(t));
  column.largest = std::max(column.largest, sum_at(column, middle));
  follow_sum(step, column, from, middle, halvings);
  follow_sum(step, column, middle, to, halvings);
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
  return range.is_empty() ? 0.0 : largest_force(dynamics_.stops(), stop.index, range.least, range.greatest);
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
