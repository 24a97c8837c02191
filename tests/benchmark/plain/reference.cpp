#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plain.hpp"

namespace plain {
namespace {

using Real = long double;

constexpr int kOrder = 26;
constexpr Real kReach = 1.4L;               // step times the highest angular frequency: kReach^26 / 26! = 1.6e-23
constexpr int kPowerIterations = 200;       // iterations for that frequency; an error of a few per cent is acceptable
constexpr Real kSmallestInterval = 1e-17L;  // s; the finest scale of the root search
constexpr int kSameInstant = 1000;          // largest number of contact changes at one instant

using Polynomial = std::array<Real, kOrder + 1>;

Real value_of(const Polynomial& c, Real t) {
  Real value = 0;
  for (int k = kOrder; k >= 0; --k) value = value * t + c[static_cast<std::size_t>(k)];
  return value;
}

Real slope_of(const Polynomial& c, Real t) {
  Real value = 0;
  for (int k = kOrder; k >= 1; --k) value = value * t + static_cast<Real>(k) * c[static_cast<std::size_t>(k)];
  return value;
}

/// The coefficients of c(shift + t) by repeated synthetic division.
Polynomial shifted(Polynomial c, Real shift) {
  for (std::size_t i = 0; i < kOrder; ++i)
    for (std::size_t k = kOrder; k-- > i;) c[k] += shift * c[k + 1];
  return c;
}

/// The first t in [from, to] at which c changes from positive to negative, or infinity. Intervals are halved
/// until the coefficients about the midpoint prove that c has one sign or is monotone, so that no pair of
/// roots is missed. If c decreases and is not positive at `from`, its root is there; this occurs if another
/// change at this instant caused it.
Real first_fall(const Polynomial& c, Real from, Real to) {
  const Real middle = (from + to) / 2, r = (to - from) / 2;
  const Polynomial local = shifted(c, middle);
  Real spread = 0, slope_spread = 0, power = 1;
  for (std::size_t k = 1; k <= kOrder; ++k) {
    if (k > 1) slope_spread += static_cast<Real>(k) * std::abs(local[k]) * power;
    power *= r;
    spread += std::abs(local[k]) * power;
  }
  constexpr Real kNone = std::numeric_limits<Real>::infinity();
  if (local[0] > spread) return kNone;
  if (local[1] > slope_spread) return kNone;  // increases: no root
  if (local[1] < -slope_spread) {
    Real low = from, high = to;
    if (value_of(c, high) >= 0) return kNone;
    if (value_of(c, low) <= 0) return low;
    while (true) {
      const Real between = (low + high) / 2;
      if (between <= low || between >= high) return high;
      (value_of(c, between) >= 0 ? low : high) = between;
    }
  }
  if (r < kSmallestInterval) return kNone;  // touches zero without crossing
  const Real first = first_fall(c, from, middle);
  return first <= middle ? first : first_fall(c, middle, to);
}

class Taylor {
 public:
  explicit Taylor(const ProblemOf<Real>& problem)
      : p_(problem), x_(problem.size()), v_(problem.size()), side_(problem.stops.size(), 0) {
    factor_.compute(p_.mass);
    for (auto& coefficient : c_) coefficient = Vector<Real>(p_.size());
    longest_ = kReach / highest_frequency();
  }

  /// Expands about the present instant; valid up to the next contact change or the longest step.
  void expand() {
    closed_ = p_.stiffness;
    for (std::size_t s = 0; s < side_.size(); ++s)
      if (side_[s] != 0) closed_.add(p_.stops[s], p_.stops[s], p_.contact_stiffness);
    c_[0] = x_;
    c_[1] = v_;
    Real load = p_.amplitude;  // amplitude w^k / k!
    for (std::size_t k = 0; k + 2 <= kOrder; ++k) {
      const Real order = static_cast<Real>(k);
      Vector<Real>& next = c_[k + 2];
      for (int i = 0; i < p_.size(); ++i)
        next[i] = -(order + 1) * p_.damping.row_times(i, c_[k + 1].data()) - closed_.row_times(i, c_[k].data());
      next[p_.loaded] += load * derivative_of_cosine(k);
      if (k == 0)
        for (std::size_t s = 0; s < side_.size(); ++s) next[p_.stops[s]] += side_[s] * p_.contact_stiffness * p_.gap;
      factor_.solve(next);
      for (int i = 0; i < p_.size(); ++i) next[i] /= (order + 1) * (order + 2);
      load *= p_.angular_frequency / (order + 1);
    }
  }

  /// Finds the first contact change within the expansion; without one, the length is the longest step.
  void find_change() {
    length_ = longest_;
    changing_ = -1;
    for (std::size_t s = 0; s < side_.size(); ++s) {
      if (side_[s] != 0) {
        consider(s, gap_polynomial(s, side_[s]), 0);
      } else {
        consider(s, gap_polynomial(s, -1), 1);
        consider(s, gap_polynomial(s, 1), -1);
      }
    }
  }

