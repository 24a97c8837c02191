#pragma once

#include <string>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// Tells slip speeds of regularised friction that a tolerance cannot resolve: where the speed of a contact may be wrong
/// by more, the sense of friction is not known. Speeds are those at the ends of steps.
class BUTEE_EXPORT SlipWatch final : public time::Observer {
 public:
  /// `dynamics` must outlive it and has obstacles.
  explicit SlipWatch(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override { take(step.to); }
  void save(ByteWriter& to) const override { to.put(largest_); }
  void restore(ByteReader& from) override { from.take(largest_); }

  /// A sentence with the values that would do, or "".
  std::string complaint(double tolerance) const;

 private:
  void take(const time::State& state);

  const dynamics::Obstacles& obstacles_;
  std::vector<Index> contacts_;  ///< with regularised friction
  std::vector<double> largest_;  ///< speed of each, m/s
};

}  // namespace butee::record
