#include "integrators/exponential/contact_force.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

constexpr int kDegree = 4;
/// Number of equal parts of a step in which crossings are searched. The path has at most one
/// extremum in each, unless it oscillates several times within a step, which the error indicators
/// reject.
constexpr int kParts = 4;
/// The largest number of Newton steps or bisections towards a root within a bracket.
constexpr int kRefinements = 60;
/// After a Newton correction below this, as a fraction of the step, the remaining error is of the
/// order of its square.
constexpr double kNearRoot = 1e-8;
/// A bend is sharp if it is narrower than this fraction of the path's range. The contribution of
/// the rest within it is of second order in that fraction; elsewhere the rest is nearly constant.
constexpr double kSharp = 1e-3;
/// At this number of widths from its bend the rest of the arctan law differs from its limit by 3e-5
/// of the limit.
constexpr double kOffBend = 100.0;
/// At this number of widths it differs by 3e-9.
constexpr double kFarOff = 1e4;
/// An end of the path is treated as a bend if it is closer to one than this fraction of the path's
/// range.
constexpr double kBesideBend = 0.5;
/// Panels beside a bend that is not sharp: ratio of the lengths of neighbouring panels, and number
/// of panels.
constexpr double kGrading = 0.15, kPreciseGrading = 0.25;
constexpr int kPanels = 4, kPrecisePanels = 12;
/// The finest grading ends if a panel spans kInnermost of the bend's width, or after kMostPanels.
constexpr double kFinestGrading = 0.5, kInnermost = 0.5;
constexpr int kMostPanels = 48;

constexpr std::array<double, 7> kReciprocals = {1.0, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7};
/// Gauss's rule with four points is exact up to degree 7; a path of degree 4 times s^2 has degree
/// 6.
constexpr std::array<double, 4> kGaussPlaces = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                                0.93056815579702629};
constexpr std::array<double, 4> kGaussWeights = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                                 0.17392742256872693};

void add(ForceMoments& to, const ForceMoments& part) {
  for (std::size_t k = 0; k < 3; ++k) to[k] += part[k];
}

