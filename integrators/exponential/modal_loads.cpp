#include "integrators/exponential/modal_loads.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/dynamics/load_parabola.hpp"
#include "integrators/exponential/varying_forces.hpp"

namespace butee::integrators {
namespace {

/// The amplitude of each mode's steady displacement, relative to the shape, under a harmonic load: the largest of any
/// DOF that takes part in the mode. The responses of z to both senses of rotation cancel where the load is faster than
/// the mode: z of rigid motion contains its speed, many times its displacement.
Eigen::ArrayXd steady_displacement(const dynamics::DampedModes& modes, const HarmonicLoad& load) {
  constexpr double kTakesPart = 1e-3;
  using Complex = std::complex<double>;
  const Index p = modes.count();
  const Eigen::MatrixXd& shapes = modes.displacement();
  Eigen::ArrayXd steady = Eigen::ArrayXd::Zero(p);
  for (Index k = 0; k < p; ++k) {
    const Complex lambda(modes.decay()[k], modes.turn()[k]), turn(0.0, load.angular_frequency),
        cosine(load.cosine[k], load.cosine[p + k]), sine(load.sine[k], load.sine[p + k]), i(0.0, 1.0);
    const Complex forwards = 0.5 * (cosine - i * sine) / (turn - lambda),
                  backwards = 0.5 * (cosine + i * sine) / (-turn - lambda);
    const Eigen::ArrayXd size = (shapes.row(k).array().square() + shapes.row(p + k).array().square()).sqrt();
    const double least = kTakesPart * size.maxCoeff();
    for (Index dof = 0; dof < size.size(); ++dof) {
      if (!(size[dof] > least)) continue;
      const Complex shape(shapes(k, dof), -shapes(p + k, dof));
      const double amplitude = std::abs(shape * forwards + std::conj(shape * backwards)) / size[dof];
      // At resonance there is no steady motion.
      steady[k] = std::isfinite(amplitude) ? std::max(steady[k], amplitude) : std::numeric_limits<double>::infinity();
      if (std::isinf(steady[k])) break;
    }
  }
  return steady;
}

}  // namespace

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
  for (const HarmonicLoad& load : harmonic_) {
    const Eigen::ArrayXd steady = steady_displacement(modes, load);
    for (const double sense : {1.0, -1.0}) {
      // The coefficient of e^(i sense Omega t), (cosine - i sense sine)/2
      const Eigen::ArrayXd re = 0.5 * (load.cosine.head(p) + sense * load.sine.tail(p)),
                           im = 0.5 * (load.cosine.tail(p) - sense * load.sine.head(p));
      responses_.push_back({std::abs(load.angular_frequency), (re.square() + im.square()).sqrt(),
                            (modes.decay().square() + (sense * load.angular_frequency - modes.turn()).square()).rsqrt(),
                            0.5 * steady});
    }
  }
}

void ModalLoads::add_harmonic(const model::Harmonic& harmonic, const Eigen::VectorXd& shape) {
  auto same = std::find_if(harmonic_.begin(), harmonic_.end(), [&](const HarmonicLoad& other) {
    return other.angular_frequency == harmonic.angular_frequency;
  });
  if (same == harmonic_.end())
    same = harmonic_.insert(
        same, {harmonic.angular_frequency, Eigen::VectorXd::Zero(shape.size()), Eigen::VectorXd::Zero(shape.size())});
  same->cosine += harmonic.amplitude * std::cos(harmonic.phase) * shape;
  same->sine -= harmonic.amplitude * std::sin(harmonic.phase) * shape;
}

double ModalLoads::highest_frequency() const {
  double highest = 0.0;
  for (const HarmonicLoad& load : harmonic_) highest = std::max(highest, std::abs(load.angular_frequency));
  return highest;
}

ModalLoads::Resolution ModalLoads::resolution(double h, const Eigen::ArrayXd& reach) const {
  Resolution all;
  for (const Response& response : responses_) {
    // Near resonance the response is limited to its growth within one step.
    const double missed = StepNodes::missed_part(response.angular_frequency * h);
    const Eigen::ArrayXd amplitude = reach * response.force * response.slowness.min(h);
    all.missed += missed * amplitude.min(reach * response.displacement).sum();
    all.reached = std::max(all.reached, (amplitude * (modes_.speed() * h).min(1.0)).maxCoeff());
  }
  return all;
}

const Eigen::MatrixXd& ModalLoads::polynomial(double t, double h) {
  polynomial_.setZero();
  for (const Other& load : others_) {
    const dynamics::LoadParabola f(*load.in_time, t, t + h);
    StepNodes::Row values;
    for (Index j = 0; j < StepNodes::kCount; ++j) values[j] = f.at(StepNodes::kPlaces[static_cast<std::size_t>(j)]);
    polynomial_.noalias() += load.shape * (values * StepNodes::with_middle());
  }
  return polynomial_;
}

void ModalLoads::add_harmonic_rate(double t, Eigen::VectorXd& rate) const {
  for (const HarmonicLoad& load : harmonic_) {
    const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
    rate += c * load.cosine + s * load.sine;
  }
}

}  // namespace butee::integrators
