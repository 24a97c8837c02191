#include "butee/record/extremes.hpp"

namespace butee::record {
namespace {

/// The cubic Hermite functions of the slopes are at most this.
constexpr double kBump = 4.0 / 27.0;
/// Those of the quintic that belong to the accelerations, over h^2.
constexpr double kQuinticBump = 0.0175;
/// No interval is halved further than this part of the step.
constexpr double kShortest = 1e-9;

/// Whether the slope of derivative `order` surely has one sign.
bool keeps_direction(std::size_t order, const Point& from, const Point& to, const std::array<double, 3>& departs) {
  const double d0 = from.of[order + 1], d1 = to.of[order + 1];
  double slack = departs[order + 1];
  if (order == 0) slack += kBump * (to.t - from.t) * (std::abs(from.of[2]) + std::abs(to.of[2]));
  return std::min(d0, d1) > slack || std::max(d0, d1) < -slack;
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
  const std::size_t count = dofs_[1] >= 0 ? 2 : dofs_[0] >= 0 ? 1 : 0;
  if (count == 0) return point;
  std::array<double, 2> x{}, v{}, a{};
  step_.integrator.interpolate(step_.from, step_.to, t, std::span(dofs_).first(count),
                               {std::span(x).first(count), std::span(v).first(count), std::span(a).first(count)});
  point.of = {sign_ * (x[0] - x[1]), sign_ * (v[0] - v[1]), sign_ * (a[0] - a[1])};
  return point;
}

Course::Bound Course::departure(const Point& from, const Point& to) const {
  const time::DenseOutput kind = step_.integrator.dense_output();
  if (kind == time::DenseOutput::cubic) return {0.0, 0.0, 0.0};
  const double h = to.t - from.t;
  const auto [x0, v0, a0] = from.of;
  const auto [x1, v1, a1] = to.of;
  if (kind == time::DenseOutput::quintic) {
    // How far the accelerations depart from those of the cubic by x and v, and how far x does from the integral of the
    // cubic by v and a, which differs from the slope of the quintic by the quartic 30 miss s^2 (1 - s)^2.
    const double rise = (x1 - x0) / h;
    const double off = std::abs(a0 - (6.0 * rise - 4.0 * v0 - 2.0 * v1) / h) +
                       std::abs(a1 - (2.0 * v0 + 4.0 * v1 - 6.0 * rise) / h);
    const double miss = std::abs(rise - 0.5 * (v0 + v1) - h / 12.0 * (a0 - a1));
    const double bend = std::abs((v1 - v0) / h - 0.5 * (a0 + a1));
    return {kQuinticBump * h * h * off, 30.0 / 16.0 * miss + kBump * h * off, 1.5 * bend + 5.8 * miss / h + off};
  }
  Bound sum{0.0, 0.0, 0.0};
  for (const Index dof : dofs_) {
    if (dof < 0) continue;
    Bound one{0.0, 0.0, 0.0};
    step_.integrator.departure(step_.from, step_.to, from.t, to.t, {&dof, 1},
                               {{&one[0], 1}, {&one[1], 1}, {&one[2], 1}});
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += one[k];
  }
  return sum;
}

std::pair<double, double> Course::enclose(std::size_t order, const Point& from, const Point& to,
                                          const Bound& departs) {
  const double h = to.t - from.t, y0 = from.of[order], y1 = to.of[order];
  double slack = departs[order];
  if (order < 2) slack += kBump * h * (std::abs(from.of[order + 1]) + std::abs(to.of[order + 1]));
  return {std::min(y0, y1) - slack, std::max(y0, y1) + slack};
}

std::pair<double, double> Course::enclose(std::size_t order, const Point& from, const Point& to) const {
  return enclose(order, from, to, departure(from, to));
}

void Course::search(std::size_t order, const Point& from, const Point& to, Range& range) const {
  int samples = 0;
  halve(order, from, to, samples, range);
}

void Course::halve(std::size_t order, const Point& from, const Point& to, int& samples, Range& range) const {
  const double h = to.t - from.t;
  if (!(h > 0.0)) return;
  const Bound departs = departure(from, to);
  const auto [lower, upper] = enclose(order, from, to, departs);
  const double good = kGood * range.size();
  if (!(upper > range.greatest + good) && !(lower < range.least - good)) return;
  if (!(departs[order] > good)) return take_stationary(order, from, to, range);
  if (order < 2 && keeps_direction(order, from, to, departs)) return;
  const double middle = from.t + 0.5 * h;
  if (samples == kMostSamples || h < kShortest * (step_.to.t - step_.from.t) ||
      !(middle > from.t && middle < to.t))
    return;
  ++samples;
  const Point between = at(middle);
  range.take(middle, between.of[order]);
  halve(order, from, between, samples, range);
  halve(order, between, to, samples, range);
}

void Course::take_stationary(std::size_t order, const Point& from, const Point& to, Range& range) const {
  if (order == 2) return;
  // The slope of the cubic, c0 + c1 s + c2 s^2 with s from 0 to 1.
  const double h = to.t - from.t, d0 = h * from.of[order + 1], d1 = h * to.of[order + 1];
  const double rise = to.of[order] - from.of[order];
  const double c0 = d0, c1 = 6.0 * rise - 4.0 * d0 - 2.0 * d1, c2 = 3.0 * (d0 + d1 - 2.0 * rise);
  const double root = c1 * c1 - 4.0 * c0 * c2;
  if (!(root >= 0.0)) return;
  const double larger = -0.5 * (c1 + std::copysign(std::sqrt(root), c1));
  for (const double s : {larger / c2, c0 / larger}) {
    if (!(s > 0.0 && s < 1.0)) continue;
    const double t = from.t + s * h;
    if (t < to.t) range.take(t, at(t).of[order]);
  }
}

}  // namespace butee::record
