#pragma once

#include <string>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// Detects slip speeds of regularised friction that a tolerance cannot resolve: if the error of a
/// contact's speed may be larger than the slip speed, the sense of friction is uncertain. Speeds
/// are taken at the ends of steps.
class BUTEE_EXPORT SlipWatch final : public time::Observer {
 public:
  /// `dynamics` must have obstacles and outlive this object.
  explicit SlipWatch(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override { take(step.to); }
  void save(ByteWriter& to) const override { to.put(largest_); }
  void restore(ByteReader& from) override { from.take(largest_); }

  /// A message with suitable values, or "".
  std::string complaint(double tolerance) const;

 private:
  void take(const time::State& state);

  const dynamics::Obstacles& obstacles_;
  std::vector<Index> contacts_;  ///< with regularised friction
  std::vector<double> largest_;  ///< largest speed of each, m/s
};

}  // namespace butee::record
