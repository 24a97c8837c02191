#include "integrators/exponential/step_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

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

void StepResponse::find(const TurningLoad& load, Harmonic& harmonic) const {
  harmonic.angular_frequency = load.angular_frequency;
  const Lane lengths = h_ * places_of_lanes(), c = (load.angular_frequency * lengths).cos(),
             s = (load.angular_frequency * lengths).sin();
  for (const double sense : {1.0, -1.0}) {
    const Eigen::VectorXd& force = sense > 0.0 ? load.forth : load.back;
    Lanes& out = sense > 0.0 ? harmonic.forth : harmonic.back;
    out.resize(2 * count_, Lanes::ColsAtCompileTime);
    for (Index k = 0; k < count_; ++k) {
      // (e^(i Omega L) - e^(lambda L))/(i Omega - lambda)
      const Lane pr = lane_of<8>(propagator_, k), pi = lane_of<8>(propagator_, count_ + k), dr = c - pr,
                 di = sense * s - pi;
      const double away_re = -modes_.decay()[k], away_im = sense * load.angular_frequency - modes_.turn()[k],
                   square = away_re * away_re + away_im * away_im,
                   inverse = 1.0 / std::max(square, std::numeric_limits<double>::min());
      Lane re = inverse * (dr * away_re + di * away_im), im = inverse * (di * away_re - dr * away_im);
      // For w = (i Omega - lambda) L near 0 this cancels; then e^(lambda L) L (e^w - 1)/w.
      if (square * lengths[1] * lengths[1] <= Series::kNearResonance) {
        const Lane wr = away_re * lengths, wi = away_im * lengths;
        const auto [sr, si] = Series::phi(wr, wi);
        const auto is_near = (square * lengths.square() <= Series::kNearResonance).eval();
        re = is_near.select(lengths * (pr * sr - pi * si), re);
        im = is_near.select(lengths * (pr * si + pi * sr), im);
      }
      const double of_re = force[k], of_im = force[count_ + k];
      lane_of<8>(out, k) = re * of_re - im * of_im;
      lane_of<8>(out, count_ + k) = re * of_im + im * of_re;
    }
    out.col(Lanes::ColsAtCompileTime - 1).setZero();
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
    for (Index k = 0; k < count_; ++k) {
      const auto fr = lane_of<8>(load.forth, k), fi = lane_of<8>(load.forth, count_ + k), br = lane_of<8>(load.back, k),
                 bi = lane_of<8>(load.back, count_ + k);
      lane_of<8>(nodes, k) += c * (fr + br) - s * (fi - bi);
      lane_of<8>(nodes, count_ + k) += c * (fi + bi) + s * (fr - br);
    }
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
