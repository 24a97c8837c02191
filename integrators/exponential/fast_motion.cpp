#include "integrators/exponential/fast_motion.hpp"

#include <cmath>

namespace butee::integrators {

bool FastMotion::begin(double t, double h, const double* z, const double* g, Index first) {
  const Index p = modes_.count(), rest = p - first, loads = static_cast<Index>(loads_.size());
  const auto decay = modes_.decay().tail(rest), turn = modes_.turn().tail(rest);
  const Eigen::ArrayXd square = modes_.speed().tail(rest).square(), on_re = decay / square, on_im = -turn / square;
  t_ = t;
  h_ = h;
  first_ = first;
  polynomial_.resize(rest, StepNodes::kCount);
  Eigen::ArrayXd re = Eigen::ArrayXd::Zero(rest), im = re;
  for (Index r = StepNodes::kCount - 1; r >= 0; --r) {
    // p_r = ((r + 1) p_(r+1)/h - g_r)/lambda
    const double* const of_power = g + 2 * p * r + first;
    re -= Eigen::Map<const Eigen::ArrayXd>(of_power, rest);
    im -= Eigen::Map<const Eigen::ArrayXd>(of_power + p, rest);
    polynomial_.re.col(r) = re * on_re - im * on_im;
    polynomial_.im.col(r) = re * on_im + im * on_re;
    const double factor = static_cast<double>(r) / h;
    re = factor * polynomial_.re.col(r);
    im = factor * polynomial_.im.col(r);
  }
  free_.resize(rest, 1);
  free_.re.col(0) = Eigen::Map<const Eigen::ArrayXd>(z + first, rest) - polynomial_.re.col(0);
  free_.im.col(0) = Eigen::Map<const Eigen::ArrayXd>(z + p + first, rest) - polynomial_.im.col(0);
  cosine_.resize(rest, loads);
  sine_.resize(rest, loads);
  for (Index j = 0; j < loads; ++j) {
    const HarmonicLoad& load = loads_[static_cast<std::size_t>(j)];
    const double frequency = load.angular_frequency, c = std::cos(frequency * t), s = std::sin(frequency * t);
    if ((decay.square() + (std::abs(frequency) - turn).square() < (kResonant / h) * (kResonant / h)).any())
      return false;
    const auto cr = load.cosine.segment(first, rest).array(), ci = load.cosine.tail(rest).array(),
               sr = load.sine.segment(first, rest).array(), si = load.sine.tail(rest).array();
    // -(lambda cosine + Omega sine)/D and (Omega cosine - lambda sine)/D, D = lambda^2 + Omega^2
    const Eigen::ArrayXd dr = (frequency - turn) * (frequency + turn) + decay.square(), di = 2.0 * decay * turn,
                         inverse = (dr.square() + di.square()).inverse(), on_dr = inverse * dr, on_di = inverse * di;
    const auto divide = [&](const Eigen::ArrayXd& nr, const Eigen::ArrayXd& ni, Parts& out) {
      out.re.col(j) = nr * on_dr + ni * on_di;
      out.im.col(j) = ni * on_dr - nr * on_di;
    };
    divide(turn * ci - decay * cr - frequency * sr, -decay * ci - turn * cr - frequency * si, cosine_);
    divide(frequency * cr - decay * sr + turn * si, frequency * ci - decay * si - turn * sr, sine_);
    free_.re.col(0) -= c * cosine_.re.col(j) + s * sine_.re.col(j);
    free_.im.col(0) -= c * cosine_.im.col(j) + s * sine_.im.col(j);
  }
  turned_.resize(rest, 1);
  sum_.resize(rest, 1);
  return true;
}

void FastMotion::move(double place, Eigen::Ref<Eigen::VectorXd> z) {
  const Index rest = modes_.count() - first_;
  const double length = place * h_;
  modes_.turn_by(length, first_, turned_.re.col(0), turned_.im.col(0));
  auto re = sum_.re.col(0), im = sum_.im.col(0);
  re = turned_.re.col(0) * free_.re.col(0) - turned_.im.col(0) * free_.im.col(0);
  im = turned_.re.col(0) * free_.im.col(0) + turned_.im.col(0) * free_.re.col(0);
  double power = 1.0;
  for (Index r = 0; r < StepNodes::kCount; ++r, power *= place) {
    re += power * polynomial_.re.col(r);
    im += power * polynomial_.im.col(r);
  }
  for (Index j = 0; j < cosine_.re.cols(); ++j) {
    const double angle = loads_[static_cast<std::size_t>(j)].angular_frequency * (t_ + length), c = std::cos(angle),
                 s = std::sin(angle);
    re += c * cosine_.re.col(j) + s * sine_.re.col(j);
    im += c * cosine_.im.col(j) + s * sine_.im.col(j);
  }
  z.segment(first_, rest) = re.matrix();
  z.tail(rest) = im.matrix();
}

}  // namespace butee::integrators
