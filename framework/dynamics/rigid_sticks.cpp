#include "butee/dynamics/rigid_sticks.hpp"

#include <Eigen/QR>

#include "butee/core/error.hpp"

namespace butee::dynamics {
namespace {

/// Rows are dependent if the part of one that is independent of the others is smaller than this fraction of it.
constexpr double kDependent = 1e-10;
const char* const kRemedy =
    " holds only what other contacts with stick = \"rigid\" hold, so that their forces are not determined; combine "
    "supports that hold the same motion into one with the sum of their normal forces, or take stick_stiffness";

}  // namespace

void RigidSticks::check_supports(linalg::LinearSolver& mass) {
  contacts_.clear();
  for (Index i = 0; i < obstacles_.size(); ++i) {
    const model::ObstacleGroup& group = obstacles_.group_of(i);
    if (group.shape == nullptr && group.friction.rule == model::Friction::Rule::rigid) contacts_.push_back(i);
  }
  if (contacts_.empty()) return;
  assemble(mass);
  if (const std::string name = redundant(); !name.empty()) throw InputError("the friction at " + name + kRemedy);
}

std::string RigidSticks::redundant() const {
  const Vector scale = compliance_.diagonal().cwiseSqrt().cwiseInverse();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> parts(scale.asDiagonal() * compliance_ * scale.asDiagonal());
  parts.setThreshold(kDependent);
  if (parts.rank() == compliance_.rows()) return "";
  const Index last = parts.colsPermutation().indices()[compliance_.rows() - 1];
  return obstacles_.name_of(contacts_[static_cast<std::size_t>(last)]);
}

bool RigidSticks::prepare(linalg::LinearSolver& mass) {
  std::vector<Index> sticks = obstacles_.rigid_sticks();
  if (sticks.empty() || sticks == contacts_) return !sticks.empty();
  contacts_ = std::move(sticks);
  assemble(mass);
  if (const std::string name = redundant(); !name.empty()) throw RunError("the friction at " + name + kRemedy);
  return true;
}

void RigidSticks::assemble(linalg::LinearSolver& mass) {
  const auto count = static_cast<Index>(contacts_.size());
  motion_ = Eigen::MatrixXd::Zero(obstacles_.system_size(), count);
  compliance_.resize(count, count);
  for (Index j = 0; j < count; ++j) {
    const Index contact = contacts_[static_cast<std::size_t>(j)];
    obstacles_.scatter(contact, obstacles_.tangent_of(contact), motion_.col(j));
    mass.solve(motion_.col(j));
  }
  for (Index i = 0; i < count; ++i) {
    const Index contact = contacts_[static_cast<std::size_t>(i)];
    for (Index j = 0; j < count; ++j)
      compliance_(i, j) = obstacles_.tangent_of(contact).dot(obstacles_.gather(contact, motion_.col(j)));
  }
  factor_.compute(compliance_);
}

void RigidSticks::solve(VectorRef y) {
  factor_.solveInPlace(force_);
  y += motion_ * force_;
}

void RigidSticks::hold(std::optional<double> t, linalg::LinearSolver& mass, VectorRef a) {
  if (!obstacles_.has_rigid_friction() || !prepare(mass)) return;
  force_.resize(static_cast<Index>(contacts_.size()));
  for (Index i = 0; i < force_.size(); ++i) {
    const Index contact = contacts_[static_cast<std::size_t>(i)];
    force_[i] = -obstacles_.tangent_of(contact).dot(obstacles_.gather(contact, a));
    if (t) force_[i] -= obstacles_.surface_acceleration(contact, *t);
  }
  solve(a);
}

void RigidSticks::stop(double t, linalg::LinearSolver& mass, VectorRef v) {
  if (!prepare(mass)) return;
  force_.resize(static_cast<Index>(contacts_.size()));
  for (Index i = 0; i < force_.size(); ++i)
    // Only v enters the slip of a straight contact.
    force_[i] = -obstacles_.forces(contacts_[static_cast<std::size_t>(i)], t, v, v).slip_speed;
  solve(v);
}

}  // namespace butee::dynamics