double value(const std::array<double, 5>& c, double s) {
  return (((c[4] * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0];
}
double slope(const std::array<double, 5>& c, double s) {
  return ((4.0 * c[4] * s + 3.0 * c[3]) * s + 2.0 * c[2]) * s + c[1];
}

bool has_opposite_signs(double a, double b) {
  return (a > 0.0) != (b > 0.0);
}

/// The root between two positions at which the polynomial has opposite signs.
double root(const std::array<double, 5>& c, double low, double high) {
  const double at_low = value(c, low), at_high = value(c, high);
  double s = low + (high - low) * at_low / (at_low - at_high);
  for (int k = 0; k < kRefinements; ++k) {
    const double w = value(c, s), correction = w / slope(c, s);
    (has_opposite_signs(w, at_low) ? high : low) = s;
    s -= correction;
    if (!(s > low && s < high))
      s = 0.5 * (low + high);
    else if (std::abs(correction) < kNearRoot)
      break;
  }
  return s;
}

}  // namespace

ContactForce::ContactForce(dynamics::ElasticStops& contact, Index stop)
    : contact_(contact),
      stop_(stop),
      gap_(contact.play_of(stop).gap),
      stiffness_(contact.law_of(stop).closed_stiffness()),
      transition_width_(contact.law_of(stop).transition_width()),
      residual_(contact.law_of(stop).asymptotic_force()),
      is_linear_(contact.law_of(stop).is_piecewise_linear()),
      is_bounded_(is_linear_ || residual_ > 0.0),
      on_upper_(contact.play_of(stop).has_positive()),
      on_lower_(contact.play_of(stop).has_negative()) {
  places_.reserve(2 + 3 * kDegree);
  const double far = kFarOff * transition_width_;
  knows_limits_ = !is_linear_ && std::isfinite(far) && (gap_ > far || !on_upper_ || !on_lower_);
  if (!knows_limits_) return;
  upper_limits_ = {rest_at(gap_ - far, 0.0), rest_at(gap_ + far, 1.0)};
  lower_limits_ = {rest_at(far - gap_, 0.0), rest_at(-gap_ - far, -1.0)};
}

Projection ContactForce::project(const ContactPath& path, ContactStatus status) {
  Projection sum;
  if (status == ContactStatus::open && is_linear_) return sum;
  if (!is_linear_ && !(is_constant_beside_bends(path) && stays_on_a_side(path))) return of_pieces(path);
  if (status == ContactStatus::changing) return of_one_crossing(path, sum) ? sum : of_pieces(path);
  const double side = side_at(path.value(0.5));
  if (status == ContactStatus::closed) add_spring(path, 0.0, 1.0, side, sum);
  if (!is_linear_) add(sum.force, of_constant_rest(path, 0.0, 1.0, side));
  return sum;
}

bool ContactForce::of_one_crossing(const ContactPath& path, Projection& to) {
  const double side = on_upper_ && path.highest() > gap_ ? 1.0 : -1.0, border = side * gap_;
  // The path may reach both borders, or may not be monotonic.
  if (side > 0.0 && on_lower_ && path.lowest() < -gap_) return false;
  if (!path.is_monotonic()) return false;
  std::array<double, 5> c = path.coefficients();
  c[0] -= border;
  const double begin = side * value(c, 0.0), end = side * value(c, 1.0);
  if ((begin > 0.0) == (end > 0.0)) return false;
  const double s = root(c, 0.0, 1.0);
  const bool leaves = begin > 0.0;
  add_spring(path, leaves ? 0.0 : s, leaves ? s : 1.0, side, to);
  if (is_linear_) return true;
  add(to.force, of_constant_rest(path, 0.0, s, leaves ? side : 0.0));
  add(to.force, of_constant_rest(path, s, 1.0, leaves ? 0.0 : side));
  return true;
}

ForceMoments ContactForce::residual_moments(const ContactPath& path) {
  if (path.lowest() > 0.0 || path.highest() < 0.0) return {contact_.force_of(stop_, path.value(0.5)), 0.0, 0.0};
  return of_pieces(path).force;
}

void ContactForce::add_spring(const ContactPath& path, double begin, double end, double side, Projection& to) const {
  const std::array<double, 5>& c = path.coefficients();
  std::array<double, 3> power{};
  std::array<double, 7> integral = kReciprocals;  // integrals of s^k over the piece
  if (begin > 0.0 || end < 1.0) {
    double low = begin, high = end;
    for (std::size_t k = 0; k < 7; ++k, low *= begin, high *= end) integral[k] = (high - low) * kReciprocals[k];
  }
  for (std::size_t j = 0; j < 3; ++j) {
    power[j] = (c[0] - side * gap_) * integral[j];
    for (std::size_t k = 1; k < 5; ++k) power[j] += c[k] * integral[j + k];
  }
  for (std::size_t k = 0; k < 7; ++k) to.closed[k] += integral[k];
  add(to.force, moments_from_powers(-stiffness_ * power[0], -stiffness_ * power[1], -stiffness_ * power[2]));
}

double ContactForce::tangent_at(double w) const {
  const double upper = w - gap_, lower = -w - gap_;
  return tangent_behind(!on_lower_ ? upper : !on_upper_ ? lower : std::max(upper, lower));
}

double ContactForce::tangent_behind(double penetration) const {
  return residual_ > 0.0 ? stiffness_ : contact_.law_of(stop_).tangent(penetration);
}

std::pair<double, double> ContactForce::missed(const ContactPath& path) {
  const ContactStatus along = status(path);
  if (along == ContactStatus::open && is_linear_) return {};
  if (is_spring(path, along)) {
    const std::array<double, 5>& c = path.coefficients();
    return {-stiffness_ * (c[3] / 20.0 + c[4] / 10.0), -stiffness_ * c[4] / 70.0};
  }
  const auto [f0, f1, f2] = project(path, along).force;
  const double start = force_at(path.value(0.0)) - (f0 - f1 + f2), end = force_at(path.value(1.0)) - (f0 + f1 + f2);
  return {0.5 * (end - start), 0.5 * (end + start)};
}

double ContactForce::steepest(const ContactPath& path) const {
  return std::max({stiffness_, tangent_at(path.lowest()), tangent_at(path.highest())});
}

double ContactForce::rest_at(double w, double side) {
  return contact_.force_of(stop_, w) + (side != 0.0 ? stiffness_ * (w - side * gap_) : 0.0);
}

double ContactForce::constant_rest(double w, double side) {
  // At w = 0 the residual forces of both sides cancel.
  if (!knows_limits_ || (side == 0.0 && w == 0.0)) return rest_at(w, side);
  const bool on_upper = side > 0.0 || (side == 0.0 && on_upper_ && (w > 0.0 || !on_lower_));
  const RestLimits& rest = on_upper ? upper_limits_ : lower_limits_;
  return side != 0.0 ? rest.closed : rest.open;
}

ForceMoments ContactForce::of_rest(const ContactPath& path, double begin, double end, double side) {
  double m0 = 0.0, m1 = 0.0, m2 = 0.0;
  for (std::size_t i = 0; i < kGaussPlaces.size(); ++i) {
    const double s = begin + (end - begin) * kGaussPlaces[i];
    const double force = (end - begin) * kGaussWeights[i] * rest_at(path.value(s), side);
    m0 += force;
    m1 += force * s;
    m2 += force * s * s;
  }
  return moments_from_powers(m0, m1, m2);
}

ForceMoments ContactForce::of_constant_rest(const ContactPath& path, double begin, double end, double side) {
  const double f = constant_rest(path.value(0.5 * (begin + end)), side);
  if (begin == 0.0 && end == 1.0) return {f, 0.0, 0.0};
  return moments_from_powers(f * (end - begin), f / 2.0 * (end * end - begin * begin),
                             f / 3.0 * (end * end * end - begin * begin * begin));
}

ForceMoments ContactForce::of_graded_rest(const ContactPath& path, double graded, double other, double side) {
  ForceMoments sum{};
  double outer = other;
  const int panels = is_finest_ ? kMostPanels : is_precise_ ? kPrecisePanels : kPanels;
  const double grading = is_finest_ ? kFinestGrading : is_precise_ ? kPreciseGrading : kGrading;
  const double bend = path.value(graded);
  for (int panel = 1; panel <= panels && outer != graded; ++panel) {
    const bool is_last =
        panel == panels || (is_finest_ && std::abs(path.value(outer) - bend) <= kInnermost * transition_width_);
    const double inner = is_last ? graded : graded + grading * (outer - graded);
    add(sum, of_rest(path, std::min(inner, outer), std::max(inner, outer), side));
    outer = inner;
  }
  return sum;
}

bool ContactForce::stays_on_a_side(const ContactPath& path) const {
  return !(on_upper_ && on_lower_ && gap_ > 0.0) || path.lowest() > 0.0 || path.highest() < 0.0;
}

bool ContactForce::is_constant_beside_bends(const ContactPath& path) const {
  return !is_precise_ && (transition_width_ <= kSharp * (path.highest() - path.lowest()) || is_off_bends(path));
}

bool ContactForce::is_off_bends(const ContactPath& path) const {
  const double off = kOffBend * transition_width_;
  const auto is_off = [&](double border) { return path.highest() < border - off || path.lowest() > border + off; };
  return (!on_upper_ || is_off(gap_)) && (!on_lower_ || is_off(-gap_));
}

Projection ContactForce::of_pieces(const ContactPath& path) {
  find_places(path);
  const bool is_constant = is_constant_beside_bends(path);
  Projection sum;
  for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
    const Place &begin = places_[i], &end = places_[i + 1];
    const double middle = 0.5 * (begin.s + end.s), side = side_at(path.value(middle));
    if (side != 0.0) add_spring(path, begin.s, end.s, side, sum);
    if (is_linear_) continue;
    if (is_constant) {
      add(sum.force, of_constant_rest(path, begin.s, end.s, side));
      continue;
    }
    for (const Place& place : {begin, end})
      add(sum.force, place.is_bend ? of_graded_rest(path, place.s, middle, side)
                                   : of_rest(path, std::min(place.s, middle), std::max(place.s, middle), side));
  }
  return sum;
}

