#include "integrators/error_account.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace butee::integrators {

ComponentScales::ComponentScales(const model::System& system) {
  for (const model::NodalDof& dof : system.dofs.free())
    kinds_.push_back(is_rotation(dof.kind) ? std::uint8_t{1} : std::uint8_t{0});
}

void ComponentScales::raise(ConstVectorRef y, Eigen::Ref<Vector> scales) const {
  constexpr double kFloor = 1e-3;
  std::array<double, 2> largest{};
  for (Index i = 0; i < y.size(); ++i) {
    scales[i] = std::max(scales[i], std::abs(y[i]));
    double& top = largest[kinds_[static_cast<std::size_t>(i)]];
    top = std::max(top, scales[i]);
  }
  for (Index i = 0; i < y.size(); ++i)
    scales[i] = std::max(scales[i], kFloor * largest[kinds_[static_cast<std::size_t>(i)]]);
}

void ComponentScales::largest_of_kind(ConstVectorRef scales, Vector& all) const {
  std::array<double, 2> largest{};
  for (Index i = 0; i < scales.size(); ++i) {
    double& top = largest[kinds_[static_cast<std::size_t>(i)]];
    top = std::max(top, scales[i]);
  }
  for (Index i = 0; i < scales.size(); ++i) all[i] = largest[kinds_[static_cast<std::size_t>(i)]];
}

}  // namespace butee::integrators
