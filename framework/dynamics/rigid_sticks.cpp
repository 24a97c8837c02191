#include "butee/dynamics/rigid_sticks.hpp"

#include <Eigen/Cholesky>

namespace butee::dynamics {

bool RigidSticks::prepare(linalg::LinearSolver& mass) {
  std::vector<Index> sticks = obstacles_.rigid_sticks();
  if (sticks.empty() || sticks == contacts_) return !sticks.empty();
  const auto count = static_cast<Index>(sticks.size());
  contacts_ = std::move(sticks);
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
  return true;
}

void RigidSticks::solve(VectorRef y) {
  force_ = Eigen::LLT<Eigen::MatrixXd>(compliance_).solve(force_).eval();
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
    force_[i] = -obstacles_.forces(contacts_[static_cast<std::size_t>(i)], t, v, v).slip_speed;
  solve(v);
}

}  // namespace butee::dynamics
