#include <algorithm>

#include "integrators/piecewise_motion.hpp"

namespace butee::integrators {

template <class Jump, class Propagate>
void PiecewiseMotion::follow_pieces(const time::State& from, const time::State& to, Jump jump, Propagate propagate) {
  recall(from, to);
  const std::size_t m = status_.size();
  std::vector<StopStatus> before(m), after(m);
  const auto change = [&] {
    for (std::size_t i = 0; i < m; ++i)
      if (system_.stops[i].damping > 0.0 && is_closed(before[i]) != is_closed(after[i]) &&
          (before[i] == kOpen || after[i] == kOpen))
        jump(static_cast<Index>(i), is_closed(after[i]) ? 1.0 : -1.0);
    before = after;
  };
  for (std::size_t i = 0; i < m; ++i) before[i] = static_cast<StopStatus>(from.memory[static_cast<Index>(i)]);
  for (std::size_t piece = 0; piece < begins_.size(); ++piece) {
    std::copy_n(begin_status_.begin() + static_cast<std::ptrdiff_t>(piece * m), m, after.begin());
    change();
    load_piece(piece);
    propagate((piece + 1 < begins_.size() ? begins_[piece + 1] : end_t_) - begins_[piece]);
  }
  for (std::size_t i = 0; i < m; ++i) after[i] = static_cast<StopStatus>(to.memory[static_cast<Index>(i)]);
  change();
}

Vector PiecewiseMotion::jump_of(Index i) const {
  const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
  LongVector force = LongVector::Zero(system_.size());
  if (stop.a >= 0) force[stop.a] += stop.damping;
  if (stop.b >= 0) force[stop.b] -= stop.damping;
  return system_.mass.ldlt().solve(force).cast<double>();
}

Eigen::MatrixXd PiecewiseMotion::derivative(const time::State& from, const time::State& to) {
  const Index n = system_.size();
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  follow_pieces(
      from, to,
      [&](Index i, double sign) {
        const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
        Eigen::RowVectorXd w = Eigen::RowVectorXd::Zero(2 * n);
        if (stop.a >= 0) w += product.row(stop.a);
        if (stop.b >= 0) w -= product.row(stop.b);
        product.bottomRows(n) -= sign * jump_of(i) * w;
      },
      [&](double s) { product = flow_->propagator(s) * product; });
  return product;
}

Vector PiecewiseMotion::derivative_by_loads(const time::State& from, const time::State& to) {
  const Index n = system_.size();
  Vector by_loads = Vector::Zero(2 * n);
  ContactStateFlow::Piece response;
  Eigen::MatrixXd force(n + system_.stop_count(), 3);
  follow_pieces(
      from, to,
      [&](Index i, double sign) {
        const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
        by_loads.tail(n) -= sign * stop.displacement(by_loads.data()) * jump_of(i);
      },
      [&](double s) {
        force.setZero();
        const bool has_force = system_.add_polynomials(piece_.t, force);
        flow_->begin(piece_.t, by_loads.data(), by_loads.data() + n, force, has_force,
                     next_discontinuity(piece_.t) - piece_.t, response);
        flow_->go(response, s);
        for (Index i = 0; i < n; ++i) {
          const Jet jet = flow_->dof(response, i);
          by_loads[i] = jet[0];
          by_loads[n + i] = jet[1];
        }
      });
  return by_loads;
}

}  // namespace butee::integrators
