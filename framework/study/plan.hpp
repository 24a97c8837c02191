#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "butee/config/value.hpp"
#include "butee/study/sequences.hpp"

namespace butee::study {

/// A varied key of the scene, and its values.
struct Axis {
  struct Range {
    double from = 0.0, to = 0.0;
    bool is_logarithmic = false;
  };
  std::string key;                    ///< as for --set
  std::vector<config::Value> values;  ///< if there is no range
  std::optional<Range> range{};
  std::int64_t count = 0;  ///< number of values from one end of the range to the other; 0 for random plans
  std::string label{};     ///< for pictures; if empty, the key is used
  std::string place{};     ///< file, line and key where a study gives it, for messages; may be empty

  /// True if all values are numbers.
  BUTEE_EXPORT bool is_numeric() const;
  BUTEE_EXPORT std::int64_t size() const;
  BUTEE_EXPORT config::Value value(std::int64_t index) const;
  /// The value at the fraction `u` in [0, 1) of the range, or of the values.
  BUTEE_EXPORT config::Value at(double u) const;
};

enum class PlanKind { grid, list, sobol, latin };

/// Sweeps, where a point starts from the final state of the previous one.
enum class Follow { no, up, down, both };

/// The runs of a study, numbered from 0, and the chains of runs that follow each other.
///
/// The last axis varies fastest in the numbering of points. With Follow::both, run r is point r on
/// the way up, and run N + r is point r on the way down. A sweep follows the last axis.
class BUTEE_EXPORT Plan {
 public:
  static constexpr std::int64_t kMostPoints = 100'000'000;
  static constexpr std::int64_t kMostLatinPoints = 10'000'000;

  /// Throws InputError if there are no points, or too many.
  Plan(std::vector<Axis> axes, PlanKind kind, std::int64_t count, std::optional<std::uint64_t> seed, Follow follow);

  const std::vector<Axis>& axes() const { return axes_; }
  PlanKind kind() const { return kind_; }
  Follow follow() const { return follow_; }
  std::int64_t point_count() const { return points_; }
  std::int64_t run_count() const { return follow_ == Follow::both ? 2 * points_ : points_; }

  struct Run {
    std::int64_t point = 0;
    int direction = 0;  ///< of a sweep, +1 or -1; else 0
  };
  Run run(std::int64_t number) const;
  /// A value for each axis.
  std::vector<config::Value> values(std::int64_t point) const;

  /// Runs first, first + step, ... that must be done in this order.
  struct Chain {
    std::int64_t first = 0, step = 1, length = 1;
    std::int64_t at(std::int64_t i) const { return first + i * step; }
  };
  std::int64_t chain_count() const { return run_count() / chain_length_; }
  Chain chain(std::int64_t index) const;

 private:
  std::vector<Axis> axes_;
  PlanKind kind_;
  Follow follow_;
  std::int64_t points_ = 1, chain_length_ = 1;
  std::optional<Sobol> sobol_;
  std::optional<LatinHypercube> latin_;
};

}  // namespace butee::study
