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
  forth_.resize(rest, loads);
  back_.resize(rest, loads);
  for (Index j = 0; j < loads; ++j) {
    const TurningLoad& load = loads_[static_cast<std::size_t>(j)];
    for (const double sense : {1.0, -1.0}) {
      // The coefficient of e^(i sense Omega t) over i sense Omega - lambda
      const double frequency = sense * load.angular_frequency, c = std::cos(frequency * t), s = std::sin(frequency * t);
      const Eigen::VectorXd& force = sense > 0.0 ? load.forth : load.back;
      Parts& response = sense > 0.0 ? forth_ : back_;
      const auto of_re = force.segment(first, rest).array(), of_im = force.tail(rest).array();
      const Eigen::ArrayXd away = decay.square() + (frequency - turn).square();
      if ((away < (kResonant / h) * (kResonant / h)).any()) return false;
      response.re.col(j) = ((frequency - turn) * of_im - decay * of_re) / away;
      response.im.col(j) = -((frequency - turn) * of_re + decay * of_im) / away;
      free_.re.col(0) -= c * response.re.col(j) - s * response.im.col(j);
      free_.im.col(0) -= c * response.im.col(j) + s * response.re.col(j);
    }
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
  for (Index j = 0; j < forth_.re.cols(); ++j) {
    const double angle = loads_[static_cast<std::size_t>(j)].angular_frequency * (t_ + length), c = std::cos(angle),
                 s = std::sin(angle);
    re += c * (forth_.re.col(j) + back_.re.col(j)) - s * (forth_.im.col(j) - back_.im.col(j));
    im += c * (forth_.im.col(j) + back_.im.col(j)) + s * (forth_.re.col(j) - back_.re.col(j));
  }
  z.segment(first_, rest) = re.matrix();
  z.tail(rest) = im.matrix();
}

}  // namespace butee::integrators
