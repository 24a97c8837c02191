#pragma once

#include <vector>

#include "butee/time/simulation.hpp"

namespace butee::study {

/// Private to this folder: notices that a motion has settled on one that repeats itself after 1 to 16 periods.
///
/// With s_k the state at the end of period k and |s|^2 = v.M v + (2 pi/T)^2 x.M x, d_k = |s_k - s_{k-p}| decays like
/// q^(k/p); what is left of the way is about d_k q/(1 - q), q estimated over the last 32 periods. The motion is steady
/// where that and d_k are below the tolerance times |s_k|. Looked at every 8 periods; no step is changed by it.
class SteadyWatch final : public time::Observer {
 public:
  /// `dynamics` must outlive it; `period` in s.
  SteadyWatch(dynamics::Dynamics& dynamics, double period, double tolerance);

  void step(const time::AcceptedStep& step) override;

  /// True from when the motion is steady until close().
  bool has_news() const { return is_open_ && repeats_ > 0; }
  void close() { is_open_ = false; }
  /// The first number of periods, not before `t`, from which the motion goes on as from `settle`, at most that.
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
  std::vector<Section> sections_;
  std::vector<Index> dofs_;
  std::int64_t taken_ = 0, repeats_ = 0;
  bool is_open_ = true;
};

}  // namespace butee::study
