#include "butee/dynamics/modal_damping.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/dynamics/frequencies.hpp"

namespace butee::dynamics {
namespace {

Index count_modes(const model::System& system) {
  const model::Damping& damping = system.damping;
  const auto listed = static_cast<Index>(damping.lowest_modes.size());
  const Index count = damping.every_mode != 0.0 ? system.size() : listed;
  if (count > model::Damping::kMostModes)
    throw InputError("modal damping of " + std::to_string(count) + " modes is not supported: give a list of at most " +
                     std::to_string(model::Damping::kMostModes) + " ratios for the lowest modes");
  if (count > system.size())
    throw InputError("modal damping names " + std::to_string(count) + " modes, but the system has only " +
                     std::to_string(system.size()));
  return count;
}

Modes modes_to_damp(const model::System& system, Index count) {
  auto modes = lowest_modes(system, count);
  if (!modes)
    throw InputError("the " + std::to_string(count) +
                     " lowest modes that [damping] modal asks for could not be computed; ask for fewer or more modes, "
                     "or use mass_proportional and stiffness_proportional");
  return std::move(*modes);
}

/// Rejects a list that names a mode that would be omitted, or that gives different ratios to modes of one
/// frequency: which of them is damped would be arbitrary.
void check_listed(const model::Damping& damping, const Modes& modes) {
  constexpr double kSame = 1e-8;
  const auto ratio_of = [&](Index i) {
    const auto place = static_cast<std::size_t>(i);
    return place < damping.lowest_modes.size() ? damping.lowest_modes[place] : 0.0;
  };
  for (Index i = 0; i + 1 < modes.frequencies.size(); ++i) {
    const double omega = modes.frequencies[i], next = modes.frequencies[i + 1];
    if (ratio_of(i) != ratio_of(i + 1) && next > 0.0 && next - omega <= kSame * next)
      throw InputError("[damping] modal gives the ratios " + to_short_text(ratio_of(i)) + " and " +
                       to_short_text(ratio_of(i + 1)) + " to modes " + std::to_string(i + 1) + " and " +
                       std::to_string(i + 2) + ", which have the same frequency, " + to_short_text(omega) +
                       " rad/s, and are not distinct: give both the same ratio" +
                       (static_cast<std::size_t>(i + 1) < damping.lowest_modes.size()
                            ? ""
                            : " (modes after the end of the list have none)"));
  }
  for (std::size_t i = 0; i < damping.lowest_modes.size(); ++i)
    if (damping.lowest_modes[i] > 0.0 && modes.frequencies[static_cast<Index>(i)] == 0.0)
      throw InputError("[damping] modal gives a ratio to mode " + std::to_string(i + 1) +
                       ", whose frequency is zero, or so far below the highest that it cannot be distinguished from "
                       "zero in rounding: write 0 for rigid motion, or use longer elements");
}

}  // namespace

std::unique_ptr<const ModalDamping> ModalDamping::of(const model::System& system) {
  const model::Damping& damping = system.damping;
  if (!damping.is_modal()) return nullptr;
  const Index count = count_modes(system);
  // One mode more than a list has may share the frequency of its last one.
  const Modes modes = modes_to_damp(system, damping.lowest_modes.empty() ? count : std::min(count + 1, system.size()));
  if (!damping.lowest_modes.empty()) check_listed(damping, modes);
  Eigen::MatrixXd shapes(system.size(), count);
  Index damped = 0;
  for (Index i = 0; i < count; ++i) {
    const double zeta =
        damping.every_mode != 0.0 ? damping.every_mode : damping.lowest_modes[static_cast<std::size_t>(i)];
    const double rate = 2.0 * zeta * modes.frequencies[i];
    if (rate > 0.0) shapes.col(damped++) = std::sqrt(rate) * modes.shapes.col(i);
  }
  if (damped == 0) return nullptr;
  return std::unique_ptr<const ModalDamping>(new ModalDamping(system, shapes.leftCols(damped)));
}

ModalDamping::ModalDamping(const model::System& system, const Eigen::MatrixXd& shapes)
    : shapes_(shapes), matrix_(system.mass * shapes), modal_(Vector::Zero(shapes.cols())) {}

void ModalDamping::add_force(ConstVectorRef v, VectorRef y) const {
  modal_.noalias() = factor().transpose() * v;
  y.noalias() += factor() * modal_;
}

void ModalDamping::subtract_deceleration(ConstVectorRef v, VectorRef a) const {
  modal_.noalias() = factor().transpose() * v;
  a.noalias() -= shapes_ * modal_;
}

}  // namespace butee::dynamics
