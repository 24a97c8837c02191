#include "integrators/exponential/component_speeds.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

ComponentSpeeds::ComponentSpeeds(const model::System& system, const dynamics::ModalSystem& modal)
    : modal_(modal), scales_(system) {
  largest_ = now_ = of_kind_ = Vector::Zero(modal.shape_rows().cols());
}

void ComponentSpeeds::start(const double* q, double rounding_rate, double* memory) const {
  Vector x = Vector::Zero(largest_.size());
  if (rounding_rate > 0.0) modal_.to_physical(q, x);
  Eigen::Map<Vector>(memory, largest_.size()) = rounding_rate * x.cwiseAbs();
}

void ComponentSpeeds::load(const double* memory) {
  largest_ = Eigen::Map<const Vector>(memory, largest_.size());
}

void ComponentSpeeds::save(double* memory) const {
  Eigen::Map<Vector>(memory, largest_.size()) = largest_;
}

void ComponentSpeeds::raise(const Eigen::ArrayXd& v) {
  modal_.to_physical(v.data(), now_);
  scales_.raise(now_, largest_);
}

double ComponentSpeeds::relative(const Eigen::ArrayXd& modal_speeds) {
  constexpr double kLeastOfKind = 0.02;
  scales_.largest_of_kind(largest_, of_kind_);
  double largest = 0.0;
  for (Index d = 0; d < largest_.size(); ++d)
    if (const double scale = std::max(largest_[d], kLeastOfKind * of_kind_[d]); scale > 0.0)
      largest = std::max(largest, (modal_.shape_rows().col(d).array() * modal_speeds).square().sum() / (scale * scale));
  return std::sqrt(largest);
}

}  // namespace butee::integrators
