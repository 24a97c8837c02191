#include "integrators/exponential/modal_energy.hpp"

#include "butee/dynamics/load_parabola.hpp"

namespace butee::integrators {
namespace {

using Eigen::ArrayXd;
using Column = Eigen::Map<const ArrayXd>;

}  // namespace

ModalEnergy::ModalEnergy(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal)
    : dynamics_(dynamics),
      modal_(modal),
      double_decay_(2.0 * modal.decay()),
      has_decay_((double_decay_ != 0.0).any()),
      paths_(2 * modal.harmonics().size() + modal.other_loads().size()),
      next_paths_(paths_) {}

void ModalEnergy::begin(const Breakpoint& point, std::span<const double> instants) {
  keep(point);
  instants_ = instants;
  work_ = dissipated_ = 0.0;
  told_.clear();
  find_paths(point, paths_);
}

void ModalEnergy::keep(const Breakpoint& point) {
  last_t_ = point.t;
  last_q_ = Column(point.q, modal_.size());
  last_v_ = Column(point.v, modal_.size());
  last_phases_.assign(point.phases.begin(), point.phases.end());
}

void ModalEnergy::find_paths(const Breakpoint& point, std::vector<Path>& paths) const {
  const Column q(point.q, modal_.size()), v(point.v, modal_.size());
  auto path = paths.begin();
  const auto look = [&](const ArrayXd& shape) { *path++ = {(shape * q).sum(), (shape * v).sum()}; };
  for (const dynamics::ModalHarmonic& harmonic : modal_.harmonics()) {
    look(harmonic.cosine);
    look(harmonic.sine);
  }
  for (const dynamics::ModalSystem::OtherLoad& load : modal_.other_loads()) look(load.shape);
}

void ModalEnergy::go_on(const Breakpoint& point, const double* w, bool is_last) {
  find_paths(point, next_paths_);
  add_work(point);
  if (has_decay_) add_dissipation(point);
  paths_.swap(next_paths_);
  keep(point);
  bool is_due = is_last;
  for (; !instants_.empty() && instants_.front() <= point.t; instants_ = instants_.subspan(1)) is_due = true;
  if (!is_due) return;
  const Column q(point.q, modal_.size()), v(point.v, modal_.size());
  const Index stops = dynamics_.stop_count();
  const double contact = stops > 0 ? dynamics_.stops().energy(Eigen::Map<const Vector>(w, stops)) : 0.0;
  told_.push_back(
      {point.t, 0.5 * v.square().sum(), 0.5 * (modal_.frequencies() * q).square().sum(), contact, work_, dissipated_});
}

void ModalEnergy::add_work(const Breakpoint& to) {
  const double h = to.t - last_t_;
  auto from = paths_.begin(), end = next_paths_.begin();
  // Simpson's rule for f v with the values of both cubics in the middle.
  const auto add = [&](double f0, double f_middle, double f1) {
    const double v_middle = 1.5 / h * (end->u - from->u) - 0.25 * (from->v + end->v);
    work_ += h / 6.0 * (f0 * from->v + 4.0 * f_middle * v_middle + f1 * end->v);
    ++from, ++end;
  };
  for (std::size_t j = 0; j < modal_.harmonics().size(); ++j) {
    const double turn = 0.125 * h * modal_.harmonics()[j].angular_frequency;
    const auto [c0, s0] = last_phases_[j];
    const auto [c1, s1] = to.phases[j];
    add(c0, 0.5 * (c0 + c1) - turn * (s0 - s1), c1);
    add(s0, 0.5 * (s0 + s1) + turn * (c0 - c1), s1);
  }
  for (const dynamics::ModalSystem::OtherLoad& load : modal_.other_loads()) {
    const dynamics::LoadParabola f(*load.in_time, last_t_, to.t);
    add(f.begin, f.middle, f.end);
  }
}

void ModalEnergy::add_dissipation(const Breakpoint& to) {
  const double h = to.t - last_t_, r = 1.0 / h;
  const ArrayXd &q0 = last_q_, &v0 = last_v_;
  const Column q1(to.q, modal_.size()), v1(to.v, modal_.size());
  // The integral of the squared slope of a cubic, as in the geometric stiffness of a beam.
  const auto rise = r * (q1 - q0);
  dissipated_ += h / 30.0 *
                 (double_decay_ *
                  (36.0 * rise.square() - 6.0 * rise * (v0 + v1) + 4.0 * (v0.square() + v1.square()) - 2.0 * v0 * v1))
                     .sum();
}

}  // namespace butee::integrators
