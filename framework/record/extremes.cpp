#include "butee/record/extremes.hpp"

namespace butee::record {
namespace {

/// No interval is halved further than this part of the step.
constexpr double kShortest = 1e-9;
/// No polynomial is halved more often.
constexpr int kMostSplits = 40;

/// Derivative `order` of the cubic by x and v.
Hull of_cubic(std::size_t order, const Point& from, const Point& to) {
  const double h = to.t - from.t;
  const Hull x(std::array{from.of[0], from.of[0] + h / 3.0 * from.of[1], to.of[0] - h / 3.0 * to.of[1], to.of[0]});
  if (order == 0) return x;
  const Hull v = x.derivative().times(1.0 / h);
  return order == 1 ? v : v.derivative().times(1.0 / h);
}

/// Derivative `order` of the quintic by x, v and a.
Hull of_quintic(std::size_t order, const Point& from, const Point& to) {
  const double h = to.t - from.t;
  const auto [x0, v0, a0] = from.of;
  const auto [x1, v1, a1] = to.of;
  const Hull x(std::array{x0, x0 + 0.2 * h * v0, x0 + 0.4 * h * v0 + 0.05 * h * h * a0,
                          x1 - 0.4 * h * v1 + 0.05 * h * h * a1, x1 - 0.2 * h * v1, x1});
  if (order == 0) return x;
  const Hull v = x.derivative().times(1.0 / h);
  return order == 1 ? v : v.derivative().times(1.0 / h);
}

/// The extremes of a polynomial beyond a range, by the place.
void seek(Hull hull, double begin, double end, double good, int splits, Range& beyond) {
  const auto [least, greatest] = hull.bounds();
  if (!(greatest > beyond.greatest + good) && !(least < beyond.least - good)) return;
  if (splits == kMostSplits) return;
  const Hull second = hull.split();
  const double middle = 0.5 * (begin + end);
  beyond.take(middle, second.first());
  seek(hull, begin, middle, good, splits + 1, beyond);
  seek(second, middle, end, good, splits + 1, beyond);
}

}  // namespace

void Range::save(ByteWriter& to) const {
  for (const double number : {least, greatest, t_least, t_greatest}) to.put(number);
}

void Range::restore(ByteReader& from) {
  for (double* number : {&least, &greatest, &t_least, &t_greatest}) from.take(*number);
}

Point Course::at(double t) const {
  Point point{t, {0.0, 0.0, 0.0}};
  double sign = 1.0;
  for (const Index& dof : dofs_) {
    std::array<double, 3> of{};
    if (dof >= 0)
      step_.integrator.interpolate(step_.from, step_.to, t, {&dof, 1}, {{&of[0], 1}, {&of[1], 1}, {&of[2], 1}});
    for (std::size_t k = 0; k < of.size(); ++k) point.of[k] += sign * of[k];
    sign = -1.0;
  }
  return point;
}

Hull Course::hull(std::size_t order, const Point& from, const Point& to) const {
  if (kind_ != time::DenseOutput::cubic) return of_quintic(order, from, to);
  const double third = (to.t - from.t) / 3.0;
  if (order == 2) return Hull(std::array{from.of[2], to.of[2]});
  return Hull(std::array{from.of[order], from.of[order] + third * from.of[order + 1],
                         to.of[order] - third * to.of[order + 1], to.of[order]});
}

std::pair<double, double> Course::enclose(std::size_t order, const Point& from, const Point& to) const {
  return enclose(order, from, to, departure(order, from, to));
}

std::pair<double, double> Course::enclose(std::size_t order, const Point& from, const Point& to, double departs) const {
  const auto [least, greatest] = bounds_within(order, from, to);
  return {std::min({from.of[order], to.of[order], least}) - departs,
          std::max({from.of[order], to.of[order], greatest}) + departs};
}

double Course::departure(std::size_t order, const Point& from, const Point& to) const {
  if (kind_ != time::DenseOutput::other) return 0.0;
  double sum = 0.0;
  for (const Index dof : dofs_) {
    if (dof < 0) continue;
    std::array<double, 3> bound{};
    const auto wanted = [&](std::size_t k) { return std::span(&bound[k], k == order ? 1 : 0); };
    step_.integrator.departure(step_.from, step_.to, from.t, to.t, {&dof, 1}, {wanted(0), wanted(1), wanted(2)});
    sum += bound[order];
  }
  return sum;
}

void Course::search(std::size_t order, const Point& from, const Point& to, Range& range) const {
  int samples = 0;
  halve(order, from, to, samples, range);
}

void Course::halve(std::size_t order, const Point& from, const Point& to, int& samples, Range& range) const {
  const double h = to.t - from.t, middle = from.t + 0.5 * h;
  if (!(middle > from.t && middle < to.t)) return;
  const double good = kGood * range.size(), departs = departure(order, from, to);
  const auto [least, greatest] = enclose(order, from, to, departs);
  if (!(greatest > range.greatest + good) && !(least < range.least - good)) return;
  if (!(departs > good)) {
    Hull course = hull(order, from, to);
    if (kind_ == time::DenseOutput::quintic) {
      const double quintic = of_quintic(0, from, to).split().first(), cubic = of_cubic(0, from, to).split().first();
      const double x = at(middle).of[0];
      if (std::abs(x - cubic) < std::abs(x - quintic)) course = of_cubic(order, from, to);
    }
    Range beyond = range;
    seek(course, 0.0, 1.0, good, 0, beyond);
    for (const auto [value, before, place] : {std::array{beyond.greatest, range.greatest, beyond.t_greatest},
                                              std::array{beyond.least, range.least, beyond.t_least}}) {
      const double t = from.t + place * h;
      if (value != before && t > from.t && t < to.t) range.take(t, at(t).of[order]);
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