  /// Advances to the end of the expansion; returns true if a contact changed there.
  bool advance() {
    for (int i = 0; i < p_.size(); ++i) {
      const Polynomial c = polynomial(i);
      x_[i] = value_of(c, length_);
      v_[i] = slope_of(c, length_);
    }
    t_ += length_;
    if (changing_ < 0) return false;
    side_[static_cast<std::size_t>(changing_)] = new_side_;
    return true;
  }

  ReferenceRow row(Real t) const {
    ReferenceRow row{};
    row.t = t;
    look(p_.loaded, t - t_, row.u0, row.v0, row.fc0);
    if (p_.observed >= 0) look(p_.observed, t - t_, row.u1, row.v1, row.fc1);
    return row;
  }

  Real t() const { return t_; }
  Real length() const { return length_; }

 private:
  Real derivative_of_cosine(std::size_t order) const {
    const Real phase = p_.angular_frequency * t_;
    switch (order % 4) {
      case 0:
        return std::cos(phase);
      case 1:
        return -std::sin(phase);
      case 2:
        return -std::cos(phase);
      default:
        return std::sin(phase);
    }
  }

  /// The square root of the largest eigenvalue of M^-1 (K + all stops), from the power method.
  Real highest_frequency() {
    Band<Real> stiffness = p_.stiffness;
    for (const int dof : p_.stops) stiffness.add(dof, dof, p_.contact_stiffness);
    Vector<Real> x(p_.size()), y(p_.size());
    for (int i = 0; i < p_.size(); ++i) x[i] = 1 + (i * 7) % 5;
    Real growth = 0;
    for (int k = 0; k < kPowerIterations; ++k) {
      for (int i = 0; i < p_.size(); ++i) y[i] = stiffness.row_times(i, x.data());
      factor_.solve(y);
      growth = 0;
      for (int i = 0; i < p_.size(); ++i) growth = std::max(growth, std::abs(y[i]));
      for (int i = 0; i < p_.size(); ++i) x[i] = y[i] / growth;
    }
    return std::sqrt(growth);
  }

  Polynomial polynomial(int dof) const {
    Polynomial c;
    for (std::size_t k = 0; k <= kOrder; ++k) c[k] = c_[k][dof];
    return c;
  }

  /// side u - gap; with the opposite sign if the stop is open (side negated). In both cases a change is a
  /// crossing to below 0.
  Polynomial gap_polynomial(std::size_t stop, int side) const {
    Polynomial c = polynomial(p_.stops[stop]);
    for (Real& coefficient : c) coefficient *= side;
    c[0] += side_[stop] != 0 ? -p_.gap : p_.gap;
    return c;
  }

  void consider(std::size_t stop, const Polynomial& c, int side_after) {
    const Real root = first_fall(c, 0, length_);
    if (root > length_ || (changing_ >= 0 && root == length_)) return;
    length_ = root;
    changing_ = static_cast<int>(stop);
    new_side_ = side_after;
  }

  void look(int dof, Real after, Real& u, Real& v, Real& fc) const {
    const Polynomial c = polynomial(dof);
    u = value_of(c, after);
    v = slope_of(c, after);
    const auto found = std::find(p_.stops.begin(), p_.stops.end(), dof);
    const int side = found == p_.stops.end() ? 0 : side_[static_cast<std::size_t>(found - p_.stops.begin())];
    fc = side == 0 ? 0 : -p_.contact_stiffness * (u - side * p_.gap);
  }

  const ProblemOf<Real>& p_;
  BandFactor<Real> factor_;
  Band<Real> closed_;
  Vector<Real> x_, v_;
  std::vector<int> side_;  // of each stop: 0 open, +1 or -1 closed on that side
  std::array<Vector<Real>, kOrder + 1> c_;
  Real t_ = 0, longest_ = 0, length_ = 0;
  int changing_ = -1, new_side_ = 0;
};

}  // namespace

Reference solve_reference(const ProblemOf<long double>& problem, long double interval, int count) {
  Taylor taylor(problem);
  Reference reference;
  int at_one_instant = 0;
  while (static_cast<int>(reference.rows.size()) <= count && at_one_instant < kSameInstant) {
    taylor.expand();
    taylor.find_change();
    const Real end = taylor.t() + taylor.length();
    for (int i = static_cast<int>(reference.rows.size()); i <= count && interval * i < end; ++i)
      reference.rows.push_back(taylor.row(interval * i));
    at_one_instant = taylor.length() > 0 ? 0 : at_one_instant + 1;
    if (taylor.advance()) ++reference.changes;
  }
  return reference;
}

}  // namespace plain
