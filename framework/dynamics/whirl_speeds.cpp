#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "butee/dynamics/whirl.hpp"

// The searches along the speed: critical speeds and borders of stability.

namespace butee::dynamics {
namespace {

using Complex = std::complex<double>;

/// Modes with this damping ratio or more have no critical speed.
constexpr double kNoResonance = 0.9;
/// Relative tolerance of speeds, and of those at which stability changes.
constexpr double kSameSpeed = 1e-13, kSameBorder = 1e-8;
/// Crossings closer to each other than this, relative to the speed, belong to one mode or several
/// equal ones.
constexpr double kOneCrossing = 1e-8;
/// A mode is on the line if its frequency differs from it by less than this fraction (chosen).
constexpr double kAtLine = 1e-6;
/// Growth is counted above a rounding level, and ends at zero: the distance of the two speeds by which the slope of the
/// growth rate is measured, and the largest shift, relative to the speed (chosen).
constexpr double kAside = 1e-4, kLargestShift = 1e-2;
/// More secants are not needed unless the frequency jumps (chosen).
constexpr int kMostSecants = 40;
/// Intervals of speed are halved this often where stability may change and change back, and a margin is near zero below
/// this part of its values around; of fewer than kFewestIntervals intervals each is halved more often (chosen).
constexpr int kLeastLooks = 2, kMostLooks = 7;
constexpr double kNearZero = 0.5, kFewestIntervals = 16.0, kRoundings = 8.0;

/// The modes at a speed, each with its margin from a limit: its frequency above the excitation's, or its growth rate.
/// Modes with a positive margin are counted; a critical speed or a border of stability changes their number.
struct Tally {
  double speed;
  std::vector<double> margins;  ///< descending
  double missing;               ///< the margin of further modes, < 0

  Index count() const {
    return std::find_if(margins.begin(), margins.end(), [](double margin) { return !(margin > 0.0); }) -
           margins.begin();
  }
  double margin(Index k) const { return k < std::ssize(margins) ? margins[static_cast<std::size_t>(k)] : missing; }
};

/// Finds the speeds at which counts change.
class Search {
 public:
  using At = std::function<Tally(double)>;
  /// Takes a change between two close speeds.
  using Add = std::function<void(const Tally&, const Tally&)>;

  /// `tolerance` is that of speeds, relative; margins below `rounding` are not known.
  Search(At at, Add add, double tolerance, double rounding)
      : at_(std::move(at)), add_(std::move(add)), tolerance_(tolerance), rounding_(rounding) {}

  void between(const Tally& a, const Tally& b) const { find(a, b, false); }
  /// The same, where counts may change and change back: intervals are halved twice, and further where the margins may
  /// reach 0 in between, down to 2^(looks - kMostLooks) of the whole.
  void all_between(const Tally& a, const Tally& b, int looks) const {
    if (looks == kMostLooks) return between(a, b);
    const Tally middle = at_(0.5 * (a.speed + b.speed));
    const bool is_same = a.count() == middle.count() && middle.count() == b.count();
    if (looks >= kLeastLooks && !(is_same && may_vanish(a, middle, b))) {
      between(a, middle);
      return between(middle, b);
    }
    all_between(a, middle, looks + 1);
    all_between(middle, b, looks + 1);
  }

 private:
  /// Whether a margin that keeps its sign may vanish in between: the parabola through three values comes near to 0.
  bool may_vanish(const Tally& a, const Tally& middle, const Tally& b) const {
    for (const Index k : {a.count() - 1, a.count()}) {
      if (k < 0 || k >= std::min({std::ssize(a.margins), std::ssize(middle.margins), std::ssize(b.margins)})) continue;
      const double m0 = a.margin(k), m1 = middle.margin(k), m2 = b.margin(k), slope = 0.5 * (m2 - m0),
                   bend = m2 - 2.0 * m1 + m0, least = std::min({std::abs(m0), std::abs(m1), std::abs(m2)});
      const double place = bend != 0.0 ? -slope / bend : 2.0;
      const bool turns = std::abs(place) < 1.0;
      const double extreme = m1 + 0.5 * slope * place, lowest = turns ? std::abs(extreme) : least;
      const bool crosses = turns && (extreme > 0.0) != (m1 > 0.0);
      const double largest = std::max({std::abs(m0), std::abs(m1), std::abs(m2)});
      // Without damping margins are rounding.
      if (largest > kRoundings * rounding_ && (crosses || lowest < kNearZero * largest)) return true;
    }
    return false;
  }

