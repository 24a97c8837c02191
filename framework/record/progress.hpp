#pragma once

#include <chrono>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// A bar on standard error with the simulated time and the step, for runs of more than a second.
class BUTEE_EXPORT ProgressBar final : public time::Observer {
 public:
  explicit ProgressBar(double end_time) : end_time_(end_time) {}

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void finish() override;
  void restore(ByteReader& from) override;

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double t, double h);

  double end_time_, begin_t_ = 0.0;
  Clock::time_point begin_, drawn_;
  std::int64_t steps_ = 0, look_again_ = 0;
  bool shown_ = false;
};

/// True where standard error is a terminal.
BUTEE_EXPORT bool has_terminal();

}  // namespace butee::record
