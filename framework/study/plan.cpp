#include "butee/study/plan.hpp"

#include <algorithm>
#include <cmath>

#include "butee/config/parameters.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::study {
namespace {

/// The value rounded to 15 digits, so that 0.3 and 1e5 are these numbers.
double value_in(const Axis::Range& range, double u) {
  constexpr int kDigits = 15;
  const double value =
      range.is_logarithmic
          ? std::pow(10.0, std::log10(range.from) + u * (std::log10(range.to) - std::log10(range.from)))
          : range.from + u * (range.to - range.from);
  return number_of(to_short_text(value, kDigits)).value_or(value);
}

[[noreturn]] void refuse_size(double points, std::int64_t most) {
  throw InputError("the plan has " + to_short_text(points) + " points, more than the " +
                   to_short_text(static_cast<double>(most)) +
                   " that a study may have; take fewer values, or plan = \"sobol\" or \"latin\" with a count");
}

std::int64_t grid_size(const std::vector<Axis>& axes) {
  double points = 1.0;
  for (const Axis& axis : axes) points *= static_cast<double>(axis.size());
  if (points > static_cast<double>(Plan::kMostPoints)) refuse_size(points, Plan::kMostPoints);
  return static_cast<std::int64_t>(points);
}

std::int64_t list_size(const std::vector<Axis>& axes) {
  for (const Axis& axis : axes)
    if (axis.size() != axes.front().size())
      throw InputError("plan = \"list\": " + axes.front().key + " has " + std::to_string(axes.front().size()) +
                       " values and " + axis.key + " has " + std::to_string(axis.size()) +
                       "; a list takes them one by one, so that all need the same number");
  return axes.front().size();
}

}  // namespace

bool Axis::is_numeric() const {
  return range || std::all_of(values.begin(), values.end(),
                              [](const config::Value& value) { return config::as_number(value).has_value(); });
}

config::Value Axis::at(double u) const {
  if (range) return config::Value(value_in(*range, u));
  const auto index = static_cast<std::size_t>(u * static_cast<double>(values.size()));
  return values[std::min(index, values.size() - 1)];
}

std::int64_t Axis::size() const {
  return range ? count : std::ssize(values);
}

config::Value Axis::value(std::int64_t index) const {
  if (!range) return values[static_cast<std::size_t>(index)];
  if (index == 0) return config::Value(range->from);
  if (index == count - 1) return config::Value(range->to);
  return config::Value(value_in(*range, static_cast<double>(index) / static_cast<double>(count - 1)));
}

Plan::Plan(std::vector<Axis> axes, PlanKind kind, std::int64_t count, std::optional<std::uint64_t> seed, Follow follow)
    : axes_(std::move(axes)), kind_(kind), follow_(follow) {
  if (axes_.empty() && kind != PlanKind::grid)
    throw InputError("nothing varies: the study has no [[vary]], which this plan takes its values from");
  const bool is_random = kind == PlanKind::sobol || kind == PlanKind::latin;
  if (is_random && follow != Follow::no)
    throw InputError("study.follow: the points of a random plan are not a sweep; use plan = \"grid\" or \"list\"");
  switch (kind) {
    case PlanKind::grid:
      points_ = grid_size(axes_);
      break;
    case PlanKind::list:
      points_ = list_size(axes_);
      break;
    case PlanKind::sobol:
      if (count > kMostPoints) refuse_size(static_cast<double>(count), kMostPoints);
      if (axes_.size() > Sobol::kMostDimensions)
        throw InputError("plan = \"sobol\" takes at most " + std::to_string(Sobol::kMostDimensions) + " keys, not " +
                         std::to_string(axes_.size()) + "; take plan = \"latin\"");
      sobol_.emplace(axes_.size(), seed);
      points_ = count;
      break;
    case PlanKind::latin:
      if (count > kMostLatinPoints) refuse_size(static_cast<double>(count), kMostLatinPoints);
      latin_.emplace(static_cast<std::uint32_t>(count), axes_.size(), seed.value_or(0));
      points_ = count;
      break;
  }
  if (points_ < 1) throw InputError("the plan has no points");
  if (follow != Follow::no && !axes_.empty()) chain_length_ = kind == PlanKind::list ? points_ : axes_.back().size();
}

Plan::Run Plan::run(std::int64_t number) const {
  switch (follow_) {
    case Follow::up:
      return {number, 1};
    case Follow::down:
      return {number, -1};
    case Follow::both:
      return number < points_ ? Run{number, 1} : Run{number - points_, -1};
    case Follow::no:
      break;
  }
  return {number, 0};
}

std::vector<config::Value> Plan::values(std::int64_t point) const {
  std::vector<config::Value> values(axes_.size());
  for (std::size_t d = axes_.size(); d-- > 0;) {
    const Axis& axis = axes_[d];
    if (kind_ == PlanKind::list) {
      values[d] = axis.value(point);
    } else if (kind_ == PlanKind::grid) {
      values[d] = axis.value(point % axis.size());
      point /= axis.size();
    } else {
      const auto index = static_cast<std::uint64_t>(point);
      values[d] = axis.at(sobol_ ? sobol_->at(index, d) : latin_->at(index, d));
    }
  }
  return values;
}

Plan::Chain Plan::chain(std::int64_t index) const {
  const bool is_down = follow_ == Follow::down || (follow_ == Follow::both && index * chain_length_ >= points_);
  const std::int64_t first = index * chain_length_;
  return is_down ? Chain{first + chain_length_ - 1, -1, chain_length_} : Chain{first, 1, chain_length_};
}

}  // namespace butee::study