  /// Secants find one change; if rounding moves it, the interval is halved.
  void find(const Tally& a, const Tally& b, bool halves) const {
    if (a.count() == b.count()) return;
    const double at_a = margin_of_change(a, b, a), at_b = margin_of_change(a, b, b);
    const bool is_rounding = std::max(std::abs(at_a), std::abs(at_b)) <= rounding_;
    const double same = tolerance_ * std::abs(b.speed), middle = 0.5 * (a.speed + b.speed);
    if (is_rounding || b.speed - a.speed <= same || middle <= a.speed || middle >= b.speed) return add_(a, b);
    if (halves || b.speed - a.speed <= 4.0 * same) {
      const Tally between = at_(middle);
      find(a, between, true);
      find(between, b, true);
      return;
    }
    // Beside the change the margins exceed their rounding.
    const double change = change_between(a, b), slope = std::abs(at_b - at_a) / (b.speed - a.speed),
                 aside = std::max(0.45 * same, 4.0 * rounding_ / slope);
    const Tally before = at_(std::max(a.speed, change - aside)), after = at_(std::min(b.speed, change + aside));
    const bool is_found = before.count() != after.count();
    find(a, before, !is_found);
    find(before, after, true);
    find(after, b, !is_found);
  }

  /// The margin at `which` of the first mode that changes its sign between two speeds.
  static double margin_of_change(const Tally& a, const Tally& b, const Tally& which) {
    return which.margin(std::min(a.count(), b.count()));
  }

  double change_between(const Tally& a, const Tally& b) const {
    const Index k = std::min(a.count(), b.count());
    double low = a.speed, high = b.speed, last = low, next = high, at_last = a.margin(k), at_next = b.margin(k);
    const bool is_positive_below = at_last > 0.0;
    for (int i = 0; i < kMostSecants && std::abs(at_next) > 0.1 * rounding_; ++i) {
      double speed = next - at_next * (next - last) / (at_next - at_last);
      if (!(speed > low && speed < high)) speed = 0.5 * (low + high);
      if (std::abs(speed - next) <= 0.1 * tolerance_ * std::abs(speed)) return speed;
      last = std::exchange(next, speed);
      at_last = std::exchange(at_next, at_(speed).margin(k));
      ((at_next > 0.0) == is_positive_below ? low : high) = next;
    }
    return next;
  }

