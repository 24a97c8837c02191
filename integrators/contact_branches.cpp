#include "integrators/contact_branches.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

constexpr int kNone = 2;
/// The border g = 0 of a smooth law, in addition to w = 0 (0) and the borders of a linear law (+1,
/// -1).
constexpr int kBend = 3;
/// At this distance from a border, relative to the gap and to the motion of a piece, rounding hides
/// the side; the direction of the motion determines it.
constexpr double kOnBorder = 1e-14;

}  // namespace

ContactBranches::ContactBranches(const dynamics::ElasticStops& contact, int order)
    : contact_(contact), branches_(static_cast<std::size_t>(contact.size())), root_(order) {
  const auto terms = static_cast<std::size_t>(order) + 1;
  polynomial_.resize(terms);
  for (Index i = 0; i < contact.size(); ++i) {
    const model::ContactLaw& law = contact.law_of(i);
    series_.push_back(law.is_piecewise_linear() ? nullptr : law.force_series());
    if (!law.is_piecewise_linear() && series_.back() == nullptr)
      throw InputError(
          "integrator.type: exact needs stops whose law is piecewise linear or gives its Taylor series; "
          "take law = \"linear\" or \"arctan\"");
    gap_.push_back(contact.play_of(i).gap);
    penetration_.emplace_back();
    penetration_.back().reserve(series_.back() ? terms : 0);
  }
}

void ContactBranches::place(ConstVectorRef w) {
  for (Index i = 0; i < w.size(); ++i) {
    Branch& branch = branches_[static_cast<std::size_t>(i)];
    const double gap = gap_[static_cast<std::size_t>(i)];
    const double side = contact_.play_of(i).side(w[i]);
    branch = {Status::open, side, kNone};
    if (series_[static_cast<std::size_t>(i)]) {
      branch.status = side == 0.0 ? Status::undecided : Status::smooth;
    } else if (side == 0.0 ? gap == 0.0 : side * w[i] == gap) {
      branch.status = Status::undecided;
    } else if (side * w[i] > gap) {
      branch.status = Status::closed;
    }
  }
}

bool ContactBranches::any_undecided() const {
  return std::any_of(branches_.begin(), branches_.end(),
                     [](const Branch& branch) { return branch.status == Status::undecided; });
}

void ContactBranches::decide(const Eigen::MatrixXd& w) {
  for (Index i = 0; i < w.rows(); ++i) {
    Branch& branch = branches_[static_cast<std::size_t>(i)];
    if (branch.status != Status::undecided) continue;
    double direction = 0.0;
    for (Index k = 1; k < w.cols() && direction == 0.0; ++k) direction = w(i, k);
    const double side = direction > 0.0 ? 1.0 : -1.0;
    const bool on_both = branch.side == 0.0;  // at w = 0, from where either side may follow
    if (direction == 0.0) {
      branch.status = Status::open;
    } else if (series_[static_cast<std::size_t>(i)]) {
      branch = {Status::smooth, side, 0};
    } else if (on_both || side == branch.side) {
      branch = {Status::closed, side, static_cast<int>(side)};
    } else {
      branch = {Status::open, branch.side, static_cast<int>(branch.side)};
    }
  }
}

void ContactBranches::force(const Eigen::MatrixXd& w, Index k, VectorRef f) {
  for (Index i = 0; i < f.size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    const Branch& branch = branches_[place];
    f[i] = 0.0;
    if (branch.status == Status::open || branch.status == Status::undecided) continue;
    const double g = branch.side * w(i, k) - (k == 0 ? gap_[place] : 0.0);
    if (branch.status == Status::closed) {
      f[i] = -branch.side * contact_.law_of(i).closed_stiffness() * g;
      continue;
    }
    std::vector<double>& penetration = penetration_[place];
    if (k == 0) penetration.clear();
    penetration.push_back(g);
    f[i] = -branch.side * series_[place]->next(penetration);
  }
}