void ContactForce::find_places(const ContactPath& path) {
  places_.assign(1, {0.0, false});
  const double range = path.highest() - path.lowest();
  const auto is_near_bend = [&](double w) {
    return (on_upper_ && std::abs(w - gap_) < kBesideBend * range) ||
           (on_lower_ && std::abs(w + gap_) < kBesideBend * range);
  };
  if (on_upper_) add_crossings(path, gap_);
  if (on_lower_ && (gap_ > 0.0 || !on_upper_)) add_crossings(path, -gap_);
  for (Place& place : places_) place.is_bend = place.s > 0.0 || is_near_bend(path.value(0.0));
  if (!is_linear_ && on_upper_ && on_lower_ && gap_ > 0.0) add_crossings(path, 0.0);
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.s < b.s; });
  places_.push_back({1.0, is_near_bend(path.value(1.0))});
}

void ContactForce::add_crossings(const ContactPath& path, double border) {
  if (border < path.lowest() || border > path.highest()) return;
  std::array<double, 5> c = path.coefficients();
  c[0] -= border;
  double s0 = 0.0;
  for (int i = 1; i <= kParts; ++i) {
    const double s1 = static_cast<double>(i) / kParts;
    if (has_opposite_signs(value(c, s0), value(c, s1))) {
      places_.push_back({root(c, s0, s1), false});
    } else if (has_opposite_signs(slope(c, s0), slope(c, s1))) {
      const double turn = root({c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0}, s0, s1);
      if (has_opposite_signs(value(c, s0), value(c, turn))) {
        places_.push_back({root(c, s0, turn), false});
        places_.push_back({root(c, turn, s1), false});
      }
    }
    s0 = s1;
  }
}

}  // namespace butee::integrators
