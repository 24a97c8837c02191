#include "integrators/exponential/modal_response.hpp"

#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "integrators/exponential/harmonic_response.hpp"

namespace butee::integrators {
namespace {

using Series = ResponseSeries;

constexpr int kPowers = Series::kPowers;

}  // namespace

PlaceResponse::PlaceResponse(const dynamics::DampedModes& modes, const std::vector<HarmonicLoad>& loads, double place,
                             double h, Index first, Index last)
    : first_(first), count_(modes.count()) {
  const Index rest = last - first;
  const double length = place * h;
  propagator_.resize(rest, 2);
  const auto decay = modes.decay().segment(first, rest), turn = modes.turn().segment(first, rest);
  modes.turn_by(length, first, propagator_.col(0), propagator_.col(1));
  find_moments(decay, turn, modes.speed().segment(first, rest), place, h);
  for (const HarmonicLoad& load : loads) add_harmonics(decay, turn, load, length);
}

void PlaceResponse::find_moments(ConstArrayRef decay, ConstArrayRef turn, ConstArrayRef speed, double place, double h) {
  const Index p = decay.size();
  moments_.resize(p, 2 * kPowers);
  std::array<double, kPowers + 1> power{};  // h c^r
  power[0] = h;
  for (std::size_t r = 1; r < power.size(); ++r) power[r] = power[r - 1] * place;
  Index slow = 0;
  while (slow < p && speed[slow] * place * h <= Series::kSmall) ++slow;
  // A few modes at a time stay in registers and take the terms that the fastest of them needs.
  const auto sum_series = [&](Index k, auto size) {
    constexpr int kSize = decltype(size)::value;
    using Part = Eigen::Array<double, kSize, 1>;
    const Part dr = h * decay.segment<kSize>(k), di = h * turn.segment<kSize>(k), wr = place * dr, wi = place * di;
    std::array<Part, kPowers + 1> powers;
    for (std::size_t r = 0; r < powers.size(); ++r) powers[r].setConstant(power[r]);
    Series::moments(dr, di, wr, wi, powers, speed[k + kSize - 1] * place * h,
                    [this, k](int r, const Part& re, const Part& im) {
                      moments_.col(2 * r).segment<kSize>(k) = re;
                      moments_.col(2 * r + 1).segment<kSize>(k) = im;
                    });
  };
  constexpr Index kTogether = 8;
  Index k = 0;
  for (; k + kTogether <= slow; k += kTogether) sum_series(k, std::integral_constant<int, kTogether>());
  if (slow >= kTogether && k < slow)
    sum_series(slow - kTogether, std::integral_constant<int, kTogether>());
  else
    for (; k < slow; ++k) sum_series(k, std::integral_constant<int, 1>());
  if (slow == p) return;
  // moment_r = (r moment_(r-1) - h c^r)/(lambda h), from moment_0 = h (e^w - 1)/(lambda h)
  const Index fast = p - slow;
  const Eigen::ArrayXd dr = decay.tail(fast) * h, di = turn.tail(fast) * h, square = dr.square() + di.square(),
                       on_dr = dr / square, on_di = di / square;
  Eigen::ArrayXd re = h * (propagator_.col(0).tail(fast) - 1.0), im = h * propagator_.col(1).tail(fast);
  for (int r = 0; r < kPowers; ++r) {
    if (r > 0) {
      re = r * moments_.col(2 * r - 2).tail(fast) - power[static_cast<std::size_t>(r)];
      im = r * moments_.col(2 * r - 1).tail(fast);
    }
    moments_.col(2 * r).tail(fast) = re * on_dr + im * on_di;
    moments_.col(2 * r + 1).tail(fast) = im * on_dr - re * on_di;
  }
}

void PlaceResponse::add_harmonics(ConstArrayRef decay, ConstArrayRef turn, const HarmonicLoad& load, double length) {
  const Index p = decay.size();
  harmonics_.push_back({load.angular_frequency, Eigen::VectorXd(2 * p), Eigen::VectorXd(2 * p)});
  HarmonicLoad& response = harmonics_.back();
  const double angle = load.angular_frequency * length, c = std::cos(angle), s = std::sin(angle);
  const auto find = [&](Index k, auto size) {
    constexpr int kSize = decltype(size)::value;
    using Part = Eigen::Array<double, kSize, 1>;
    const HarmonicAngle<Part> same{load.angular_frequency, Part::Constant(length), Part::Constant(angle),
                                   Part::Constant(c), Part::Constant(s)};
    const HarmonicResponse<Part> unit(same, decay.segment<kSize>(k), turn.segment<kSize>(k),
                                      propagator_.col(0).segment<kSize>(k), propagator_.col(1).segment<kSize>(k));
    const auto at = [&](const Eigen::VectorXd& all, Index begin) -> Part {
      return all.segment<kSize>(begin + first_ + k).array();
    };
    const Part cr = at(load.cosine, 0), ci = at(load.cosine, count_), sr = at(load.sine, 0), si = at(load.sine, count_);
    const auto put = [&](Eigen::VectorXd& out, const std::pair<Part, Part>& parts) {
      out.segment<kSize>(k) = parts.first.matrix();
      out.segment<kSize>(p + k) = parts.second.matrix();
    };
    put(response.cosine, unit.of(cr, ci, sr, si));
    put(response.sine, unit.of(sr, si, Part(-cr), Part(-ci)));
  };
  constexpr Index kTogether = 8;
  Index k = 0;
  for (; k + kTogether <= p; k += kTogether) find(k, std::integral_constant<int, kTogether>());
  for (; k < p; ++k) find(k, std::integral_constant<int, 1>());
}

void PlaceResponse::move(double t, const double* z, const double* g, Eigen::Ref<Eigen::VectorXd> out) const {
  const Index rest = propagator_.rows();
  const Eigen::Map<const Eigen::ArrayXd> zr(z + first_, rest), zi(z + count_ + first_, rest);
  auto re = out.segment(first_, rest), im = out.segment(count_ + first_, rest);
  re.array() = propagator_.col(0) * zr - propagator_.col(1) * zi;
  im.array() = propagator_.col(0) * zi + propagator_.col(1) * zr;
  for (const HarmonicLoad& load : harmonics_) {
    const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
    re += c * load.cosine.head(rest) + s * load.sine.head(rest);
    im += c * load.cosine.tail(rest) + s * load.sine.tail(rest);
  }
  if (g != nullptr) add_force(g, out);
}

void PlaceResponse::add_force(const double* g, Eigen::Ref<Eigen::VectorXd> out) const {
  const Index rest = propagator_.rows();
  double* const re = out.data() + first_;
  double* const im = re + count_;
  // Sums of a few modes at a time stay in registers.
  const auto add = [&](Index k, auto size) {
    using Part = Eigen::Array<double, decltype(size)::value, 1>;
    Eigen::Map<Part> to_re(re + k), to_im(im + k);
    Part sum_re = to_re, sum_im = to_im;
    for (Index r = 0; r < kPowers; ++r) {
      const double* const gr = g + 2 * count_ * r + first_ + k;
      const Eigen::Map<const Part> of_re(gr), of_im(gr + count_), mr(moments_.col(2 * r).data() + k),
          mi(moments_.col(2 * r + 1).data() + k);
      sum_re += mr * of_re - mi * of_im;
      sum_im += mr * of_im + mi * of_re;
    }
    to_re = sum_re;
    to_im = sum_im;
  };
  constexpr Index kTogether = 16;
  Index k = 0;
  for (; k + kTogether <= rest; k += kTogether) add(k, std::integral_constant<int, kTogether>());
  for (; k < rest; ++k) add(k, std::integral_constant<int, 1>());
}

}  // namespace butee::integrators
