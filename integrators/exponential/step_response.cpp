#include "integrators/exponential/step_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "integrators/exponential/harmonic_response.hpp"

namespace butee::integrators {
namespace {

using Series = ResponseSeries;

constexpr int kPowers = Series::kPowers;

/// The positions of the nodes; 0 in the unused lane.
Lane places_of_lanes() {
  Lane places = Lane::Zero();
  for (Index j = 0; j < kPowers; ++j) places[j] = StepNodes::kPlaces[static_cast<std::size_t>(j)];
  return places;
}

}  // namespace

void StepResponse::set(double h) {
  h_ = h;
  propagator_.resize(2 * count_, Lanes::ColsAtCompileTime);
  propagator_.col(Lanes::ColsAtCompileTime - 1).setZero();
  at_place_.resize(count_, 2);
  for (Index j = 0; j < kPowers; ++j) {
    modes_.turn_by(StepNodes::kPlaces[static_cast<std::size_t>(j)] * h, 0, at_place_.col(0), at_place_.col(1));
    propagator_.col(j).head(count_) = at_place_.col(0);
    propagator_.col(j).tail(count_) = at_place_.col(1);
  }
  moments_.resize(count_, Moments::ColsAtCompileTime);
  for (Index k = 0; k < count_; ++k) find_moments(k);
  harmonics_.resize(loads_.size());
  for (std::size_t j = 0; j < loads_.size(); ++j) find(loads_[j], harmonics_[j]);
}

void StepResponse::find_moments(Index mode) {
  // Lane j belongs to the position c_j; formulas as in PlaceResponse.
  const double dr = modes_.decay()[mode] * h_, di = modes_.turn()[mode] * h_, speed = modes_.speed()[mode] * h_;
  const auto moment = [this, mode](Index r) {
    double* const at = moments_.data() + (mode * kPowers + r) * 2 * Lanes::ColsAtCompileTime;
    return std::pair(Eigen::Map<Lane>(at), Eigen::Map<Lane>(at + Lanes::ColsAtCompileTime));
  };
  const Lane places = places_of_lanes();
  std::array<Lane, kPowers + 1> power;  // h c^r
  power[0] = Lane::Constant(h_);
  for (std::size_t r = 1; r < power.size(); ++r) power[r] = power[r - 1] * places;
  if (speed * StepNodes::kPlaces[1] <= Series::kSmall) {
    const Lane wr = dr * places, wi = di * places;
    Series::moments(dr, di, wr, wi, power, std::min(speed, Series::kSmall),
                    [&](Index r, const Lane& re, const Lane& im) {
                      auto [to_re, to_im] = moment(r);
                      to_re = re;
                      to_im = im;
                    });
  } else {
    moments_.row(mode).setZero();
  }
  if (speed <= Series::kSmall) return;
  const double square = dr * dr + di * di, on_dr = dr / square, on_di = di / square;
  const auto is_fast = (speed * places > Series::kSmall).eval();
  Lane re = h_ * (lane_of<8>(propagator_, mode) - 1.0), im = h_ * lane_of<8>(propagator_, count_ + mode);
  for (Index r = 0; r < kPowers; ++r) {
    const Lane next_re = re * on_dr + im * on_di, next_im = im * on_dr - re * on_di;
    auto [to_re, to_im] = moment(r);
    to_re = is_fast.select(next_re, to_re);
    to_im = is_fast.select(next_im, to_im);
    const double next = static_cast<double>(r + 1);
    re = next * next_re - power[static_cast<std::size_t>(r) + 1];
    im = next * next_im;
  }
}

void StepResponse::find(const HarmonicLoad& load, Harmonic& harmonic) const {
  harmonic.angular_frequency = load.angular_frequency;
  harmonic.cosine.resize(2 * count_, Lanes::ColsAtCompileTime);
  harmonic.sine.resize(2 * count_, Lanes::ColsAtCompileTime);
  const Lane lengths = h_ * places_of_lanes(), turned = load.angular_frequency * lengths;
  const HarmonicAngle<Lane> angle{load.angular_frequency, lengths, turned, turned.cos(), turned.sin()};
  for (Index k = 0; k < count_; ++k) {
    const HarmonicResponse<Lane> unit(angle, Lane::Constant(modes_.decay()[k]), Lane::Constant(modes_.turn()[k]),
                                      lane_of<8>(propagator_, k), lane_of<8>(propagator_, count_ + k));
    const double cr = load.cosine[k], ci = load.cosine[count_ + k], sr = load.sine[k], si = load.sine[count_ + k];
    const auto put = [&](Lanes& out, const std::pair<Lane, Lane>& parts) {
      lane_of<8>(out, k) = parts.first;
      lane_of<8>(out, count_ + k) = parts.second;
    };
    put(harmonic.cosine, unit.of(cr, ci, sr, si));
    put(harmonic.sine, unit.of(sr, si, -cr, -ci));
  }
}

void StepResponse::move(double t, const double* z, const double* g, Lanes& nodes) const {
  nodes.resize(2 * count_, Lanes::ColsAtCompileTime);
  for (Index k = 0; k < count_; ++k) {
    const auto pr = lane_of<8>(propagator_, k), pi = lane_of<8>(propagator_, count_ + k);
    lane_of<8>(nodes, k) = pr * z[k] - pi * z[count_ + k];
    lane_of<8>(nodes, count_ + k) = pr * z[count_ + k] + pi * z[k];
  }
  for (const Harmonic& load : harmonics_) {
    const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
    for (Index k = 0; k < 2 * count_; ++k)
      lane_of<8>(nodes, k) += c * lane_of<8>(load.cosine, k) + s * lane_of<8>(load.sine, k);
  }
  if (g != nullptr) add_force(g, 1, 2 * count_, nodes);
}

void StepResponse::add_force(const Lanes& g, Lanes& nodes) const {
  add_force(g.data(), Lanes::ColsAtCompileTime, 1, nodes);
}

void StepResponse::add_force(const double* g, Index of_row, Index of_power, Lanes& nodes) const {
  constexpr Index kLanes = Lanes::ColsAtCompileTime;
  for (Index k = 0; k < count_; ++k) {
    const double *const gr = g + k * of_row, *const gi = g + (count_ + k) * of_row;
    const double* moment = moments_.data() + k * Moments::ColsAtCompileTime;
    // Two sums each, so that one multiplication need not wait for the other.
    Lane sum_re = lane_of<8>(nodes, k), sum_im = lane_of<8>(nodes, count_ + k), more_re = Lane::Zero(),
         more_im = more_re;
    for (Index r = 0; r < kPowers; ++r, moment += 2 * kLanes) {
      const Eigen::Map<const Lane> mr(moment), mi(moment + kLanes);
      const double of_re = gr[r * of_power], of_im = gi[r * of_power];
      sum_re += of_re * mr;
      sum_im += of_im * mr;
      more_re -= of_im * mi;
      more_im += of_re * mi;
    }
    lane_of<8>(nodes, k) = sum_re + more_re;
    lane_of<8>(nodes, count_ + k) = sum_im + more_im;
  }
}

}  // namespace butee::integrators
