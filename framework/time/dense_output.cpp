#include "butee/time/dense_output.hpp"

#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::time {
namespace {

/// The cubic through (y0, d0) at s = 0 and (y1, d1) at s = 1, slopes with respect to t.
double hermite(double s, double h, double y0, double d0, double y1, double d1) {
  const double r = 1.0 - s;
  return r * r * ((1.0 + 2.0 * s) * y0 + s * h * d0) + s * s * ((3.0 - 2.0 * s) * y1 - r * h * d1);
}

/// The motion on the straight lines between both ends.
void interpolate_straight(const State& from, const State& to, std::span<const double> times,
                          std::span<const Index> dofs, Interpolated out) {
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double s = (times[k] - from.t) / (to.t - from.t);
    const auto fill = [&](std::span<double> values, const Vector& begin, const Vector& end) {
      if (values.empty()) return;
      for (std::size_t i = 0; i < dofs.size(); ++i)
        values[k * dofs.size() + i] = (1.0 - s) * begin[dofs[i]] + s * end[dofs[i]];
    };
    fill(out.x, from.x, to.x);
    fill(out.v, from.v, to.v);
    fill(out.a, from.a, to.a);
  }
}

}  // namespace

Interpolant::~Interpolant() = default;

std::span<const double> Interpolant::breakpoints(const State&, const State&, Detail) {
  return {};
}

void Interpolant::interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                              Interpolated out) {
  const double h = to.t - from.t, s = (t - from.t) / h;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Index d = dofs[i];
    if (!out.x.empty()) out.x[i] = hermite(s, h, from.x[d], from.v[d], to.x[d], to.v[d]);
    if (!out.v.empty()) out.v[i] = hermite(s, h, from.v[d], from.a[d], to.v[d], to.a[d]);
    if (!out.a.empty()) out.a[i] = (1.0 - s) * from.a[d] + s * to.a[d];
  }
}

void Interpolant::interpolate_all(const State& from, const State& to, std::span<const double> times,
                                  std::span<const Index> dofs, Interpolated out) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto row = [&](std::span<double> all) {
      return all.empty() ? all : all.subspan(i * dofs.size(), dofs.size());
    };
    interpolate(from, to, times[i], dofs, {row(out.x), row(out.v), row(out.a)});
  }
}

void Interpolant::trace(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out) {
  interpolate(from, to, t, dofs, out);
}

int Interpolant::trace_parts(const State& from, const State& to) {
  return static_cast<int>(1 + breakpoints(from, to, Detail::velocities).size());
}

std::span<const EnergyAt> Interpolant::energies(const State&, const State&, std::span<const double>) {
  return {};
}

void Interpolant::departure(const State&, const State&, double, double, std::span<const Index>, Interpolated) {}

void DenseOutput::interpolate(std::span<const double> times, std::span<const Index> dofs, Interpolated out) const {
  if (times.empty()) return;
  require(to_->t > from_->t && times.front() >= from_->t && times.back() <= to_->t, "interpolation within a step");
  // In a step over a jump of the loads, a few roundings of t long, differences over h are rounding.
  constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  if (to_->t - from_->t <= kRounding * std::abs(to_->t)) return interpolate_straight(*from_, *to_, times, dofs, out);
  interpolant_->interpolate_all(*from_, *to_, times, dofs, out);
}

}  // namespace butee::time