void ContactBranches::watch(const Eigen::MatrixXd& w, Index stop, int border, double factor, double offset,
                            double until, std::optional<Change>& first) {
  polynomial_[0] = offset + factor * w(stop, 0);
  double power = until, others = 0.0;
  for (Index k = 1; k < w.cols(); ++k, power *= until) {
    polynomial_[static_cast<std::size_t>(k)] = factor * w(stop, k) * power;
    others += std::abs(polynomial_[static_cast<std::size_t>(k)]);
  }
  if (polynomial_[0] > others) return;
  const bool just_crossed = branches_[static_cast<std::size_t>(stop)].crossed == border;
  if (just_crossed || std::abs(polynomial_[0]) <= kOnBorder * (std::abs(offset) + others)) polynomial_[0] = 0.0;
  const auto leading = std::find_if(polynomial_.begin(), polynomial_.end(), [](double c) { return c != 0.0; });
  if (leading == polynomial_.end()) return;
  if (*leading < 0.0) {
    first = Change{0.0, stop, border};
    return;
  }
  const auto root = root_.first(polynomial_);
  if (root && (!first || *root * until < first->at)) first = Change{*root * until, stop, border};
}

void ContactBranches::watch_bend(const Eigen::MatrixXd& w, Index stop, double until, std::optional<Change>& first) {
  const Branch& branch = branches_[static_cast<std::size_t>(stop)];
  const double gap = gap_[static_cast<std::size_t>(stop)], side = branch.side;
  double moves = 0.0, power = until, direction = 0.0;
  for (Index k = 1; k < w.cols(); ++k, power *= until) {
    moves += std::abs(w(stop, k)) * power;
    if (direction == 0.0) direction = side * w(stop, k);
  }
  const double g = side * w(stop, 0) - gap;
  const bool is_on_it = branch.crossed == kBend || std::abs(g) <= kOnBorder * (gap + moves);
  // On the border, the direction of the motion determines the side.
  const double where = (is_on_it ? direction : g) < 0.0 ? -1.0 : 1.0;
  watch(w, stop, kBend, where * side, -where * gap, until, first);
}

std::optional<ContactBranches::Change> ContactBranches::first_change(const Eigen::MatrixXd& w, double until) {
  std::optional<Change> first;
  for (Index i = 0; i < w.rows(); ++i) {
    const Branch& branch = branches_[static_cast<std::size_t>(i)];
    const double gap = gap_[static_cast<std::size_t>(i)];
    switch (branch.status) {
      case Status::smooth:
        if (contact_.play_of(i).has_both()) watch(w, i, 0, branch.side, 0.0, until, first);
        watch_bend(w, i, until, first);
        break;
      case Status::closed:
        watch(w, i, static_cast<int>(branch.side), branch.side, -gap, until, first);
        break;
      case Status::open:
        if (contact_.play_of(i).has_side(1.0)) watch(w, i, 1, -1.0, gap, until, first);
        if (contact_.play_of(i).has_side(-1.0)) watch(w, i, -1, 1.0, gap, until, first);
        break;
      case Status::undecided:
        break;
    }
  }
  return first;
}

void ContactBranches::apply(const Change& change) {
  for (Branch& branch : branches_) branch.crossed = kNone;
  Branch& branch = branches_[static_cast<std::size_t>(change.stop)];
  branch.crossed = change.border;
  if (change.border == kBend) return;
  if (branch.status == Status::smooth) {
    branch.side = -branch.side;
  } else if (branch.status == Status::open) {
    branch.status = Status::closed;
    branch.side = change.border;
  } else if (gap_[static_cast<std::size_t>(change.stop)] == 0.0 && contact_.play_of(change.stop).has_both()) {
    branch.side = -branch.side;
    branch.crossed = -change.border;
  } else {
    branch.status = Status::open;
  }
}

}  // namespace butee::integrators
