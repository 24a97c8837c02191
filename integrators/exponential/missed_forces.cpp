#include "integrators/exponential/missed_forces.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

using Eigen::ArrayXd;

MissedForces::MissedForces(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts,
                           ComponentSpeeds& speeds)
    : modal_(modal),
      contacts_(contacts),
      speeds_(speeds),
      rates_((modal.frequencies().square() + 4.0 * modal.decay().square()).sqrt()),
      impulse_(rates_),
      cubic_(rates_),
      quartic_(rates_),
      stops_(contacts.size()),
      least_(Vector::Zero(modal.shape_rows().cols())),
      weights_(rates_),
      of_impulse_(rates_),
      of_rest_(rates_) {}

void MissedForces::begin() {
  for (Stop& stop : stops_) stop.counts = false;
  least_.setZero();
  are_known_ = false;
}

void MissedForces::attempt() {
  impulse_.setZero();
  cubic_.setZero();
  quartic_.setZero();
}

void MissedForces::add(Index stop, const ContactPath& path, double speed, double impulse) {
  const auto shape = modal_.stop_shapes().of(stop).array();
  const auto [cubic, quartic] = contacts_[static_cast<std::size_t>(stop)].missed(path);
  impulse_ += impulse * shape;
  cubic_ += cubic * shape;
  quartic_ += quartic * shape;
  if (!stops_[static_cast<std::size_t>(stop)].counts) expect(stop, speed);
}

void MissedForces::expect(Index stop, double speed) {
  constexpr double kLeastExpected = 1e-3;
  Stop& of = stops_[static_cast<std::size_t>(stop)];
  if (speed == 0.0) return;
  of.counts = true;
  if (const bool is_bounded = contacts_[static_cast<std::size_t>(stop)].is_bounded();
      of.speed == 0.0 || (!is_bounded && (speed > of.speed || speed <= 0.5 * of.speed))) {
    of.speed = std::exp2(std::ceil(std::log2(speed)));
    find_response(stop, of.speed);
  }
  least_ = least_.cwiseMax(kLeastExpected * speed * of.response);
  are_known_ = false;
}

void MissedForces::find_response(Index stop, double speed) {
  constexpr int kPasses = 4;
  Stop& of = stops_[static_cast<std::size_t>(stop)];
  const auto shape = modal_.stop_shapes().of(stop).array();
  const ContactForce& contact = contacts_[static_cast<std::size_t>(stop)];
  const double compliance = shape.matrix().squaredNorm();
  double rate = std::sqrt(contact.stiffness() * compliance);
  // The stiffness of a power law is that at its largest penetration.
  for (int pass = 0; pass < kPasses && !contact.is_bounded() && rate > 0.0; ++pass)
    rate = std::sqrt(contact.tangent_behind(speed / rate) * compliance);
  const ArrayXd modes = shape / (1.0 + (rates_ / rate).square());
  const double own = (shape * modes).sum();
  of.response.resize(least_.size());
  for (Index d = 0; d < of.response.size(); ++d)
    of.response[d] = own > 0.0 ? (modal_.shape_rows().col(d).array() * modes).matrix().norm() / own : 0.0;
}

void MissedForces::find_weights() {
  weights_.setZero();
  for (Index d = 0; d < least_.size(); ++d)
    if (const double scale = std::max(speeds_.largest()[d], least_[d]); scale > 0.0)
      weights_ = weights_.max(modal_.shape_rows().col(d).array().abs() / scale);
  are_known_ = true;
}

double MissedForces::error(double h, const ArrayXd& v, double enough) {
  if (h != received_h_) {
    of_impulse_ = (h * rates_).unaryExpr([](double x) { return received_impulse(x); });
    of_rest_ = h * (h * rates_).unaryExpr([](double x) { return unresolved_rest(x); });
    received_h_ = h;
  }
  const auto error = [this] {
    if (!are_known_) find_weights();
    return (weights_.square() *
            ((impulse_ * of_impulse_).square() + (cubic_.square() + quartic_.square()) * of_rest_.square()))
        .sum();
  };
  if (const double square = error(); square <= enough * enough) return std::sqrt(square);
  speeds_.raise(v);
  are_known_ = false;
  return std::sqrt(error());
}

}  // namespace butee::integrators
