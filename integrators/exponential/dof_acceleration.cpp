#include "integrators/exponential/dof_acceleration.hpp"

namespace butee::integrators {

DofAcceleration::DofAcceleration(const dynamics::DampedModes& modes, const ModalLoads& loads, Index dof,
                                 const double* polynomial) {
  const Index p = modes.count();
  const auto shape = modes.velocity().col(dof);
  const auto re = shape.head(p).array(), im = shape.tail(p).array();
  row_.resize(2 * p);
  row_.head(p).array() = re * modes.decay() + im * modes.turn();
  row_.tail(p).array() = im * modes.decay() - re * modes.turn();
  polynomial_.noalias() = shape.transpose() * Eigen::Map<const Eigen::MatrixXd>(polynomial, 2 * p, StepNodes::kCount);
  for (const HarmonicLoad& load : loads.harmonic())
    harmonics_.push_back({shape.dot(load.cosine), shape.dot(load.sine)});
}

double DofAcceleration::at(double place, const Eigen::Ref<const Eigen::VectorXd>& z,
                           std::span<const Phase> phases) const {
  double sum = row_.dot(z), power = 1.0;
  for (Index r = 0; r < StepNodes::kCount; ++r, power *= place) sum += power * polynomial_[r];
  for (std::size_t j = 0; j < harmonics_.size(); ++j)
    sum += phases[j].cosine * harmonics_[j].cosine + phases[j].sine * harmonics_[j].sine;
  return sum;
}

}  // namespace butee::integrators
