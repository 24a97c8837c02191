#include "integrators/exponential/modal_loads.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "integrators/exponential/load_parabola.hpp"
#include "integrators/exponential/varying_forces.hpp"

namespace butee::integrators {

ModalLoads::ModalLoads(const dynamics::DampedModes& modes, const model::System& system) : modes_(modes) {
  for (const model::FreeLoad& load : system.loads) {
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(2 * modes.count());
    for (std::size_t i = 0; i < load.dofs.size(); ++i) shape += load.weights[i] * modes.input().col(load.dofs[i]);
    if (const auto harmonic = load.in_time->harmonic())
      add_harmonic(*harmonic, shape);
    else if (load.in_time->is_piecewise_parabolic())
      others_.push_back({load.in_time, std::move(shape)});
    else if (!VaryingForces::contains(load))
      throw InputError(
          "integrator.type: a load (or the force of a moving [base], whose displacement is the double integral of its "
          "acceleration) is neither harmonic nor made of straight lines or parabolas in time, which this method needs");
  }
  polynomial_.setZero(2 * modes.count(), StepNodes::kCount);
  const Index p = modes.count();
  for (const TurningLoad& load : turning_)
    for (const double sense : {1.0, -1.0}) {
      const Eigen::VectorXd& force = sense > 0.0 ? load.forth : load.back;
      responses_.push_back(
          {std::abs(load.angular_frequency), (force.head(p).array().square() + force.tail(p).array().square()).sqrt(),
           (modes.decay().square() + (sense * load.angular_frequency - modes.turn()).square()).rsqrt()});
    }
}

void ModalLoads::add_harmonic(const model::Harmonic& harmonic, const Eigen::VectorXd& shape) {
  const Index p = shape.size() / 2;
  auto same = std::find_if(turning_.begin(), turning_.end(), [&](const TurningLoad& other) {
    return other.angular_frequency == harmonic.angular_frequency;
  });
  if (same == turning_.end())
    same =
        turning_.insert(same, {harmonic.angular_frequency, Eigen::VectorXd::Zero(2 * p), Eigen::VectorXd::Zero(2 * p)});
  const double c = 0.5 * harmonic.amplitude * std::cos(harmonic.phase),
               s = 0.5 * harmonic.amplitude * std::sin(harmonic.phase);
  const auto add = [&](Eigen::VectorXd& factor, double sine) {
    factor.head(p) += c * shape.head(p) - sine * shape.tail(p);
    factor.tail(p) += c * shape.tail(p) + sine * shape.head(p);
  };
  add(same->forth, s);
  add(same->back, -s);
}

double ModalLoads::highest_frequency() const {
  double highest = 0.0;
  for (const TurningLoad& load : turning_) highest = std::max(highest, std::abs(load.angular_frequency));
  return highest;
}

ModalLoads::Resolution ModalLoads::resolution(double h, const Eigen::ArrayXd& reach) const {
  Resolution all;
  for (const Response& response : responses_) {
    // Near resonance the response is limited to its growth within one step.
    const double missed = StepNodes::missed_part(response.angular_frequency * h);
    const auto amplitude = reach * response.force * response.slowness.min(h);
    all.missed += missed * amplitude.sum();
    all.reached = std::max(all.reached, (amplitude * (modes_.speed() * h).min(1.0)).maxCoeff());
  }
  return all;
}

const Eigen::MatrixXd& ModalLoads::polynomial(double t, double h) {
  polynomial_.setZero();
  for (const Other& load : others_) {
    const LoadParabola f(*load.in_time, t, t + h);
    StepNodes::Row values;
    for (Index j = 0; j < StepNodes::kCount; ++j) values[j] = f.at(StepNodes::kPlaces[static_cast<std::size_t>(j)]);
    polynomial_.noalias() += load.shape * (values * StepNodes::with_middle());
  }
  return polynomial_;
}

void ModalLoads::add_turning(double t, Eigen::VectorXd& rate) const {
  const Index p = rate.size() / 2;
  for (const TurningLoad& load : turning_) {
    const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
    rate.head(p) += c * (load.forth.head(p) + load.back.head(p)) - s * (load.forth.tail(p) - load.back.tail(p));
    rate.tail(p) += c * (load.forth.tail(p) + load.back.tail(p)) + s * (load.forth.head(p) - load.back.head(p));
  }
}

}  // namespace butee::integrators
