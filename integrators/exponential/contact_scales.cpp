#include "integrators/exponential/contact_scales.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

using Eigen::ArrayXd;

namespace {
/// replaces a displacement scale of zero, m
constexpr double kTiny = 1e-300;
}  // namespace

double contact_frequency(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact) {
  const Vector stiffness = contact.closed_stiffness();
  double square = 0.0;
  for (Index i = 0; i < modal.stop_count(); ++i)
    square = std::max(square, stiffness[i] * modal.stop_shapes().of(i).squaredNorm());
  return std::sqrt(square);
}

ContactScales::ContactScales(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact)
    : modal_(modal), rounding_rate_(kLeastSpeed * contact_frequency(modal, contact)) {
  for (ArrayXd* array : {&w_, &wv_}) array->setZero(dynamics::ContactPropagator::padded(contact.size()));
  for (Index i = 0; i < contact.size(); ++i) {
    pair_of_.push_back(-1);
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a < 0 || b < 0) continue;
    pair_of_.back() = static_cast<Index>(pairs_.size());
    const auto shape = modal_.stop_shapes().of(i);
    const auto share_of = [&](Index dof) {
      return std::abs(modal_.shape_rows().col(dof).dot(shape)) / shape.squaredNorm();
    };
    pairs_.push_back({i, modal_.shape_rows().col(a), share_of(a), share_of(b)});
  }
  pair_scales_.resize(pairs_.size());
}

void ContactScales::start(const double* q, const double* v, const double* w, double* memory) const {
  const Index n = modal_.size(), m = modal_.stop_count();
  Eigen::Map<ArrayXd>(memory, 2 * m) = Eigen::Map<const ArrayXd>(w, 2 * m).abs();
  double* to = memory + 2 * m;
  for (const Pair& pair : pairs_) {
    const double x_a = pair.shape_a.dot(Eigen::Map<const Vector>(q, n)),
                 v_a = pair.shape_a.dot(Eigen::Map<const Vector>(v, n));
    for (const double value : {x_a, x_a - w[pair.stop], v_a, v_a - w[m + pair.stop]}) *to++ = std::abs(value);
  }
}

void ContactScales::load(const double* memory, ContactScale largest) {
  const Index m = modal_.stop_count();
  largest_ = largest;
  w_.head(m) = Eigen::Map<const ArrayXd>(memory, m);
  wv_.head(m) = Eigen::Map<const ArrayXd>(memory + m, m);
  const double* from = memory + 2 * m;
  for (PairScale& of : pair_scales_) {
    of = {from[0], from[1], from[2], from[3]};
    from += 4;
  }
}

void ContactScales::save(double* memory) const {
  const Index m = modal_.stop_count();
  Eigen::Map<ArrayXd>(memory, m) = w_.head(m);
  Eigen::Map<ArrayXd>(memory + m, m) = wv_.head(m);
  double* to = memory + 2 * m;
  for (const PairScale& scale : pair_scales_)
    for (const double value : {scale.x_a, scale.x_b, scale.v_a, scale.v_b}) *to++ = value;
}

void ContactScales::raise(const ModalState& to) {
  w_ = w_.max(to.w.abs());
  wv_ = wv_.max(to.wv.abs());
  for (std::size_t j = 0; j < pairs_.size(); ++j) {
    const Pair& pair = pairs_[j];
    PairScale& scale = pair_scales_[j];
    const double x = pair.shape_a.dot(to.q.matrix()), v = pair.shape_a.dot(to.v.matrix());
    scale.x_a = std::max(scale.x_a, std::abs(x));
    scale.x_b = std::max(scale.x_b, std::abs(x - to.w[pair.stop]));
    scale.v_a = std::max(scale.v_a, std::abs(v));
    scale.v_b = std::max(scale.v_b, std::abs(v - to.wv[pair.stop]));
  }
}

void ContactScales::find_shares(const ArrayXd& w_end, double displacement, ArrayXd& shares) const {
  const double largest = std::max(displacement, kTiny);
  shares = (w_.max(w_end.abs()) / largest).max(kFloor);
  for (const Pair& pair : pairs_)
    shares[pair.stop] = std::min(shares[pair.stop], of(pair.stop, {}, largest).displacement / largest);
}

ContactScale ContactScales::of(Index stop, ContactScale reached, double displacement) const {
  // At a start from rest the step under trial has the largest speed so far.
  const double x_floor = kFloor * displacement, v_floor = kFloor * std::max(largest_.speed, reached.speed);
  if (const Index place = pair_of_[static_cast<std::size_t>(stop)]; place >= 0) {
    const Pair& pair = pairs_[static_cast<std::size_t>(place)];
    const PairScale& scale = pair_scales_[static_cast<std::size_t>(place)];
    return {std::min(std::max(scale.x_a, x_floor) / pair.share_a, std::max(scale.x_b, x_floor) / pair.share_b),
            std::min(std::max(scale.v_a, v_floor) / pair.share_a, std::max(scale.v_b, v_floor) / pair.share_b)};
  }
  return {std::max({w_[stop], reached.displacement, x_floor}), std::max({wv_[stop], reached.speed, v_floor})};
}

}  // namespace butee::integrators
