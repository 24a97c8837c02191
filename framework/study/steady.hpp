#pragma once

#include <vector>

#include "butee/time/simulation.hpp"

namespace butee::study {

/// Private to this folder: detects that a motion has settled on one that repeats after 1 to 16
/// periods.
///
/// With s_k the state at the end of period k and |s|^2 = v.M v + (2 pi/T)^2 x.M x, d_k = |s_k -
/// s_{k-p}| decays like q^(k/p); the remaining distance is about d_k q/(1 - q), with q estimated
/// over the last 32 periods. The motion is steady if that and d_k are below the tolerance times
/// |s_k|. Checked every 8 periods, from the last instant on at which a load or its slope jumps; the steps are not
/// changed.
class SteadyWatch final : public time::Observer {
 public:
  /// `dynamics` must outlive this object; `period` in s.
  SteadyWatch(dynamics::Dynamics& dynamics, double period, double tolerance);

  void step(const time::AcceptedStep& step) override;

  /// True from the time when the motion is steady until close().
  bool has_news() const { return is_open_ && repeats_ > 0; }
  void close() { is_open_ = false; }
  /// The first number of periods, not before `t`, from which the motion continues as from `settle`;
  /// at most `settle`. Also after close().
  std::int64_t next_alike(double t, std::int64_t settle) const;

 private:
  static constexpr std::int64_t kMostRepeats = 16, kMemory = 32, kBetweenLooks = 8, kKept = kMemory + kMostRepeats + 1;

  struct Section {
    Vector x, v;
  };
  const Section& section(std::int64_t period) const { return sections_[static_cast<std::size_t>(period % kKept)]; }
  double size_of(const Vector& x, const Vector& v) const;
  double distance(std::int64_t a, std::int64_t b) const {
    return size_of(section(a).x - section(b).x, section(a).v - section(b).v);
  }
  void look();

  dynamics::Dynamics& dynamics_;
  double period_, tolerance_;
  double earliest_ = 0.0;  ///< s, of the last such instant
  std::vector<Section> sections_;
  std::vector<Index> dofs_;
  std::int64_t taken_ = 0, repeats_ = 0;
  bool is_open_ = true;
};

}  // namespace butee::study
