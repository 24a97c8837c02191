#include "butee/record/extremes.hpp"

#include "butee/time/derivative_rounding.hpp"

namespace butee::record {
namespace {

/// No interval is halved below this fraction of the step.
constexpr double kShortest = 1e-9;
/// The largest number of halvings of a polynomial.
constexpr int kMostSplits = 40;
/// Rounding of the coefficients after some dozens of halvings, relative to the largest.
constexpr double kRoundingOfHalves = 16.0 * std::numeric_limits<double>::epsilon();

/// A polynomial on [0, 1] by its Bernstein coefficients: the first and the last are the values at
/// the ends, and the smallest and the largest bound it.
template <std::size_t Degree>
using Bernstein = std::array<double, Degree + 1>;

template <std::size_t Degree>
std::pair<double, double> bounds_of(const Bernstein<Degree>& c) {
  double least = c[0], greatest = c[0];
  for (std::size_t i = 1; i <= Degree; ++i) {
    least = std::min(least, c[i]);
    greatest = std::max(greatest, c[i]);
  }
  return {least, greatest};
}

/// De Casteljau's rule at 1/2: `first` becomes the first half; returns the second.
template <std::size_t Degree>
Bernstein<Degree> split(Bernstein<Degree>& first) {
  Bernstein<Degree> second = first;
  for (std::size_t round = 1; round <= Degree; ++round) {
    for (std::size_t i = 0; i + round <= Degree; ++i) second[i] = 0.5 * (second[i] + second[i + 1]);
    first[round] = second[0];
  }
  return second;
}

template <std::size_t Degree>
Bernstein<Degree - 1> slope(const Bernstein<Degree>& c, double h) {
  Bernstein<Degree - 1> slope;
  for (std::size_t i = 0; i < Degree; ++i) slope[i] = static_cast<double>(Degree) / h * (c[i + 1] - c[i]);
  return slope;
}

/// The cubic through the values and slopes of derivative `order`; the slopes are the next
/// derivative.
Bernstein<3> cubic(std::size_t order, const Point& from, const Point& to) {
  const double third = (to.t - from.t) / 3.0;
  return {from.of[order], from.of[order] + third * from.of[order + 1], to.of[order] - third * to.of[order + 1],
          to.of[order]};
}

/// The quintic by x, v and a.
Bernstein<5> quintic(const Point& from, const Point& to) {
  const double h = to.t - from.t;
  const auto [x0, v0, a0] = from.of;
  const auto [x1, v1, a1] = to.of;
  const double c1 = x0 + 0.2 * h * v0, c4 = x1 - 0.2 * h * v1;
  return {x0, c1, 2.0 * c1 - x0 + 0.05 * h * h * a0, 2.0 * c4 - x1 + 0.05 * h * h * a1, c4, x1};
}

/// The extremes of a polynomial outside a range, with their positions.
template <std::size_t Degree>
void seek(Bernstein<Degree> first, double begin, double end, double good, int splits, Range& beyond) {
  const auto [least, greatest] = bounds_of<Degree>(first);
  if (!(greatest > beyond.greatest + good) && !(least < beyond.least - good)) return;
  if (splits == kMostSplits) return;
  const Bernstein<Degree> second = split<Degree>(first);
  const double middle = 0.5 * (begin + end);
  beyond.take(middle, second[0]);
  seek<Degree>(first, begin, middle, good, splits + 1, beyond);
  seek<Degree>(second, middle, end, good, splits + 1, beyond);
}

/// Derivative `order` of a polynomial of x.
template <std::size_t Degree>
void seek_in(std::size_t order, const Bernstein<Degree>& x, double h, double good, Range& beyond) {
  if (order == 0) return seek<Degree>(x, 0.0, 1.0, good, 0, beyond);
  const Bernstein<Degree - 1> v = slope<Degree>(x, h);
  if (order == 1) return seek<Degree - 1>(v, 0.0, 1.0, good, 0, beyond);
  seek<Degree - 2>(slope<Degree - 1>(v, h), 0.0, 1.0, good, 0, beyond);
}

/// Whether accelerations depart from those of the cubic through x and v far more at one end than at
/// the other, for example if a stop changes the acceleration abruptly at the end of a step, or by
/// far more than those are: the dense output may then be that cubic.
bool may_bend(const Point& from, const Point& to) {
  constexpr double kMore = 5.0;
  const double h = to.t - from.t, rise = 6.0 * (to.of[0] - from.of[0]) / h;
  const double a0 = (rise - 4.0 * from.of[1] - 2.0 * to.of[1]) / h, a1 = (2.0 * from.of[1] + 4.0 * to.of[1] - rise) / h;
  const double off0 = std::abs(from.of[2] - a0), off1 = std::abs(to.of[2] - a1);
  return std::max(off0, off1) > kMore * std::min({off0, off1, std::max(std::abs(a0), std::abs(a1))});
}

/// The value of a polynomial at a position, by de Casteljau's rule.
template <std::size_t Degree>
double value_at(Bernstein<Degree> c, double place) {
  for (std::size_t rest = Degree; rest > 0; --rest)
    for (std::size_t i = 0; i < rest; ++i) c[i] += place * (c[i + 1] - c[i]);
  return c[0];
}

/// The value of a polynomial at the midpoint.
template <std::size_t Degree>
double middle_of(Bernstein<Degree> c) {
  return split<Degree>(c)[0];
}

}  // namespace

void Range::save(ByteWriter& to) const {
  for (const double number : {least, greatest, t_least, t_greatest}) to.put(number);
}

void Range::restore(ByteReader& from) {
  for (double* number : {&least, &greatest, &t_least, &t_greatest}) from.take(*number);
}

Point StepPath::at(double t) const {
  Point point{t, {0.0, 0.0, 0.0}};
  double sign = 1.0;
  for (const Index& dof : dofs_) {
    std::array<double, 3> of{};
    if (dof >= 0) step_.motion.interpolate(t, {&dof, 1}, {{&of[0], 1}, {&of[1], 1}, {&of[2], 1}});
    for (std::size_t k = 0; k < of.size(); ++k) point.of[k] += sign * of[k];
    sign = -1.0;
  }
  return point;
}

double StepPath::displacement(const Point& from, const Point& to, double t) const {
  if (kind_ == time::Interpolation::cubic || kind_ == time::Interpolation::other || may_bend(from, to))
    return at(t).of[0];
  return value_at<5>(quintic(from, to), (t - from.t) / (to.t - from.t));
}

std::pair<double, double> StepPath::enclose(std::size_t order, const Point& from, const Point& to) const {
  return enclose(order, from, to, departure(order, from, to));
}

std::pair<double, double> StepPath::enclose(std::size_t order, const Point& from, const Point& to,
                                            double departs) const {
  const auto [least, greatest] = bounds_within(order, from, to);
  return {std::min({from.of[order], to.of[order], least}) - departs,
          std::max({from.of[order], to.of[order], greatest}) + departs};
}

double StepPath::departure(std::size_t order, const Point& from, const Point& to) const {
  if (kind_ != time::Interpolation::other && !(kind_ == time::Interpolation::near_quintic && order == 1)) return 0.0;
  double sum = 0.0;
  for (const Index dof : dofs_) {
    if (dof < 0) continue;
    std::array<double, 3> bound{};
    const auto wanted = [&](std::size_t k) { return std::span(&bound[k], k == order ? 1 : 0); };
    step_.motion.departure(from.t, to.t, {&dof, 1}, {wanted(0), wanted(1), wanted(2)});
    sum += bound[order];
  }
  return sum;
}

double StepPath::rounding(std::size_t order, const Point& from, const Point& to) const {
  if (order == 0) return rounding_[0];
  double displacement = 0.0, speed = 0.0;
  for (const Index dof : dofs_) {
    if (dof < 0) continue;
    displacement += std::max(std::abs(step_.from.x[dof]), std::abs(step_.to.x[dof]));
    speed += std::max(std::abs(step_.from.v[dof]), std::abs(step_.to.v[dof]));
  }
  return std::max(rounding_[order],
                  time::derivative_rounding(static_cast<int>(order), displacement, speed, to.t, to.t - from.t));
}

std::array<double, 3> StepPath::rounding_of_sums(const time::AcceptedStep& step) {
  constexpr double kOfSum = 16.0 * std::numeric_limits<double>::epsilon();
  const auto largest = [](const Vector& a, const Vector& b) {
    return a.size() > 0 ? std::max(a.lpNorm<Eigen::Infinity>(), b.lpNorm<Eigen::Infinity>()) : 0.0;
  };
  return {kOfSum * largest(step.from.x, step.to.x), kOfSum * largest(step.from.v, step.to.v),
          kOfSum * largest(step.from.a, step.to.a)};
}

double StepPath::good_of(std::size_t order, const Range& range, double bound) const {
  double size = range.size();
  if (order > 0 || borders_.empty()) return kGood * size;
  for (const double border : borders_)
    size = std::min({size, std::abs(range.greatest - border), std::abs(range.least - border)});
  return std::max(kGood * size, kRoundingOfHalves * bound);
}

void StepPath::search(std::size_t order, const Point& from, const Point& to, Range& range) const {
  int samples = 0;
  halve(order, from, to, samples, range);
}

void StepPath::halve(std::size_t order, const Point& from, const Point& to, int& samples, Range& range) const {
  const double h = to.t - from.t, middle = from.t + 0.5 * h;
  if (!(middle > from.t && middle < to.t)) return;
  const double rounded = rounding(order, from, to), margin = margin_of(order, range);
  double departs = departure(order, from, to);
  if (departs <= margin) departs = 0.0;  // the margin allows for it
  const auto [least, greatest] = enclose(order, from, to, departs);
  const double good = std::max(good_of(order, range, std::max(std::abs(least), std::abs(greatest))), rounded);
  Range target = range;
  target.greatest -= margin;
  target.least += margin;
  if (!(greatest > target.greatest + good) && !(least < target.least - good)) return;
  if (!(departs > good)) {
    Range beyond = target;
    if (kind_ == time::Interpolation::cubic) {
      if (order < 2) seek<3>(cubic(order, from, to), 0.0, 1.0, good, 0, beyond);
    } else {
      const Bernstein<5> bent = quintic(from, to);
      const Bernstein<3> straight = cubic(0, from, to);
      const double x =
          kind_ != time::Interpolation::other && may_bend(from, to) ? at(middle).of[0] : middle_of<5>(bent);
      if (std::abs(x - middle_of<3>(straight)) < std::abs(x - middle_of<5>(bent)))
        seek_in<3>(order, straight, h, good, beyond);
      else
        seek_in<5>(order, bent, h, good, beyond);
    }
    for (const auto [value, before, place] : {std::array{beyond.greatest, target.greatest, beyond.t_greatest},
                                              std::array{beyond.least, target.least, beyond.t_least}}) {
      const double t = from.t + place * h;
      if (value == before || !(t > from.t && t < to.t)) continue;
      const double found = at(t).of[order];
      if (rounded == 0.0 || found > range.greatest + rounded || found < range.least - rounded) range.take(t, found);
    }
    return;
  }
  if (samples == kMostSamples || h < kShortest * (step_.to.t - step_.from.t)) return;
  ++samples;
  const Point between = at(middle);
  range.take(middle, between.of[order]);
  halve(order, from, between, samples, range);
  halve(order, between, to, samples, range);
}

}  // namespace butee::record