  At at_;
  Add add_;
  double tolerance_, rounding_;
};

}  // namespace

std::vector<CriticalSpeed> Whirl::critical_speeds(double from, double to, Index steps, double order,
                                                  Index count) const {
  struct Crossing {
    double speed;
    std::vector<CriticalSpeed> near;  ///< of the modes near the line, the closest first
    Index change;
  };
  std::vector<Crossing> crossings;
  const auto add = [&](const Tally& a, const Tally& b) {
    const double middle = 0.5 * (a.speed + b.speed);
    auto near = modes(b.speed, is_dense() ? 2 * size() : count);
    std::stable_sort(near.begin(), near.end(), [&](const auto& p, const auto& q) {
      return std::abs(p.frequency() - order * std::abs(b.speed)) < std::abs(q.frequency() - order * std::abs(b.speed));
    });
    // A mode whose damping passes kNoResonance changes the number, too, and crosses nothing.
    const double largest = kAtLine * order * std::abs(b.speed);
    Crossing crossing{middle, {}, b.count() - a.count()};
    for (const WhirlMode& mode : near)
      if (mode.damping_ratio() <= kNoResonance && std::abs(mode.frequency() - order * std::abs(b.speed)) <= largest)
        crossing.near.push_back({middle, mode.direction, mode.motion});
    if (!crossing.near.empty()) crossings.push_back(std::move(crossing));
  };
  // Counted are the frequencies above the line order times speed or, if only the lowest are known, those below it.
  // Modes near critical damping have no resonance and count as above it: those that turning parts damp have frequencies
  // proportional to the speed, and would leave the line at speed 0. A pair of real eigenvalues counts as one of them.
  const double sign = is_dense() ? 1.0 : -1.0;
  const auto at = [&](double speed) {
    const double line = order * std::abs(speed);
    Tally tally{speed, {}, -line};
    bool is_second = false;
    for (const Complex lambda : eigenvalues(speed, is_dense() ? 2 * size() : count)) {
      const bool is_real = lambda.imag() == 0.0;
      if (is_real) is_second = !is_second;
      if (lambda == 0.0 || (is_real && is_second)) continue;
      const double beyond = -lambda.real() - kNoResonance * std::abs(lambda);
      tally.margins.push_back(sign * std::max(lambda.imag() - line, beyond));
    }
    std::sort(tally.margins.begin(), tally.margins.end(), std::greater<>());
    return tally;
  };
  const Search search(at, add, kSameSpeed, rounding(std::max(std::abs(from), std::abs(to))));
  Tally before = at(from);
  for (Index i = 1; i <= steps; ++i) {
    Tally next = at(from + (to - from) * static_cast<double>(i) / static_cast<double>(steps));
    search.between(before, next);
    before = std::move(next);
  }
  // If two modes coincide, rounding moves them back and forth across the line: the net number of
  // crossings counts.
  std::vector<CriticalSpeed> found;
  for (std::size_t i = 0; i < crossings.size();) {
    const Crossing& first = crossings[i];
    Index net = 0;
    for (; i < crossings.size() && crossings[i].speed - first.speed <= kOneCrossing * std::abs(first.speed); ++i)
      net += crossings[i].change;
    const auto passed = std::min(static_cast<std::size_t>(std::abs(net)), first.near.size());
    found.insert(found.end(), first.near.begin(), first.near.begin() + static_cast<std::ptrdiff_t>(passed));
  }
  return found;
}

double Whirl::border_near(double side, const WhirlMode& mode, Index count) const {
  const auto rate_at = [&](double speed) {
    const std::vector<Complex> all = eigenvalues(speed, count);
    return std::min_element(all.begin(), all.end(),
                            [&](Complex a, Complex b) { return std::abs(a - mode.lambda) < std::abs(b - mode.lambda); })
        ->real();
  };
  const double aside = kAside * std::abs(side), slope = (rate_at(side + aside) - rate_at(side - aside)) / (2.0 * aside);
  const double shift = mode.lambda.real() / slope;
  return std::abs(shift) <= kLargestShift * std::abs(side) ? side - shift : side;
}

std::vector<StabilityBorder> Whirl::stability_borders(const std::vector<ModesAtSpeed>& grid, Index count) const {
  const Index all = is_dense() ? 2 * size() : count;
  const auto tally_of = [&](double speed, const std::vector<Complex>& values) {
    Tally tally{speed, {}, -std::numeric_limits<double>::infinity()};
    for (const Complex lambda : values) tally.margins.push_back(growth(lambda));
    std::sort(tally.margins.begin(), tally.margins.end(), std::greater<>());
    return tally;
  };
  std::vector<StabilityBorder> found;
  const auto add = [&](const Tally& a, const Tally& b) {
    const bool begins = b.count() > a.count();
    const double side = begins ? b.speed : a.speed;
    std::vector<WhirlMode> growing = modes(side, all);
    std::stable_sort(growing.begin(), growing.end(),
                     [&](const auto& p, const auto& q) { return growth(p.lambda) > growth(q.lambda); });
    const auto last = static_cast<std::size_t>(std::max(a.count(), b.count()) - 1);
    if (last < growing.size()) found.push_back({border_near(side, growing[last], all), begins, growing[last]});
  };
  const Search search(
      [&](double speed) { return tally_of(speed, eigenvalues(speed, all)); }, add, kSameBorder,
      grid.empty() ? 0.0 : rounding(std::max(std::abs(grid.front().speed), std::abs(grid.back().speed))));
  // Few speeds are far from each other.
  const double intervals = std::max(1.0, static_cast<double>(grid.size()) - 1.0);
  const int looks = is_dense() ? -std::max(0, static_cast<int>(std::ceil(std::log2(kFewestIntervals / intervals)))) : 0;
  for (std::size_t i = 1; i < grid.size(); ++i)
    search.all_between(tally_of(grid[i - 1].speed, grid[i - 1].eigenvalues),
                       tally_of(grid[i].speed, grid[i].eigenvalues), looks);
  return found;
}

}  // namespace butee::dynamics
